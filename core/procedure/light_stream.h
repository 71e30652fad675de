#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/procedure/light_timing.h"

namespace skincal {

/// A pattern that is lit in its turn, or was, or will be.
struct LightShow {
    using Time = LightPlan::Time;

    std::size_t frame = 0;
    Time commanded{};                    ///< when it is to be lit, not when that was said
    std::optional<Time> acknowledged{};  ///< all LEDs have latched it by then

    friend bool operator==(const LightShow&, const LightShow&) = default;
};

/// Which of the shows a picture shows and nothing else; nothing where it may show two, or one that nobody has
/// acknowledged.
/// @param shows  in the order in which they were commanded
/// @param now    when the picture came
[[nodiscard]] std::optional<std::size_t> showIn(std::span<const LightShow> shows, LightShow::Time picture,
                                                LightShow::Time now, const LightPlan& plan);

/// How many of the shows, the first of them, no picture after this one can show any more. The last one never counts: it
/// stays lit.
[[nodiscard]] std::size_t showsOver(std::span<const LightShow> shows, LightShow::Time picture, const LightPlan& plan);

/// When to light the next pattern: as soon as the last one has been lit for its periods, so that the camera's pictures
/// fall where the plan aims.
/// @param picture   time of the newest picture
/// @param earliest  the device must know beforehand
[[nodiscard]] LightShow::Time nextShowAt(std::span<const LightShow> shows, LightShow::Time picture,
                                         LightShow::Time earliest, const LightPlan& plan);

/// Whether the last pattern has been lit for its periods, give or take half of one: for devices that light at once.
[[nodiscard]] bool isNextShowDue(std::span<const LightShow> shows, LightShow::Time now, const LightPlan& plan);

}  // namespace skincal
