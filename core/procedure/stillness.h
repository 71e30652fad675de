#pragma once

#include <chrono>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "core/skin/skin.h"

namespace skincal {

struct StillnessOptions {
    std::chrono::milliseconds window{500};
    /// m/s^2. At rest readings scatter by the sensors' noise, 0.03 for good ones; a hand that holds an arm moves them
    /// by more than this.
    double restsBelow = 0.15;

    [[nodiscard]] bool validate() const { return window.count() > 0 && restsBelow > 0; }
};

/// Watches all accelerometers at once: does the body rest, and what did they read meanwhile? Where samples are so far
/// apart that the usual window would not hold three, as those of many modules on a slow line are, it is as long as
/// they take.
class StillnessMeter {
  public:
    /// Throws std::logic_error where options are out of range.
    explicit StillnessMeter(std::vector<ModuleId> modules, const StillnessOptions& options = {});

    /// @param acceleration  in the order of the modules; nothing where a module did not answer.
    void add(std::chrono::microseconds time, std::span<const std::optional<Vector3d>> acceleration);
    void clear();

    /// Up to the newest sample.
    [[nodiscard]] std::chrono::microseconds window() const;

    /// How much readings have scattered during the window, standard deviation per axis, rms over the modules, m/s^2.
    /// Nothing where what came during the window spans less than half of it: at the beginning, after a gap.
    [[nodiscard]] std::optional<double> movement() const;
    [[nodiscard]] bool isAtRest() const;

    /// Mean of each module since `from`, with the standard deviation of that mean and how many samples it is of;
    /// modules with fewer than two samples have none. No standard deviation where it is below kSmallestSigma: a sensor
    /// whose steps are coarser than its noise reads the same again and again and still is not exact. What is older than
    /// kKept is forgotten, but for the few newest.
    [[nodiscard]] std::vector<GravityReading> meansSince(std::chrono::microseconds from, int pose) const;

    static constexpr std::chrono::seconds kKept{3};
    static constexpr double kSmallestSigma = 1e-6;  ///< m/s^2, the smallest that recordings take

  private:
    struct Sample {
        std::chrono::microseconds time{};
        std::vector<std::optional<Vector3d>> acceleration;
    };

    /// Shortest time between samples, of the few newest: gaps are none of it. Zero before there are three.
    [[nodiscard]] std::chrono::microseconds period() const;

    std::vector<ModuleId> modules_;
    StillnessOptions options_;
    std::deque<Sample> samples_;
};

/// Turn between a pose and the nearest of those captured: the angle between what modules read, median over those that
/// have both, rad; pi where there is none. Turns about gravity don't show.
[[nodiscard]] double angleToNearestPose(std::span<const GravityReading> captured, std::span<const GravityReading> now);

}  // namespace skincal
