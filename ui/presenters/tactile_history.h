#pragma once

#include <Eigen/Core>
#include <array>
#include <chrono>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/device/skin_device.h"

namespace skincal {

/// What is kept of a reading: 12 bytes, as halves are finer than any of the sensors. All are NaN where a module sent
/// nothing.
struct FeltModule {
    Eigen::half proximity, temperature, acceleration;  ///< acceleration: its length, m/s^2
    std::array<Eigen::half, 3> cells;                  ///< N

    [[nodiscard]] bool isKnown() const { return !(Eigen::numext::isnan)(proximity); }
    /// Of all cells, N.
    [[nodiscard]] float force() const {
        return static_cast<float>(cells[0]) + static_cast<float>(cells[1]) + static_cast<float>(cells[2]);
    }
};

/// The last seconds of what a skin felt, every sample of every module. Its memory is fixed when it is made: 36 MB for
/// 1,000 modules; add() allocates nothing.
class TactileHistory {
  public:
    using Time = std::chrono::microseconds;

    static constexpr Time kSpan{30'000'000};
    static constexpr std::size_t kFrames = 3000;  ///< 30 s at 100 Hz; it reaches back less far of a quicker device

    explicit TactileHistory(std::vector<ModuleId> modules, std::size_t frames = kFrames);

    /// Readings of unknown modules are left out. A sample that is not later than the last begins anew: the device's
    /// clock was set back.
    void add(const TactileSample& sample);
    void clear();

    [[nodiscard]] const std::vector<ModuleId>& modules() const { return modules_; }
    [[nodiscard]] std::optional<std::size_t> indexOf(ModuleId module) const;

    /// Frames that are kept; 0 is the oldest.
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] Time timeOf(std::size_t frame) const { return times_[slot(frame)]; }
    /// Of a frame, in the order of modules().
    [[nodiscard]] std::span<const FeltModule> at(std::size_t frame) const;
    /// The newest frame that is not later; the oldest where all are. Nothing where there is none.
    [[nodiscard]] std::optional<std::size_t> frameAt(Time time) const;

  private:
    [[nodiscard]] std::size_t slot(std::size_t frame) const { return (first_ + frame) % times_.size(); }

    std::vector<ModuleId> modules_;
    std::unordered_map<ModuleId, std::size_t> index_;
    std::vector<Time> times_;
    std::vector<FeltModule> felt_;    ///< frame by frame
    std::vector<std::size_t> order_;  ///< where the readings of the last sample belonged: they rarely come in another
    std::size_t first_ = 0;
    std::size_t count_ = 0;
};

}  // namespace skincal
