#pragma once

#include <chrono>
#include <vector>

#include "core/camera_calibration/board_plan.h"
#include "core/geometry/se3.h"
#include "core/vision/camera_model.h"

namespace skincal {

/// A calibration board in somebody's hands who shows it to a camera as one should: to the middle, edges and corners of
/// the picture, near and far, turned and tilted; still for a moment in each place, and round and round. All of it stays
/// in the picture, with its paper; a board that is higher than wide is held by a quarter turned. Where it is depends on
/// plan, camera and the time since it was taken up alone.
class HeldBoard {
  public:
    using Time = std::chrono::microseconds;

    static constexpr Time kMove{500'000};  ///< from one place to the next
    static constexpr Time kStill{500'000};

    /// Share of a square that the paper is wider than the squares, on each side.
    static constexpr double kPaper = 0.375;

    /// @param start  when it is taken up, still in its first place
    /// Throws std::logic_error for a plan that isn't valid.
    HeldBoard(const BoardPlan& plan, const CameraModel& camera, Time start);

    [[nodiscard]] const BoardPlan& plan() const { return plan_; }
    /// T_v_b, the board frame being BoardPlan's.
    [[nodiscard]] Isometry3d pose(Time time) const;
    /// How many places there are before it begins again.
    [[nodiscard]] std::size_t places() const { return T_v_m_.size(); }
    [[nodiscard]] bool isStill(Time time) const;

  private:
    BoardPlan plan_;
    Time start_;
    std::vector<Isometry3d> T_v_m_;  ///< of the board's middle, about which it is turned
};

}  // namespace skincal
