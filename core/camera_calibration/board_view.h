#pragma once

#include <opencv2/core/types.hpp>
#include <vector>

#include "core/geometry/se3.h"

namespace skincal {

struct BoardCorner {
    int id = 0;  ///< as BoardPlan::corner counts
    Vector2d pixel = Vector2d::Zero();
};

/// A board as one picture shows it.
struct BoardView {
    cv::Size size;                     ///< of the picture, pixels
    std::vector<BoardCorner> corners;  ///< by rising id, each once
    double blur_px = 0;                ///< standard deviation of the blur across edges, as measureBlur has it
    double square_px = 0;              ///< median side of a square in the picture
};

}  // namespace skincal
