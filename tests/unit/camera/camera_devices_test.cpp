#include "core/camera/camera_devices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>

#include "core/geometry/random.h"

namespace skincal {
namespace {

ListedCamera camera(std::string id, std::string description) {
    return {std::move(id), std::move(description), {{640, 480, 30}}, 0, {}};
}

TEST(Formats, AreListedOnceLargestFirst) {
    const auto formats = withoutDoubles(std::vector<FrameFormat>{
        {640, 480, 15}, {1280, 720, 30}, {640, 480, 30}, {640, 480, 29.97}, {0, 0, 30}, {1280, 720, 30}});
    EXPECT_EQ(formats, (std::vector<FrameFormat>{{1280, 720, 30}, {640, 480, 30}, {640, 480, 15}}));
}

TEST(Formats, TheUsualOneIsLargeAndSmooth) {
    EXPECT_EQ(usualFormat({{3840, 2160, 30}, {1920, 1080, 5}, {1280, 720, 30}, {640, 480, 60}}),
              (FrameFormat{1280, 720, 30}));
    EXPECT_EQ(usualFormat({{3840, 2160, 10}, {640, 480, 10}}), (FrameFormat{3840, 2160, 10}));
    EXPECT_EQ(usualFormat({}), FrameFormat{});
}

TEST(Cameras, ListedTwiceAreOne) {
    const auto cameras = withoutDoubles({camera("0", "A"), camera("1", "B"), camera("2", "A"), camera("3", "B")}, {});
    ASSERT_EQ(cameras.size(), 2U);
    EXPECT_EQ(cameras[0].id, "0");
    EXPECT_EQ(cameras[1].id, "1");
}

TEST(Cameras, OfOneNameAreAsManyAsThereAreNodes) {
    const std::vector<V4l2Node> nodes = {
        {"/dev/video0", "A"}, {"/dev/video2", "A"}, {"/dev/video4", "B"}, {"/dev/video6", "A", EACCES}};
    const auto cameras = withoutDoubles(
        {camera("0", "A"), camera("1", "A"), camera("2", "B"), camera("3", "A"), camera("4", "A"), camera("5", "B")},
        nodes);
    ASSERT_EQ(cameras.size(), 3U);
    EXPECT_EQ(cameras[1].id, "1");
    EXPECT_EQ(cameras[1].ordinal, 1U);
    // Which of the two nodes is whose cannot be told.
    EXPECT_EQ(cameras[0].node, "");
    EXPECT_EQ(cameras[2].node, "/dev/video4");
}

TEST(Cameras, AreFoundAgain) {
    const auto before = withoutDoubles({camera("0", "A"), camera("1", "B")}, {});
    // Out and in again it has another number.
    const auto after = withoutDoubles({camera("1", "B"), camera("7", "A")}, {});
    ASSERT_NE(findAgain(after, before[0]), nullptr);
    EXPECT_EQ(findAgain(after, before[0])->id, "7");
    EXPECT_EQ(findAgain(after, camera("1", "C")), nullptr);
    // A number that another camera has now.
    EXPECT_EQ(findAgain({camera("0", "C")}, before[0]), nullptr);
    EXPECT_EQ(findAgain({}, before[0]), nullptr);
}

TEST(Cameras, OfOneNameAreFoundByPlace) {
    const std::vector<V4l2Node> nodes = {{"/dev/video0", "A"}, {"/dev/video2", "A"}};
    const auto before = withoutDoubles({camera("0", "A"), camera("1", "A")}, nodes);
    const auto after = withoutDoubles({camera("5", "A"), camera("6", "A")}, nodes);
    EXPECT_EQ(findAgain(after, before[1])->id, "6");
    EXPECT_EQ(findAgain({after[0]}, before[1])->id, "5");
}

}  // namespace
}  // namespace skincal
