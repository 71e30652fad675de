#pragma once

#include "core/estimation/body_solution.h"

namespace skincal {

/// Per view: whether so many of its detections are rejected that the view itself is to be doubted.
[[nodiscard]] std::vector<bool> viewsWithManyRejected(const BodySolution& solution);

/// Looks in one view for two near places of the camera (10 cm, 10 degrees) that explain its detections together: it was
/// knocked half-way through the scan. The view keeps the place that explains more; the other's detections are set aside
/// and the finding noted. Where there is one place only that explains more than the view's own, it goes there.
/// @return true where anything changed: solve again.
bool setSecondPlaceAside(BodySolution& solution, std::size_t view);

}  // namespace skincal
