#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

#include "core/camera_calibration/board_plan.h"
#include "core/geometry/se3.h"
#include "core/simulation/renderer.h"
#include "core/vision/camera_model.h"

namespace skincal {

/// Draws a printed board as a camera sees it: rays through parts of each pixel, bent by the lens, meet the board's
/// plane. While it moves, each part of a pixel sees it at another moment of the exposure, which smears it as a shutter
/// does. Rays are those of CameraModel to 0.003 pixels.
class BoardPainter {
  public:
    /// Rays through one pixel, and moments of one exposure.
    static constexpr int kSamples = 16;

    explicit BoardPainter(const CameraModel& camera, double blur_px);

    /// @param T_v_b  one pose where the board is still, else kSamples, evenly over the exposure
    /// Empty where no part of the board is in the picture. Throws std::logic_error for other numbers of poses.
    [[nodiscard]] HeldLayer paint(const BoardPlan& plan, std::span<const Isometry3d> T_v_b);

  private:
    [[nodiscard]] Vector2d rayAt(int column, int row) const;
    void print(const BoardPlan& plan);
    [[nodiscard]] cv::Rect boxOf(std::span<const Isometry3d> T_v_b) const;

    CameraModel camera_;
    double blur_px_;
    cv::Mat rays_;  ///< of pixels on a grid
    BoardPlan plan_;
    cv::Mat sheet_;  ///< the board from above, grey levels of paper and ink; empty before the first
};

}  // namespace skincal
