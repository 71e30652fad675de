#include "core/camera/video_pixels.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "core/geometry/random.h"

namespace skincal {
namespace {

struct Case {
    PixelLayout layout;
    int bytes;               ///< per pixel
    std::vector<int> picks;  ///< of these, the channels of the picture
};

const std::vector<Case> kCases = {
    {PixelLayout::Luma, 1, {0}},       {PixelLayout::LumaHigh, 2, {1}},   {PixelLayout::Yuyv, 2, {0}},
    {PixelLayout::Uyvy, 2, {1}},       {PixelLayout::Bgra, 4, {0, 1, 2}}, {PixelLayout::Rgba, 4, {2, 1, 0}},
    {PixelLayout::Argb, 4, {3, 2, 1}}, {PixelLayout::Abgr, 4, {1, 2, 3}},
};

TEST(VideoPixels, AreThoseInMemoryWhateverTheStride) {
    for (const Case& one : kCases) {
        for (std::uint64_t seed = 0; seed < 20; ++seed) {
            Random random(seed, "pixels");
            const int width = 1 + static_cast<int>(random.index(40));
            const int height = 1 + static_cast<int>(random.index(30));
            const auto stride =
                static_cast<std::ptrdiff_t>(static_cast<std::size_t>(width * one.bytes) + random.index(9));
            // The last row may end with its last pixel.
            std::vector<std::uint8_t> bytes(static_cast<std::size_t>(stride * (height - 1) + width * one.bytes));
            for (auto& byte : bytes)
                byte = static_cast<std::uint8_t>(random.index(256));
            const cv::Mat picture = pictureOf(one.layout, bytes, width, height, stride);
            ASSERT_EQ(picture.size(), cv::Size(width, height));
            ASSERT_EQ(picture.channels(), static_cast<int>(one.picks.size()));
            for (int row = 0; row < height; ++row) {
                for (int column = 0; column < width; ++column) {
                    for (std::size_t channel = 0; channel < one.picks.size(); ++channel)
                        ASSERT_EQ(
                            picture.ptr(row)[column * picture.channels() + static_cast<int>(channel)],
                            bytes[static_cast<std::size_t>(row * stride + column * one.bytes + one.picks[channel])]);
                }
            }
            // Memory of its own.
            std::fill(bytes.begin(), bytes.end(), std::uint8_t{0});
            const cv::Mat dark = pictureOf(one.layout, bytes, width, height, stride);
            EXPECT_NE(picture.data, dark.data);
        }
    }
}

TEST(VideoPixels, AreNotReadBeyondWhatIsThere) {
    const std::vector<std::uint8_t> bytes(640 * 480 - 1);
    EXPECT_TRUE(pictureOf(PixelLayout::Luma, bytes, 640, 480, 640).empty());
    EXPECT_FALSE(pictureOf(PixelLayout::Luma, bytes, 639, 480, 640).empty());
    EXPECT_TRUE(pictureOf(PixelLayout::Luma, bytes, 641, 10, 640).empty());
    EXPECT_TRUE(pictureOf(PixelLayout::Luma, bytes, 640, 10, -640).empty());
    EXPECT_TRUE(pictureOf(PixelLayout::Luma, bytes, 0, 10, 640).empty());
    EXPECT_TRUE(pictureOf(PixelLayout::Luma, bytes, 10, 0, 640).empty());
    EXPECT_TRUE(pictureOf(PixelLayout::Luma, {}, 1, 1, 1).empty());
    EXPECT_TRUE(pictureOf(PixelLayout::Bgra, bytes, 320, 241, 1280).empty());
}

}  // namespace
}  // namespace skincal
