#include "core/camera/control_lock.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/random.h"
#include "tests/unit/camera/fake_v4l2.h"

namespace skincal {
namespace {

using test::FakeNode;
using Outcome = ControlState::Outcome;

struct ControlLocks : testing::Test {
    std::shared_ptr<FakeNode> node = FakeNode::webcam("Webcam");
    test::FakeV4l2::Open device{node};

    [[nodiscard]] std::vector<Outcome> lock(const ControlValues& values = {}) {
        lock_ = lockControls(device, values);
        std::vector<Outcome> outcomes;
        for (const ControlState& state : lock_.states)
            outcomes.push_back(state.outcome);
        return outcomes;
    }
    ControlLock lock_;
};

TEST_F(ControlLocks, SwitchTheAutomaticOffAndKeepTheValues) {
    EXPECT_THAT(lock(), testing::Each(Outcome::Locked));
    EXPECT_EQ(node->controls[V4L2_CID_EXPOSURE_AUTO].value, V4L2_EXPOSURE_MANUAL);
    EXPECT_EQ(node->controls[V4L2_CID_EXPOSURE_ABSOLUTE].value, 250);
    EXPECT_EQ(node->controls[V4L2_CID_EXPOSURE_AUTO_PRIORITY].value, 0);
    EXPECT_EQ(node->controls[V4L2_CID_AUTOGAIN].value, 0);
    EXPECT_EQ(node->controls[V4L2_CID_FOCUS_AUTO].value, 0);
    EXPECT_EQ(node->controls[V4L2_CID_AUTO_WHITE_BALANCE].value, 0);
    EXPECT_EQ(lock_.states[1].value, 64);
}

TEST_F(ControlLocks, TakeGivenValuesWithinTheRange) {
    EXPECT_THAT(lock({{CameraControl::Focus, 43}, {CameraControl::Exposure, 99999}}), testing::Each(Outcome::Locked));
    EXPECT_EQ(lock_.states[0].value, 2047);
    EXPECT_EQ(lock_.states[2].value, 45);  // in steps of 5
}

/// Whatever a camera has, refuses or ignores: afterwards it is as before.
TEST_F(ControlLocks, ArePutBackWhateverTheCameraIsLike) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        Random random(seed, "cameras");
        node = FakeNode::webcam("Webcam");
        std::erase_if(node->controls, [&](const auto&) { return random.uniform() < 0.2; });
        for (auto& [id, control] : node->controls) {
            control.value =
                control.minimum + control.step * static_cast<int>(random.index(static_cast<std::size_t>(
                                                     (control.maximum - control.minimum) / control.step + 1)));
            control.isRefused = random.uniform() < 0.2;
            control.isStubborn = random.uniform() < 0.2;
        }
        test::FakeV4l2::Open camera(node);
        const auto before = node->values();
        const ControlLock lock = lockControls(camera);
        ASSERT_EQ(lock.states.size(), kCameraControls.size());
        EXPECT_TRUE(restoreControls(camera, lock));
        EXPECT_EQ(node->values(), before) << seed;
    }
}

TEST_F(ControlLocks, SayWhatCannotBeLocked) {
    node->controls.erase(V4L2_CID_FOCUS_AUTO);
    node->controls.erase(V4L2_CID_FOCUS_ABSOLUTE);
    node->controls[V4L2_CID_AUTOGAIN].isStubborn = true;
    node->controls[V4L2_CID_AUTO_WHITE_BALANCE].isRefused = true;
    EXPECT_EQ(lock(), (std::vector{Outcome::Locked, Outcome::Automatic, Outcome::NotOffered, Outcome::Refused}));
}

TEST_F(ControlLocks, OfAValueWithoutAutomaticAreLocks) {
    node->controls.erase(V4L2_CID_AUTOGAIN);
    EXPECT_EQ(lock()[1], Outcome::Locked);
}

TEST_F(ControlLocks, ExposureIsInSeconds) {
    const auto range = exposureRange(device);
    ASSERT_TRUE(range);
    EXPECT_NEAR(range->first, 0.0003, 1e-12);
    EXPECT_NEAR(range->second, 0.2047, 1e-12);
    EXPECT_TRUE(setExposure(device, 0.01));
    EXPECT_NEAR(exposure(device).value(), 0.01, 1e-12);
    EXPECT_TRUE(setExposure(device, 5));
    EXPECT_NEAR(exposure(device).value(), 0.2047, 1e-12);
    node->controls.erase(V4L2_CID_EXPOSURE_ABSOLUTE);
    EXPECT_FALSE(exposureRange(device));
    EXPECT_FALSE(exposure(device));
    EXPECT_FALSE(setExposure(device, 0.01));
}

TEST(CaptureNodes, AreThoseThatGivePicturesAndThoseThatCannotBeOpened) {
    auto metadata = FakeNode::webcam("Webcam");
    metadata->can = V4L2_CAP_META_CAPTURE;
    auto forbidden = FakeNode::webcam("Secret");
    forbidden->openError = EACCES;
    const test::FakeV4l2 system(
        {{"/dev/video0", FakeNode::webcam("Webcam")}, {"/dev/video1", metadata}, {"/dev/video2", forbidden}});
    const auto nodes = captureNodes(system);
    ASSERT_EQ(nodes.size(), 2U);
    EXPECT_EQ(nodes[0].path, "/dev/video0");
    EXPECT_EQ(nodes[0].card, "Webcam");
    EXPECT_EQ(nodes[0].error, 0);
    EXPECT_EQ(nodes[1].path, "/dev/video2");
    EXPECT_EQ(nodes[1].error, EACCES);
    // Those of this machine, whatever it has.
    for (const V4l2Node& node : captureNodes(v4l2System()))
        EXPECT_FALSE(node.path.empty());
    EXPECT_EQ(v4l2System().open("/dev/video-none").error(), ENOENT);
}

TEST(Diagnosis, NamesWhatKeepsPicturesBack) {
    const auto node = FakeNode::webcam("Webcam");
    const test::FakeV4l2 system({{"/dev/video0", node}});
    EXPECT_FALSE(diagnose(system, "/dev/video0"));
    EXPECT_EQ(diagnose(system, "/dev/video1"), CameraTrouble::Unplugged);
    node->formatError = EBUSY;
    EXPECT_EQ(diagnose(system, "/dev/video0"), CameraTrouble::Busy);
    node->openError = EACCES;
    EXPECT_EQ(diagnose(system, "/dev/video0"), CameraTrouble::Forbidden);
    EXPECT_EQ(node->open, 0);
}

}  // namespace
}  // namespace skincal
