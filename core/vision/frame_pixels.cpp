#include "core/vision/frame_pixels.h"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

namespace skincal {

tl::expected<FramePixels, Sentence> FramePixels::make(cv::Mat picture, const std::string& file, cv::Size expected,
                                                      bool coloured) {
    if (picture.empty())
        return tl::unexpected(Sentence::saying("{}: the picture is empty", file));
    if (picture.depth() != CV_8U || (picture.channels() != 1 && picture.channels() != 3))
        return tl::unexpected(Sentence::saying("{}: expected an 8-bit grey or colour picture", file));
    constexpr int kSmallest = 4;
    if (picture.cols < kSmallest || picture.rows < kSmallest)
        return tl::unexpected(Sentence::saying("{}: expected at least {} x {} pixels, found {} x {}", file, kSmallest,
                                               kSmallest, picture.cols, picture.rows));
    if (expected.area() > 0 && picture.size() != expected)
        return tl::unexpected(
            Sentence::saying("{}: expected {} x {} pixels as in the view's other frames, found {} x {}", file,
                             expected.width, expected.height, picture.cols, picture.rows));
    if (coloured && picture.channels() != 3)
        return tl::unexpected(Sentence::saying("{}: a grey picture of LEDs that were lit in colours", file));
    return FramePixels(std::move(picture));
}

cv::Mat FramePixels::plane(int channel) const {
    if (picture_.channels() == 1)
        return picture_;
    cv::Mat plane;
    if (channel >= 0)
        cv::extractChannel(picture_, plane, channel);
    else
        cv::transform(picture_, plane, cv::Matx13f(1.0F / 3, 1.0F / 3, 1.0F / 3));
    return plane;
}

}  // namespace skincal
