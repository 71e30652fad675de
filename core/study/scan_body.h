#pragma once

#include <vector>

#include "core/geometry/run_context.h"
#include "core/simulation/world.h"
#include "core/vision/detection.h"

namespace skincal {

/// What the joint estimate takes for LEDs of the spots that a picture left to choose from (Undetected::spots), with
/// nothing but that view and what the accelerometers read in the world's poses. Nothing where there is no body.
[[nodiscard]] std::vector<LedDetection> spotsTakenByBody(const World& world, const ViewDetections& view,
                                                         const RunContext& context = {});

}  // namespace skincal
