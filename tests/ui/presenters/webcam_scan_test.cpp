#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QTemporaryDir>
#include <mutex>

#include "core/camera/webcam_source.h"
#include "core/simulation/renderer.h"
#include "tests/fixtures/virtual_camera/virtual_camera.h"
#include "tests/ui/presenters/desk.h"

namespace skincal {
namespace {

using test::Desk;
using test::waitFor;

/// A desk whose camera goes the way of a webcam: through GStreamer and Qt, in real time. It sees what the rig lights.
class WebcamScan : public testing::Test {
  protected:
    static void SetUpTestSuite() { folder_ = test::prepareVirtualCameras(); }
    static void TearDownTestSuite() { folder_.reset(); }

    [[nodiscard]] bool useWebcam() {
        desk.rig.setCameraLatency(std::chrono::milliseconds(0));
        const CameraModel& lens = desk.rig.world().scenario.camera;
        webcam = std::make_unique<test::VirtualCamera>(
            "Webcam of the desk", test::VirtualCamera::Kind{"i420", lens.width, lens.height, 30},
            [this, renderer = std::make_shared<FrameRenderer>(desk.rig.world(), desk.rig.cameraPose(), 0, 200)](
                std::uint64_t k) {
                std::vector<LitModule> lit;
                std::uint64_t light = 0;
                {
                    const std::scoped_lock lock(mutex);
                    lit = lit_;
                    light = light_;
                }
                const cv::Mat picture = renderer->render(lit, k % 200);
                auto bytes = test::bytesOf("i420", picture.cols, picture.rows,
                                           {picture.begin<std::uint8_t>(), picture.end<std::uint8_t>()});
                // Drawn for too long: it shows what is over.
                const std::scoped_lock lock(mutex);
                return light == light_ ? bytes : std::vector<std::uint8_t>();
            });
        QObject::connect(desk.workbench.skin(), &SkinDevice::lightShown, &desk.scan, [this] {
            const std::scoped_lock lock(mutex);
            lit_ = desk.rig.litAt(desk.rig.now());
            ++light_;
        });
        webcam->plug();
        const auto listed = [&] {
            for (const ListedCamera& camera : list->cameras()) {
                if (camera.description == "Webcam of the desk")
                    return &camera;
            }
            return static_cast<const ListedCamera*>(nullptr);
        };
        if (!waitFor([&] { return listed() != nullptr; }))
            return false;
        auto offers = desk.workbench.cameraOffers;
        offers.push_back({"webcam", "",
                          [this, camera = *listed()] { return std::make_unique<WebcamSource>(list, camera); },
                          "webcam"});
        desk.workbench.setCameraOffers(std::move(offers));
        desk.session().decide("intrinsics", [&](Decisions& decisions) { decisions.camera = lens; });
        desk.workbench.chooseCamera(desk.workbench.cameraOffers.size() - 1);
        desk.scan.setActive(true);
        return waitFor([&] { return desk.scan.obstacle().isEmpty(); });
    }

    static std::unique_ptr<QTemporaryDir> folder_;
    std::mutex mutex;
    std::vector<LitModule> lit_;
    std::uint64_t light_ = 0;  ///< how often it changed
    Desk desk;
    std::shared_ptr<CameraList> list = std::make_shared<CameraList>();
    std::unique_ptr<test::VirtualCamera> webcam;
};

std::unique_ptr<QTemporaryDir> WebcamScan::folder_;

TEST_F(WebcamScan, FindsTheSpotsWhereTheyAre) {
    ASSERT_TRUE(desk.connectSkin());
    ASSERT_TRUE(useWebcam());
    ASSERT_TRUE(desk.scanHere()) << desk.scan.why().toStdString();
    const World& world = desk.rig.world();
    const auto index = world.skin.indexById();
    Visibility any;
    any.maxAngle = 89 * kDegree;
    const ScannedView& view = desk.session().measured().views.back();
    EXPECT_GT(view.decoded.found.size(), 5U);
    for (const LedDetection& led : view.decoded.found) {
        const auto truth = visiblePixel(world, desk.rig.cameraPose(), 0, index.at(led.module), any);
        ASSERT_TRUE(truth);
        EXPECT_LT((led.pixel - *truth).norm(), 0.2);
    }
}

TEST_F(WebcamScan, IsBrokenOffByAnUnpluggedCameraAndDoneOnceItIsBack) {
    ASSERT_TRUE(desk.connectSkin());
    ASSERT_TRUE(useWebcam());
    desk.scan.start();
    ASSERT_TRUE(waitFor([&] { return desk.scan.state().taken() >= 3; }));
    webcam->unplug();
    ASSERT_TRUE(waitFor([&] { return desk.scan.state().phase == ScanRun::Phase::Failed; }));
    EXPECT_THAT(desk.scan.why().toStdString(), testing::HasSubstr("plug it in again"));
    EXPECT_TRUE(desk.session().measured().views.empty());
    webcam->plug();
    // Nobody has to do anything for that.
    ASSERT_TRUE(waitFor([&] { return desk.scan.obstacle().isEmpty(); }));
    EXPECT_TRUE(desk.scanHere());
}

}  // namespace
}  // namespace skincal
