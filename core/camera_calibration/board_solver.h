#pragma once

#include <ceres/problem.h>

#include <array>
#include <optional>
#include <span>
#include <tl/expected.hpp>
#include <vector>

#include "core/camera_calibration/board_projection.h"
#include "core/camera_calibration/calibrate_camera.h"

namespace skincal {

/// The state of one calibration: intrinsics, poses of the boards, and which of them count. Steps as calibrateCamera
/// tells; inputs are checked there and outlive it.
class BoardSolver {
  public:
    BoardSolver(std::span<const BoardView> views, const BoardPlan& plan, const CameraCalibrationOptions& options,
                const RunContext& context);
    /// The focal length, of a few, with which the boards' own poses explain them best; then poses for it.
    void start();
    [[nodiscard]] std::size_t usedCount() const;
    [[nodiscard]] tl::expected<void, CalibrationError> solve(bool robust);
    /// Takes out what stands out; true where anything did.
    bool rejectBoards();
    [[nodiscard]] CameraCalibration result();

  private:
    using Pose = std::array<double, 6>;  ///< angle-axis and translation of T_v_b

    [[nodiscard]] CameraModel plainCamera(double f) const;
    [[nodiscard]] std::vector<Vector2d> residualsOf(const BoardView& view, const Pose& pose,
                                                    const Intrinsics& intrinsics) const;
    /// Which of the intrinsics aren't estimated.
    [[nodiscard]] std::vector<int> fixedOnes() const;
    void build(ceres::Problem& problem, bool robust);
    [[nodiscard]] std::optional<IntrinsicsSigma> sigmas(double squares, std::size_t observations);

    std::span<const BoardView> views_;
    const BoardPlan& plan_;
    const CameraCalibrationOptions& options_;
    const RunContext& context_;
    Intrinsics intrinsics_{};
    std::vector<Pose> poses_;
    std::vector<bool> used_;
    std::vector<bool> hasPose_;
};

}  // namespace skincal
