#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/camera_calibration/board_plan.h"
#include "core/camera_calibration/board_view.h"

namespace skincal {

/// Inner corners of a ChArUco board in a grey picture, by rising id; none where there is no board. May throw
/// cv::Exception.
[[nodiscard]] std::vector<BoardCorner> charucoCorners(const cv::Mat& grey, const BoardPlan& plan);

/// Bits of a marker with its black border, one value a bit, 0 where it is black.
[[nodiscard]] cv::Mat markerPattern(const BoardPlan& plan, int id);

}  // namespace skincal
