#pragma once

#include <opencv2/core/mat.hpp>

namespace skincal {

/// A plane at half its size, smoothed, less the mean of its surroundings: what stands out from them, in units of
/// 1 / kContrastUnits grey levels (CV_16S). Where a lamp lights all of a place alike nothing is left. Fixed point, and
/// loops that compilers make vectors of: this is done with every picture while it is taken.
/// @param plane         8-bit grey, at least 2 x 2; an odd row or column at the end is not looked at
/// @param smoothing_px  standard deviation of a Gaussian, pixels of the half-size picture, at most 3
/// @param surroundings  side of a square in pixels of the half-size picture, odd
[[nodiscard]] cv::Mat localContrast(const cv::Mat& plane, double smoothing_px, int surroundings);

constexpr double kContrastUnits = 64;

}  // namespace skincal
