#include "core/camera/video_frame_picture.h"

#include <QImage>
#include <QVideoFrame>
#include <optional>

#include "core/camera/video_pixels.h"

namespace skincal {
namespace {

std::optional<PixelLayout> layoutOf(QVideoFrameFormat::PixelFormat format) {
    using Format = QVideoFrameFormat::PixelFormat;
    switch (format) {
        case Format::Format_Y8:
        case Format::Format_YUV420P:
        case Format::Format_YUV422P:
        case Format::Format_YV12:
        case Format::Format_NV12:
        case Format::Format_NV21:
        case Format::Format_IMC1:
        case Format::Format_IMC2:
        case Format::Format_IMC3:
        case Format::Format_IMC4:
            return PixelLayout::Luma;
        case Format::Format_Y16:
        case Format::Format_P010:
        case Format::Format_P016:
            return PixelLayout::LumaHigh;
        case Format::Format_YUYV:
            return PixelLayout::Yuyv;
        case Format::Format_UYVY:
            return PixelLayout::Uyvy;
        case Format::Format_BGRA8888:
        case Format::Format_BGRX8888:
            return PixelLayout::Bgra;
        case Format::Format_RGBA8888:
        case Format::Format_RGBX8888:
            return PixelLayout::Rgba;
        case Format::Format_ARGB8888:
        case Format::Format_XRGB8888:
            return PixelLayout::Argb;
        case Format::Format_ABGR8888:
        case Format::Format_XBGR8888:
            return PixelLayout::Abgr;
        default:
            return std::nullopt;
    }
}

cv::Mat pictureOf(const QImage& image) {
    if (image.isNull())
        return {};
    const QImage bgra = image.convertToFormat(QImage::Format_RGBX8888);
    return pictureOf(
        PixelLayout::Rgba,
        {bgra.constBits(), static_cast<std::size_t>(bgra.bytesPerLine()) * static_cast<std::size_t>(bgra.height())},
        bgra.width(), bgra.height(), bgra.bytesPerLine());
}

}  // namespace

cv::Mat pictureOf(const QVideoFrame& frame) {
    const auto layout = layoutOf(frame.pixelFormat());
    if (!layout)
        return pictureOf(frame.toImage());
    QVideoFrame mapped(frame);
    if (!mapped.map(QVideoFrame::ReadOnly))
        return {};
    cv::Mat picture;
    // Seen to be null and 0 after map() had succeeded.
    if (mapped.bits(0) != nullptr && mapped.mappedBytes(0) > 0)
        picture = pictureOf(*layout, {mapped.bits(0), static_cast<std::size_t>(mapped.mappedBytes(0))}, mapped.width(),
                            mapped.height(), mapped.bytesPerLine(0));
    mapped.unmap();
    return picture;
}

}  // namespace skincal
