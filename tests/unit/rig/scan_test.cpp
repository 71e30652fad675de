#include <gtest/gtest.h>

#include <QEventLoop>

#include "core/rig/simulated_camera.h"
#include "core/rig/simulated_skin.h"
#include "core/vision/decoder.h"
#include "tests/unit/rig/pass.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

/// A coded scan as the window drives it: light, wait for the acknowledgement, then for the first picture that was
/// exposed after what the camera's latency can be at most.
class Scanner {
  public:
    Scanner(SimulatedRig& rig, SimulatedSkin& skin, SimulatedCamera& camera)
        : plan_(planScan(rig.world(), 0)), skin_(skin) {
        QObject::connect(&skin, &SkinDevice::lightShown, &context_, [this, &rig](std::uint64_t token) {
            if (token == token_)
                readyAt_ = rig.now() + 100ms;
        });
        QObject::connect(&camera, &FrameSource::frameArrived, &context_, [this](const CameraFrame& frame) {
            if (!readyAt_ || frame.time < *readyAt_)
                return;
            pictures_.push_back(frame.image);
            if (pictures_.size() == plan_.size())
                loop_.quit();
            else
                lightNext();
        });
    }

    ViewDetections scan(const World& world) {
        lightNext();
        loop_.exec();
        std::vector<ModuleId> ids;
        for (const SkinModule& module : world.skin.modules)
            ids.push_back(module.id);
        const FrameLoader load = [this](std::size_t k) -> tl::expected<cv::Mat, std::string> { return pictures_[k]; };
        const auto found = decodeView("live", ids, plan_, load);
        EXPECT_TRUE(found);
        return found.value_or(ViewDetections{});
    }

  private:
    void lightNext() {
        readyAt_.reset();
        token_ = skin_.light(plan_[pictures_.size()].lit);
    }

    QObject context_;
    QEventLoop loop_;
    std::vector<FrameInfo> plan_;
    SimulatedSkin& skin_;
    std::vector<cv::Mat> pictures_;
    std::uint64_t token_ = 0;
    std::optional<RigClock::Time> readyAt_;
};

TEST(Scan, ThroughSkinAndCameraFindsEveryVisibleModule) {
    SimulatedRig rig(*findScenario("coded"), 6);
    rig.setSpeed(0);
    SimulatedSkin skin(rig);
    SimulatedCamera camera(rig);
    skin.open();
    pass(rig.clock(), 50ms);
    camera.start();
    const World& world = rig.world();
    const auto index = world.skin.indexById();
    for (const Isometry3d& T_r_v : rig.suggestedViews()) {
        rig.moveCamera(T_r_v);
        pass(rig.clock(), HeldCamera::kMove);
        const ViewDetections found = Scanner(rig, skin, camera).scan(world);
        std::size_t visible = 0;
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
            visible += visiblePixel(world, T_r_v, 0, u, {}) ? 1U : 0U;
        EXPECT_GT(visible, 5U);
        EXPECT_GE(found.found.size() + 1, visible) << "one may be hard to see";
        for (const LedDetection& led : found.found) {
            Visibility any;
            any.maxAngle = 89 * kDegree;
            const auto truth = visiblePixel(world, T_r_v, 0, index.at(led.module), any);
            ASSERT_TRUE(truth);
            EXPECT_LT((led.pixel - *truth).norm(), 0.2);
        }
    }
}

TEST(Scan, FromAPlaceThatNoViewWasTakenFrom) {
    SimulatedRig rig(*findScenario("demo"), 2);
    rig.setSpeed(0);
    SimulatedSkin skin(rig);
    SimulatedCamera camera(rig);
    skin.open();
    pass(rig.clock(), 50ms);
    camera.start();
    Isometry3d T_r_v = rig.suggestedViews()[2];
    T_r_v.translation() += T_r_v.linear() * Vector3d(0.05, -0.03, 0.04);
    T_r_v.linear() *= so3Exp(Vector3d(0.03, 0.02, 0.3));
    rig.moveCamera(T_r_v);
    pass(rig.clock(), HeldCamera::kMove);
    const World& world = rig.world();
    const auto index = world.skin.indexById();
    const ViewDetections found = Scanner(rig, skin, camera).scan(world);
    EXPECT_GT(found.found.size(), 15U);
    for (const LedDetection& led : found.found) {
        Visibility any;
        any.maxAngle = 89 * kDegree;
        const auto truth = visiblePixel(world, T_r_v, 0, index.at(led.module), any);
        ASSERT_TRUE(truth);
        EXPECT_LT((led.pixel - *truth).norm(), 0.2);
    }
}

}  // namespace
}  // namespace skincal
