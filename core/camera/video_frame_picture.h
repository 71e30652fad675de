#pragma once

#include <opencv2/core/mat.hpp>

class QVideoFrame;

namespace skincal {

/// The picture in memory of its own: luma (CV_8UC1) of YUV and grey formats, BGR (CV_8UC3) of all others. Luma is read
/// straight from the mapped plane; of what has no such plane Qt makes an image first, which takes some ten times
/// longer. Empty where the frame can't be mapped: it is of no device any more, or of a format that Qt cannot read.
[[nodiscard]] cv::Mat pictureOf(const QVideoFrame& frame);

}  // namespace skincal
