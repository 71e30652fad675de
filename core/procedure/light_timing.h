#pragma once

#include <chrono>
#include <optional>
#include <span>
#include <tl/expected.hpp>
#include <vector>

namespace skincal {

/// All LEDs going on, or off, at once, and what a camera saw of it. All times are of the clock that pictures carry.
struct LightToggle {
    using Time = std::chrono::microseconds;

    struct Picture {
        Time time{};
        double share = 0;  ///< of the change that it shows: 0 as before, 1 as afterwards
        friend bool operator==(const Picture&, const Picture&) = default;
    };

    Time commanded{};     ///< no LED changes before
    Time acknowledged{};  ///< all LEDs have changed by then
    /// By rising time, from one that was exposed before the command to one that shows the whole change.
    std::vector<Picture> pictures;

    friend bool operator==(const LightToggle&, const LightToggle&) = default;
};

/// When a camera shows what was lit.
///   a picture of time >= acknowledged + newFrom shows all of a change,
///   a picture of time < commanded + oldUntil shows nothing of it.
/// In between, one may show both: it is exposed for a while, and row after row with a rolling shutter.
struct LightTiming {
    using Time = std::chrono::microseconds;

    Time latency{};      ///< from an LED's change to the first picture that shows all of it, most likely
    Time uncertainty{};  ///< latency lies within +- this, but for jitter
    Time jitter{};       ///< by which toggles contradict each other at least, or pictures are off their period
    Time newFrom{};
    Time oldUntil{};
    Time period{};  ///< between two pictures
    Time answer{};  ///< the longest from a command to its acknowledgement

    friend bool operator==(const LightTiming&, const LightTiming&) = default;
};

enum class LightTimingError {
    NoChange,    ///< a toggle does not show in the pictures
    TooJittery,  ///< it shows now early, now late, or pictures come at odd times
};

struct LightTimingOptions {
    using Time = std::chrono::microseconds;

    double whole = 0.95;                             ///< share that counts as all of a change, and 1 - it as none
    Time maxJitter = std::chrono::milliseconds(50);  ///< more is TooJittery
    Time minMargin = std::chrono::milliseconds(6);   ///< see planLights()
    int minPeriods = 2;                              ///< that a pattern is lit for
    int maxPeriods = 6;

    [[nodiscard]] bool validate() const {
        return whole > 0.5 && whole <= 1 && maxJitter.count() >= 0 && minMargin.count() > 0 && minPeriods > 0 &&
               maxPeriods >= minPeriods;
    }
};

/// What toggles say of the time from a command to the pictures that show it. Each toggle j confines the latency L:
///   last picture without all of it - acknowledged_j  <  L  <=  first picture with all of it - commanded_j
/// and likewise oldUntil. Toggles at different times within a picture's period confine it the more. Where no L suits
/// all, they jitter by what is between them, and newFrom and oldUntil are those of the worst. Pictures that don't come
/// whole periods after each other jitter by how far they are off.
/// @param toggles  two or more, each with three or more pictures, else std::logic_error; also where times don't rise
[[nodiscard]] tl::expected<LightTiming, LightTimingError> estimateLightTiming(std::span<const LightToggle> toggles,
                                                                              const LightTimingOptions& options = {});

/// How patterns follow each other so that each has a picture of its own.
struct LightPlan {
    using Time = std::chrono::microseconds;

    Time period{};    ///< of the camera
    int periods = 0;  ///< that each pattern is lit for
    /// A picture shows pattern k and nothing else where
    ///   acknowledged_k + from <= time < commanded_(k+1) + until
    /// or where it came before the next one was to be lit.
    Time from{};
    Time until{};
    /// From a command to the picture that it is for, where commands can be timed.
    Time aim{};

    friend bool operator==(const LightPlan&, const LightPlan&) = default;
};

/// The least number of periods that leaves margins. A pattern that is lit for D periods T has pictures to itself for
///   slack = D T - answer - (newFrom - oldUntil)
/// Where the device lights at a given time, the picture is aimed at the middle of it, and half of the slack is margin
/// against jitter that the toggles did not show, the rest for pictures that come at odd times. Where it lights at once,
/// nobody knows how commands fall between pictures, and a whole period must fit, too. Margins are minMargin and twice
/// the jitter at least. Nothing where maxPeriods are not enough.
[[nodiscard]] std::optional<LightPlan> planLights(const LightTiming& timing, bool keepsTime,
                                                  const LightTimingOptions& options = {});

}  // namespace skincal
