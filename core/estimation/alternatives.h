#pragma once

#include <vector>

#include "core/estimation/body_solution.h"

namespace skincal {

/// What to try where a patch does not fit its pictures, the likeliest first, each as `history` with one lesson more. A
/// patch does not fit where a third of its detections is rejected, where much of it was taken out, where its ports lie
/// apart, or where no pose was found for it though enough of it is seen.
///   - It moved as a whole since gravity was read.
///   - One of its links is a cable after all. Only links without which it falls apart are tried, for any other would
///     show by the ports it leaves apart; those first whose LEDs are the farthest apart in the pictures.
[[nodiscard]] std::vector<SolutionHistory> alternatives(const BodySolution& solution, const SolutionHistory& history,
                                                        const LayoutOptions& options, int most);

/// Whether a solution of the same measurements is the likelier one: detections that are rejected cost what one at the
/// limit of rejection does, modules without a place cost all their detections, and each cable and each patch with a
/// gravity of its own costs what a chance fit would.
[[nodiscard]] bool explainsMore(const BodySolution& solution, const BodySolution& than);

/// Names the patches that the history has moved, and by how much they turned.
void noteMovedPatches(BodySolution& solution, const SolutionHistory& history);

}  // namespace skincal
