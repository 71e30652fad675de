// What is set at the Camera step: intrinsics from files of other programs, the size of pictures, the exposure.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QAction>
#include <QComboBox>
#include <QLabel>
#include <QSemaphore>
#include <QSlider>
#include <QTemporaryDir>
#include <QThreadPool>

#include "core/formats/camera_export.h"
#include "core/formats/files.h"
#include "tests/ui/window/driven_window.h"
#include "ui/pages/camera_page.h"

namespace skincal {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A camera of two sizes that gives no picture.
class TwoSizes : public FrameSource {
  public:
    [[nodiscard]] QString name() const override { return QStringLiteral("Two sizes"); }
    [[nodiscard]] std::vector<FrameFormat> formats() const override { return {{640, 480, 30}, {1280, 720, 29.97}}; }
    [[nodiscard]] FrameFormat format() const override { return format_; }
    void setFormat(const FrameFormat& format) override { format_ = format; }
    [[nodiscard]] std::optional<std::pair<double, double>> exposureRange() const override {
        return std::pair(1e-4, 1e-1);
    }
    [[nodiscard]] std::optional<double> exposure() const override { return exposure_; }
    void setExposure(double seconds) override { exposure_ = seconds; }
    void start() override {}
    void stop() override {}

  private:
    FrameFormat format_{640, 480, 30};
    double exposure_ = 1e-2;
};

class CameraSetup : public ::testing::Test {
  protected:
    void SetUp() override { ASSERT_TRUE(driven_.goTo(Step::Camera)); }

    [[nodiscard]] QString write(const CameraModel& camera, CameraFileKind kind, const char* name) {
        const QString file = folder_.filePath(name);
        EXPECT_TRUE(writeFileAtomically(file.toStdString(), exportCamera(camera, kind).value()));
        return file;
    }
    void load(const QString& file) {
        driven_.window.findChild<CameraPage*>()->loadIntrinsics(file);
        DrivenWindow::finishFiles();
    }
    [[nodiscard]] std::string words() { return driven_.find<QLabel>("intrinsics")->text().toStdString(); }
    void press(const char* action) { driven_.find<QAction>(action)->trigger(); }

    QTemporaryDir folder_;
    DrivenWindow driven_;
};

TEST_F(CameraSetup, IntrinsicsOfOtherProgramsAreLoadedAndTakenBack) {
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.workbench.camera() != nullptr; }));
    CameraModel camera = driven_.rig.world().scenario.camera;
    camera.distortionModel = DistortionModel::PlumbBob;
    camera.distortion = {0.1, -0.05, 0.001, 0.002};
    const std::array kinds{std::pair(CameraFileKind::Ros, "ros.yaml"), std::pair(CameraFileKind::OpenCv, "opencv.yml"),
                           std::pair(CameraFileKind::Kalibr, "camchain.yaml")};
    for (const auto& [kind, name] : kinds) {
        camera.fx += 10;
        load(write(camera, kind, name));
        ASSERT_TRUE(driven_.session().decisions().camera) << name;
        EXPECT_EQ(driven_.session().decisions().camera->fx, camera.fx) << name;
        EXPECT_EQ(driven_.session().decisions().cameraOrigin.kind, CameraOrigin::Kind::File);
        EXPECT_THAT(words(), HasSubstr(name)) << "where they are from is told";
        EXPECT_THAT(words(), Not(HasSubstr("The camera gives"))) << name;
    }
    for (std::size_t i = kinds.size(); i > 0; --i) {
        EXPECT_THAT(words(), HasSubstr(kinds.at(i - 1).second));
        press("undo");
    }
    EXPECT_FALSE(driven_.session().decisions().camera);
    EXPECT_THAT(words(), HasSubstr("not known yet"));
    press("redo");
    EXPECT_THAT(words(), HasSubstr("ros.yaml"));
}

TEST_F(CameraSetup, IntrinsicsOfAnotherSizeAreWarnedOf) {
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.workbench.camera() != nullptr; }));
    CameraModel camera = driven_.rig.world().scenario.camera;
    camera.width /= 2;
    load(write(camera, CameraFileKind::OpenCv, "half.yml"));
    EXPECT_THAT(words(), HasSubstr("The camera gives"));
    EXPECT_THAT(words(), HasSubstr("choose that size, or other intrinsics"));
    press("undo");
    EXPECT_THAT(words(), Not(HasSubstr("The camera gives")));
}

TEST_F(CameraSetup, OfTwoFilesInARowTheSecondCounts) {
    CameraModel camera = driven_.rig.world().scenario.camera;
    const QString first = write(camera, CameraFileKind::Ros, "first.yaml");
    camera.fx += 1;
    const QString second = write(camera, CameraFileKind::Ros, "second.yaml");
    auto* page = driven_.window.findChild<CameraPage*>();
    // Neither is read before both are chosen: the first alone would have been in time, and counted.
    QSemaphore areChosen;
    for (int i = 0; i < QThreadPool::globalInstance()->maxThreadCount(); ++i)
        QThreadPool::globalInstance()->start([&areChosen] { areChosen.acquire(); });
    page->loadIntrinsics(first);
    page->loadIntrinsics(second);
    areChosen.release(QThreadPool::globalInstance()->maxThreadCount());
    DrivenWindow::finishFiles();
    EXPECT_THAT(words(), HasSubstr("second.yaml"));
    press("undo");
    EXPECT_FALSE(driven_.session().decisions().camera) << "one step";
}

TEST_F(CameraSetup, AFileThatIsNoneIsAProblemAndChangesNothing) {
    const QString file = folder_.filePath("poem.yaml");
    ASSERT_TRUE(writeFileAtomically(file.toStdString(), "roses: red\n"));
    load(file);
    EXPECT_FALSE(driven_.session().decisions().camera);
    ASSERT_GT(driven_.window.problems().rowCount(), 0);
    EXPECT_THAT(driven_.window.problems().problemAt(0).text.toStdString(), HasSubstr("poem.yaml"));
    EXPECT_EQ(driven_.window.problems().problemAt(0).step, Step::Camera);
}

TEST_F(CameraSetup, SizeAndExposureAreSetByTheirControls) {
    driven_.workbench.setCameraOffers({{"Two sizes", "", [] { return std::make_unique<TwoSizes>(); }, "two"}});
    driven_.workbench.chooseCamera(0);
    FrameSource* camera = driven_.workbench.camera();
    ASSERT_NE(camera, nullptr);
    CameraModel small = driven_.rig.world().scenario.camera;
    small.width = 640;
    small.height = 480;
    load(write(small, CameraFileKind::Ros, "small.yaml"));
    EXPECT_THAT(words(), Not(HasSubstr("The camera gives")));

    auto* sizes = driven_.find<QComboBox>("resolutions");
    ASSERT_EQ(sizes->count(), 2);
    EXPECT_EQ(sizes->currentIndex(), 0);
    EXPECT_THAT(sizes->itemText(1).toStdString(), HasSubstr("29.97"));
    QTest::keyClick(sizes, Qt::Key_Down);
    EXPECT_EQ(camera->format().width, 1280);
    EXPECT_THAT(words(), HasSubstr("The camera gives 1280 × 720")) << "the intrinsics are of the other size";
    QTest::keyClick(sizes, Qt::Key_Up);
    EXPECT_EQ(camera->format().width, 640);
    EXPECT_THAT(words(), Not(HasSubstr("The camera gives")));

    auto* exposure = driven_.find<QSlider>("exposure");
    ASSERT_TRUE(exposure->isEnabled());
    EXPECT_EQ(exposure->value(), 67) << "10 ms of 0.1 to 100 ms, by ratio";
    QTest::keyClick(exposure, Qt::Key_Home);
    EXPECT_NEAR(camera->exposure().value(), 1e-4, 1e-9);
    QTest::keyClick(exposure, Qt::Key_PageUp);
    EXPECT_GT(camera->exposure().value(), 1e-4);
    QTest::keyClick(exposure, Qt::Key_End);
    EXPECT_NEAR(camera->exposure().value(), 1e-1, 1e-9);
}

}  // namespace
}  // namespace skincal
