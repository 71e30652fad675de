#pragma once

#include "core/estimation/body_solution.h"

namespace skincal {

/// Whether so many detections of a view are rejected that the view itself is to be doubted.
[[nodiscard]] bool manyRejected(const BodySolution& solution, std::size_t view);

/// Looks in one view for two places of the camera that explain its detections together: it was knocked half-way through
/// the scan. The view keeps the place that explains more; the other's detections are set aside and the finding noted.
/// Looks for a near place only (10 cm, 10 degrees): detections that are false by chance fit none.
/// @return true where detections were set aside.
bool setSecondPlaceAside(BodySolution& solution, std::size_t view);

}  // namespace skincal
