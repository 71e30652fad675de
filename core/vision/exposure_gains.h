#pragma once

#include <span>
#include <vector>

#include "core/vision/spot_series.h"

namespace skincal {

/// Light of LEDs in each plane relative to the scan's usual: a camera that steps its exposure changes all of them
/// alike. The median over what shines (half as much at least as the brightest tenth) of a spot's light over the most
/// that it has in any plane. Ground that is brighter than its surroundings is taken off, since the sun changes that,
/// too; a clipped LED counts as having its most. Left out are spots that are not three times as strong as their noise
/// or far weaker than the strongest few, and planes in which most have black ground. 1 where fewer than three LEDs
/// shine, and for steps of less than 5 %, which LEDs make by themselves.
/// @param sigma     per spot, of its light
/// @param litCount  per plane, how many modules are lit in it
[[nodiscard]] std::vector<double> exposureGains(const SpotSeries& series, std::span<const double> sigma,
                                                std::span<const std::size_t> litCount);

}  // namespace skincal
