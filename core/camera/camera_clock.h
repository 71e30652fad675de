#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

namespace skincal {

/// Brings the times that a camera gives its pictures onto the computer's clock, and numbers the pictures.
///
/// time = camera time + offset - lead, where the offset is the smallest delay seen so far between a picture's own time
/// and its arrival; it may grow by maxDrift, so that a camera clock that runs slower is followed (one that runs faster
/// always is). What the fastest picture was late is not known: hence `lead`, taken off every time so that none is later
/// than the exposure it stands for. A picture that is delayed does not look newer than it is.
class CameraClock {
  public:
    using Time = std::chrono::microseconds;

    struct Stamp {
        Time time{};                 ///< on the computer's clock
        std::uint64_t sequence = 0;  ///< rises by the periods that passed since the picture before, at least by 1
    };

    /// @param period  between two pictures; 0 where it is not known: then the sequence rises by 1 each time
    /// @param lead    see above
    /// @param first   sequence of the first picture
    CameraClock(Time period, Time lead, std::uint64_t first) : period_(period), lead_(lead), next_(first) {}

    /// @param camera   the picture's own time, on any clock; nothing where it has none: then the time is the arrival's
    /// @param arrival  on the computer's clock
    /// A camera time that goes back begins anew: the camera's clock was set.
    [[nodiscard]] Stamp stamp(std::optional<Time> camera, Time arrival);

    static constexpr double kMaxDrift = 500e-6;

  private:
    Time period_;
    Time lead_;
    std::uint64_t next_;
    std::optional<Time> camera_;  ///< of the picture before
    Time offset_{};
};

}  // namespace skincal
