#pragma once

#include <span>
#include <vector>

#include "core/vision/spot_series.h"

namespace skincal {

/// Light of LEDs in each plane relative to the scan's usual: a camera that steps its exposure changes all of them
/// alike. The median over what shines (half as much at least as the brightest tenth) of a spot's light over the most
/// that it has in a plane (that nine planes in ten stay below). Ground that is brighter than its surroundings is taken
/// off, since the sun changes that, too; a clipped LED counts as having its most. Of very many spots 2,000 are asked.
/// Left out are spots that are not three times as strong as their noise or have less than 0.4 of what the strongest few
/// have, those whose ground is black in a plane, and planes in which that is most. 1 where fewer than three LEDs shine,
/// and for steps of less than 5 %, which LEDs make by themselves.
/// @param sigma     per spot, of its light
/// @param litCount  per plane, how many modules are lit in it
[[nodiscard]] std::vector<double> exposureGains(const SpotSeries& series, std::span<const double> sigma,
                                                std::span<const std::size_t> litCount);

}  // namespace skincal
