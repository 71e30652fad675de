#pragma once

#include <opencv2/core/mat.hpp>

namespace skincal {

/// How much light has come, or gone, since a reference picture: grey levels over all pixels and channels,
///   sum max(0, picture - reference - 20) - sum max(0, reference - picture - 20)
/// Noise, and light of the room that changes little, count for nothing; an LED some thousand.
/// @param picture, reference  8 bit; 0 where they don't have the same size and type
[[nodiscard]] double lightChange(const cv::Mat& picture, const cv::Mat& reference);

/// Whether all pixels are alike, as in the dark where a camera's noise is below a step.
[[nodiscard]] bool isOfOneLevel(const cv::Mat& picture);

/// Whether two pictures agree in every pixel, as no two of a camera do, but for those of one level: it has noise.
[[nodiscard]] bool isSamePicture(const cv::Mat& a, const cv::Mat& b);

}  // namespace skincal
