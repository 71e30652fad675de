#pragma once

#include <QImage>
#include <opencv2/core/mat.hpp>

namespace skincal {

/// A copy of an 8-bit picture, grey or BGR, for Qt.
[[nodiscard]] QImage toImage(const cv::Mat& picture);

}  // namespace skincal
