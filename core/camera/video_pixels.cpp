#include "core/camera/video_pixels.h"

#include <opencv2/imgproc.hpp>

namespace skincal {
namespace {

std::size_t bytesPerPixel(PixelLayout layout) {
    switch (layout) {
        case PixelLayout::Luma:
            return 1;
        case PixelLayout::LumaHigh:
        case PixelLayout::Yuyv:
        case PixelLayout::Uyvy:
            return 2;
        default:
            return 4;
    }
}

cv::Mat picked(const cv::Mat& pixels, int channel) {
    cv::Mat result;
    cv::extractChannel(pixels, result, channel);
    return result;
}

cv::Mat bgrFrom(const cv::Mat& pixels, const std::array<int, 6>& fromTo) {
    cv::Mat result(pixels.size(), CV_8UC3);
    cv::mixChannels(&pixels, 1, &result, 1, fromTo.data(), 3);
    return result;
}

}  // namespace

cv::Mat pictureOf(PixelLayout layout, std::span<const std::uint8_t> bytes, int width, int height,
                  std::ptrdiff_t stride) {
    const std::size_t row = static_cast<std::size_t>(std::max(width, 0)) * bytesPerPixel(layout);
    if (width <= 0 || height <= 0 || stride < 0 || static_cast<std::size_t>(stride) < row ||
        bytes.size() < static_cast<std::size_t>(stride) * static_cast<std::size_t>(height - 1) + row)
        return {};
    const int type = CV_8UC(static_cast<int>(bytesPerPixel(layout)));
    // Only read from.
    const cv::Mat pixels(height, width, type, const_cast<std::uint8_t*>(bytes.data()),
                         static_cast<std::size_t>(stride));
    switch (layout) {
        case PixelLayout::Luma:
            return pixels.clone();
        case PixelLayout::Yuyv:
            return picked(pixels, 0);
        case PixelLayout::LumaHigh:  // the lower byte comes first
        case PixelLayout::Uyvy:
            return picked(pixels, 1);
        case PixelLayout::Bgra:
            return bgrFrom(pixels, {0, 0, 1, 1, 2, 2});
        case PixelLayout::Rgba:
            return bgrFrom(pixels, {2, 0, 1, 1, 0, 2});
        case PixelLayout::Argb:
            return bgrFrom(pixels, {3, 0, 2, 1, 1, 2});
        default:
            return bgrFrom(pixels, {1, 0, 2, 1, 3, 2});
    }
}

}  // namespace skincal
