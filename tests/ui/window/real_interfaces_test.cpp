// The whole product on real interfaces: the window, a virtual skin behind a pseudo-terminal and a virtual webcam
// through GStreamer and Qt Multimedia, from Connect to an exported file.

#include <gtest/gtest.h>

#include <QComboBox>
#include <QDialogButtonBox>
#include <QLineEdit>

#include "core/formats/body_json.h"
#include "tests/fixtures/desk_with_wires.h"
#include "tests/ui/window/driven_window.h"
#include "tests/unit/camera/fake_v4l2.h"
#include "ui/pages/address_dialog.h"
#include "ui/pages/camera_page.h"
#include "ui/window/camera_offers.h"

namespace skincal {
namespace {

class RealInterfaces : public testing::Test {
  protected:
    static void SetUpTestSuite() { folder_ = test::prepareVirtualCameras(); }
    static void TearDownTestSuite() { folder_.reset(); }

    [[nodiscard]] bool chooseSkin(const QString& port) {
        auto* skins = driven.find<QComboBox>("skins");
        skins->setCurrentIndex(skins->count() - 1);
        emit skins->activated(skins->count() - 1);
        auto* dialog = driven.window.findChild<AddressDialog*>();
        if (dialog == nullptr)
            return false;
        dialog->findChild<QLineEdit*>("address")->setText(port);
        QTest::mouseClick(dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Ok), Qt::LeftButton);
        return driven.waitFor([&] { return skins->currentText() == port; });
    }
    [[nodiscard]] bool chooseCamera(const QString& name) {
        auto* cameras = driven.find<QComboBox>("cameras");
        if (!driven.goTo(Step::Camera) || !driven.waitFor([&] { return cameras->findText(name) >= 0; }))
            return false;
        cameras->setCurrentIndex(cameras->findText(name));
        emit cameras->activated(cameras->currentIndex());
        return true;
    }
    [[nodiscard]] std::size_t poses() {
        return posesOf(driven.session().measured(), driven.session().decisions()).size();
    }

    static std::unique_ptr<QTemporaryDir> folder_;
    test::DeskWithWires desk{"demo"};
    DrivenWindow driven;
    test::FakeV4l2 system{{}};
    CameraOffers offers{driven.workbench, std::make_shared<CameraList>(system)};
};

std::unique_ptr<QTemporaryDir> RealInterfaces::folder_;

TEST_F(RealInterfaces, LeadFromConnectToAnExportedFile) {
    ASSERT_TRUE(chooseSkin(desk.port()));
    ASSERT_TRUE(driven.connectSkin());
    EXPECT_EQ(driven.session().measured().skin.modules.size(), desk.rig().world().T_r_u.size());

    ASSERT_TRUE(driven.goTo(Step::Pose));
    for (int pose = 0; pose < 6; ++pose) {
        desk.turn(pose);
        const std::size_t before = poses();
        ASSERT_TRUE(driven.waitFor([&] { return poses() > before; })) << "captured by itself once the body rests";
    }

    ASSERT_TRUE(chooseCamera(test::DeskWithWires::kCameraName));
    driven.window.findChild<CameraPage*>()->loadIntrinsics(desk.lensFile());
    DrivenWindow::finishFiles();
    ASSERT_TRUE(driven.session().decisions().camera);

    for (int view = 0; view < 6; ++view) {
        desk.moveCamera(view);
        ASSERT_TRUE(driven.waitFor([&] { return desk.rig().isCameraAtRest(); }));
        ASSERT_TRUE(driven.scanHere()) << view;
    }
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    EXPECT_EQ(driven.patchesPlaced(), driven.session().solution()->body.patches.size());

    ASSERT_TRUE(driven.goTo(Step::Export));
    const QString file = desk.file("arm.body.json");
    auto* line = driven.find<QLineEdit>("file");
    line->clear();
    QTest::keyClicks(line, file);
    ASSERT_TRUE(driven.click("write"));
    ASSERT_TRUE(driven.waitFor(
        [&] { return driven.steps().states()[static_cast<std::size_t>(Step::Export)].status == StepStatus::Done; }));
    const auto body = readBody(file.toStdString());
    ASSERT_TRUE(body);
    const BodyComparison difference = desk.differenceFromTruth(*body, driven.session().measured().skin);
    EXPECT_EQ(difference.compared, desk.rig().world().T_r_u.size());
    EXPECT_LT(difference.positionRms, 1.25 * desk.errorWithoutWires()) << "as exact as without any wire";
}

}  // namespace
}  // namespace skincal
