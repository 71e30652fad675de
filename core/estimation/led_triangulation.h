#pragma once

#include <optional>
#include <vector>

#include "core/estimation/body_solution.h"

namespace skincal {

/// Where rays meet: the point with the smallest squared distance to all of them, weighed by 1/sigma^2 of the pixel.
/// Nothing from fewer than two views, from rays that are parallel, or where a ray misses the point by more than `limit`
/// standard deviations.
[[nodiscard]] std::optional<Vector3d> triangulateLed(const BodySolution& solution,
                                                     const std::vector<PixelObservation>& detections,
                                                     std::size_t module, double limit = 5);

/// Per module: the one place at which its rejected detections have its LED, where there are more of them than of those
/// that count and they agree. Detections that are false by chance agree on nothing.
[[nodiscard]] std::vector<std::optional<Vector3d>> ledsSeenElsewhere(const BodySolution& solution);

}  // namespace skincal
