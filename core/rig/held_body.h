#pragma once

#include <array>
#include <chrono>
#include <cstdint>

#include "core/geometry/se3.h"

namespace skincal {

/// What a body feels as a whole at one time, all in the body frame.
struct BodyForces {
    Vector3d force_r = Vector3d::Zero();  ///< specific force at the pivot, m/s^2: gravity and the hand's tremble
    Vector3d spin_r = Vector3d::Zero();   ///< angular velocity, rad/s
    Vector3d twist_r = Vector3d::Zero();  ///< angular acceleration, rad/s^2
    Vector3d pivot_r = Vector3d::Zero();

    /// Specific force at a point of the body, m/s^2:
    ///   f(p) = f(pivot) + twist x d + spin x (spin x d),  d = p - pivot
    [[nodiscard]] Vector3d at(const Vector3d& p_r) const;
};

/// A body in somebody's hands, who turns it over and holds it still again. While it is turned the hands tremble: sines
/// of 4 to 12 Hz, 0.5 m/s^2 rms per axis, and the body sways by a degree; afterwards that dies out to exactly nothing.
/// How it trembles depends on the seed, the number of the turn and the time since it began alone.
class HeldBody {
  public:
    using Time = std::chrono::microseconds;

    static constexpr Time kTurn{1'000'000};  ///< a turn takes this long, whatever its angle
    static constexpr Time kSettle{800'000};  ///< and the tremble this long to die out

    /// @param up_r     unit vector that points against gravity at first, the body at rest
    /// @param pivot_r  what it is turned about
    /// @param start    it has been at rest since then
    HeldBody(const Vector3d& up_r, const Vector3d& pivot_r, Time start, std::uint64_t seed);

    /// Turns it from how it is held at `now` by the shortest way, where that is not unique by any. Of a body that is
    /// being turned: from there, as if it were stopped first.
    /// @param up_r  unit vector
    void turn(const Vector3d& up_r, Time now);

    /// Unit vector against gravity, without the sway.
    [[nodiscard]] Vector3d up(Time time) const;
    [[nodiscard]] BodyForces forces(Time time) const;
    /// From when on it is at rest.
    [[nodiscard]] Time restsAt() const { return begin_ + kTurn + kSettle; }

  private:
    struct Sine {
        double frequency = 0;  ///< Hz
        double phase = 0;
    };

    [[nodiscard]] double trembleAt(Time time) const;
    [[nodiscard]] Vector3d sines(Time time, std::size_t first) const;

    Vector3d from_r_;
    Vector3d axis_r_ = Vector3d::UnitX();  ///< of up's way in the body
    double angle_ = 0;
    Time begin_;  ///< of the latest turn
    int turns_ = 0;
    double trembleBefore_ = 0;
    Vector3d pivot_r_;
    std::array<Sine, 18> sines_{};  ///< three per axis, of the tremble and of the sway
};

}  // namespace skincal
