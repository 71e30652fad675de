#pragma once

#include <cstddef>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>

namespace skincal {

/// How the pixels of a picture's first plane lie in memory, as far as they have to be told apart.
enum class PixelLayout : std::uint8_t {
    Luma,      ///< one byte of luma per pixel: Y8, and the first plane of planar and semi-planar YUV
    LumaHigh,  ///< two bytes per pixel, luma in the higher one: Y16, P010, P016
    Yuyv,      ///< luma in even bytes
    Uyvy,      ///< luma in odd bytes
    Bgra,      ///< any fourth byte
    Rgba,
    Argb,
    Abgr,
};

/// A picture in memory of its own: luma as it is, without converting anything, or BGR.
/// @param bytes   of the plane
/// @param stride  bytes from row to row
/// Empty where the plane is smaller than width, height and stride say: nobody reads beyond what was mapped.
[[nodiscard]] cv::Mat pictureOf(PixelLayout layout, std::span<const std::uint8_t> bytes, int width, int height,
                                std::ptrdiff_t stride);

}  // namespace skincal
