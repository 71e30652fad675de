#pragma once

#include <chrono>

#include "core/geometry/se3.h"

namespace skincal {

/// A camera in somebody's hand, or on a tripod that he moves. Poses are those in the body.
class HeldCamera {
  public:
    using Time = std::chrono::microseconds;

    static constexpr Time kMove{1'000'000};  ///< a move takes this long, whatever its length

    explicit HeldCamera(const Isometry3d& T_r_v) : from_(T_r_v), to_(T_r_v) {}

    /// Moves it from where it is at `now`, straight and turning about one axis.
    void move(const Isometry3d& T_r_v, Time now);
    /// Puts it there at once; a move ends.
    void jump(const Isometry3d& T_r_v, Time now);

    /// Exactly where it was moved to, from restsAt() on.
    [[nodiscard]] Isometry3d pose(Time time) const;
    [[nodiscard]] Time restsAt() const { return end_; }

  private:
    Isometry3d from_;
    Isometry3d to_;
    Time begin_{};
    Time end_ = Time::min();
};

}  // namespace skincal
