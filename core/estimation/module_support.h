#pragma once

#include <vector>

#include "core/adjustment/body_adjustment.h"

namespace skincal {

/// Which modules something measured holds in all six degrees of freedom. A module whose rotation gravity tells is held.
/// Of the others, those are that at least three points not on a line tie to the rest: link points shared with held
/// modules, and the LED where two placed views saw it. Two link points alone leave a hinge open. Modules may hold each
/// other: without any gravity it is the LEDs of a whole patch that give it its shape.
/// @param measured  per module: its rotation follows from gravity.
/// @param input     the pixels that count and the links that join neighbours.
[[nodiscard]] std::vector<bool> heldModules(const AdjustmentInput& input, const BodyState& state,
                                            const std::vector<bool>& measured);

}  // namespace skincal
