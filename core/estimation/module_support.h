#pragma once

#include <vector>

#include "core/adjustment/body_adjustment.h"

namespace skincal {

/// Which modules something measured holds in all six degrees of freedom. A module whose rotation gravity tells is held.
/// Of the others, those are that at least three points not on a line tie to the rest: link points shared with held
/// modules, and the LED where a placed view saw it. Two link points alone leave a hinge open.
/// @param measured  per module: its rotation follows from gravity.
/// @param input     the pixels that count and the links that join neighbours.
[[nodiscard]] std::vector<bool> heldModules(const AdjustmentInput& input, const BodyState& state,
                                            std::vector<bool> measured);

}  // namespace skincal
