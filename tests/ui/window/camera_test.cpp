#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QComboBox>
#include <QDialogButtonBox>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTemporaryDir>

#include "core/simulation/renderer.h"
#include "tests/fixtures/virtual_camera/virtual_camera.h"
#include "tests/ui/window/driven_window.h"
#include "tests/unit/camera/fake_v4l2.h"
#include "ui/pages/camera_page.h"
#include "ui/pages/video_dialog.h"
#include "ui/window/camera_offers.h"

namespace skincal {
namespace {

constexpr auto kName = "HD Webcam";

class CameraWindow : public testing::Test {
  protected:
    static void SetUpTestSuite() { folder_ = test::prepareVirtualCameras(); }
    static void TearDownTestSuite() { folder_.reset(); }

    void SetUp() override {
        const CameraModel& lens = driven.rig.world().scenario.camera;
        webcam = std::make_unique<test::VirtualCamera>(
            kName, test::VirtualCamera::Kind{"yuy2", lens.width, lens.height, 30},
            [renderer = std::make_shared<FrameRenderer>(driven.rig.world(), driven.rig.cameraPose(), 0, 200),
             first = driven.rig.world().skin.modules.front().id](std::uint64_t k) {
                const cv::Mat picture = renderer->render({{first}}, k % 200);
                return test::bytesOf("yuy2", picture.cols, picture.rows,
                                     {picture.begin<std::uint8_t>(), picture.end<std::uint8_t>()});
            });
        list = std::make_shared<CameraList>(system);
        offers = std::make_unique<CameraOffers>(driven.workbench, list);
        devices = driven.find<QComboBox>("cameras");
        driven.window.showStep(Step::Camera);
    }

    [[nodiscard]] bool isOffered(const QString& name) const { return devices->findText(name) >= 0; }
    void choose(int row) {
        devices->setCurrentIndex(row);
        emit devices->activated(row);
    }
    [[nodiscard]] QString problems() {
        QString all;
        for (int row = 0; row < driven.window.problems().rowCount(); ++row)
            all += driven.window.problems().index(row).data().toString() + QLatin1Char('\n');
        return all;
    }
    /// Of the camera that is chosen, from now on.
    void countPictures() {
        pictures = 0;
        QObject::connect(driven.workbench.camera(), &FrameSource::frameArrived, &driven.window, [this] { ++pictures; });
    }

    static std::unique_ptr<QTemporaryDir> folder_;
    DrivenWindow driven;
    test::FakeV4l2 system{{}};
    std::unique_ptr<test::VirtualCamera> webcam;
    std::shared_ptr<CameraList> list;
    std::unique_ptr<CameraOffers> offers;
    QComboBox* devices = nullptr;
    int pictures = 0;
};

std::unique_ptr<QTemporaryDir> CameraWindow::folder_;

TEST_F(CameraWindow, ShowsAWebcamThatIsPluggedInAndGoesOnWhereItWasPulled) {
    EXPECT_EQ(devices->currentText(), "Simulated webcam");
    webcam->plug();
    ASSERT_TRUE(driven.waitFor([&] { return isOffered(kName); }));
    EXPECT_EQ(devices->currentText(), "Simulated webcam") << "nobody chose another";
    choose(devices->findText(kName));
    countPictures();
    ASSERT_TRUE(driven.waitFor([&] { return pictures > 3; }));
    auto* controls = driven.find<QLabel>("controls");
    ASSERT_TRUE(driven.waitFor([&] { return !controls->text().isEmpty(); }));
    EXPECT_THAT(controls->text().toStdString(), testing::HasSubstr("cannot be reached"));
    EXPECT_THAT(problems().toStdString(), testing::HasSubstr("in the midst of a scan"));
    EXPECT_FALSE(driven.find<QPushButton>("makersIntrinsics")->isVisible()) << "its maker is not the rig's";
    driven.takePicture("webcam");
    webcam->unplug();
    ASSERT_TRUE(driven.waitFor([&] { return problems().contains("was unplugged"); }));
    EXPECT_THAT(devices->currentText().toStdString(), testing::HasSubstr("not plugged in"));
    driven.takePicture("webcam-unplugged");
    pictures = 0;
    webcam->plug();
    ASSERT_TRUE(driven.waitFor([&] { return pictures > 3; }));
    EXPECT_EQ(devices->currentText(), kName);
    EXPECT_FALSE(problems().contains("was unplugged"));
    // Away from its page it rests.
    driven.window.showStep(Step::Connect);
    QTest::qWait(100);
    pictures = 0;
    QTest::qWait(200);
    EXPECT_EQ(pictures, 0);
}

TEST_F(CameraWindow, SaysWhatToDoWhereACameraMayNotBeOpened) {
    auto node = test::FakeNode::webcam("Secret");
    node->openError = EACCES;
    system.nodes["/dev/video3"] = node;
    list->refresh();
    const int row = devices->findText("/dev/video3", Qt::MatchContains);
    ASSERT_GE(row, 0);
    choose(row);
    ASSERT_TRUE(driven.waitFor([&] { return problems().contains("usermod -aG video $USER"); }));
    driven.takePicture("webcam-forbidden");
    choose(0);
    EXPECT_TRUE(driven.find<QPushButton>("makersIntrinsics")->isVisible());
    ASSERT_TRUE(driven.waitFor([&] { return !problems().contains("usermod"); }));
}

TEST_F(CameraWindow, OpensAVideo) {
    const int last = devices->count() - 1;
    EXPECT_THAT(devices->itemText(last).toStdString(), testing::HasSubstr("Video file or stream"));
    choose(last);
    auto* dialog = driven.window.findChild<VideoDialog*>();
    ASSERT_NE(dialog, nullptr);
    auto* open = dialog->findChild<QDialogButtonBox*>()->button(QDialogButtonBox::Open);
    EXPECT_FALSE(open->isEnabled());
    EXPECT_EQ(devices->currentText(), "Simulated webcam");
    dialog->findChild<QLineEdit*>("video")->setText("/tmp/there is no such.avi");
    driven.takePictureOf(*dialog, "video-dialog");
    ASSERT_TRUE(open->isEnabled());
    QTest::mouseClick(open, Qt::LeftButton);
    ASSERT_TRUE(driven.waitFor([&] { return problems().contains("There is no file"); }));
    EXPECT_EQ(devices->currentText(), "there is no such.avi");
    // It stays what it is while webcams come and go.
    webcam->plug();
    ASSERT_TRUE(driven.waitFor([&] { return isOffered(kName); }));
    EXPECT_EQ(devices->currentText(), "there is no such.avi");
    EXPECT_EQ(driven.workbench.chosenCamera(), devices->currentIndex());
}

}  // namespace
}  // namespace skincal
