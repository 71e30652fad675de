#pragma once

#include <opencv2/core/mat.hpp>

#include "core/camera_calibration/board_plan.h"
#include "core/camera_calibration/board_view.h"
#include "core/geometry/random.h"
#include "core/vision/camera_model.h"

namespace skincal::test {

struct PaintOptions {
    double blur_px = 0.7;  ///< Gaussian, of lens and sensor
    double noise = 2;      ///< levels
    int samples = 4;       ///< rays per pixel, each way
    std::uint64_t seed = 0;
};

/// The board as a camera sees it from T_v_b: rays through each pixel, distortion included, meet the board's plane.
[[nodiscard]] cv::Mat paintBoard(const CameraModel& camera, const BoardPlan& plan, const Eigen::Isometry3d& T_v_b,
                                 const PaintOptions& options = {});

/// True pixels of the board's corners within the picture, with noise of sigma_px added.
[[nodiscard]] BoardView seeBoard(const CameraModel& camera, const BoardPlan& plan, const Eigen::Isometry3d& T_v_b,
                                 Random& random, double sigma_px);

/// A pose in which the board's middle lies at a random place of the picture, up to 35 degrees askew.
[[nodiscard]] Eigen::Isometry3d randomPose(const CameraModel& camera, const BoardPlan& plan, Random& random,
                                           double maxTilt_deg = 35);

}  // namespace skincal::test
