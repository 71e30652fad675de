#pragma once

#include <vector>

#include "core/estimation/body_solution.h"

namespace skincal {

/// What to try where a patch does not fit its pictures: its links that may be cables after all, the likeliest first,
/// each as `links` with that one refuted. A patch does not fit where a third of its detections is rejected. Only links
/// without which it falls apart are tried, for any other would show by the ports it leaves apart; those first whose
/// LEDs are the farthest apart in the pictures.
[[nodiscard]] std::vector<LinkHistory> cableTrials(const BodySolution& solution, const LinkHistory& links, int most);

/// Whether a solution of the same measurements is the likelier one: detections that are rejected cost what one at the
/// limit of rejection does, modules without a place cost all their detections, and a link that becomes a cable costs
/// what a chance fit would.
[[nodiscard]] bool explainsMore(const BodySolution& solution, const BodySolution& than);

}  // namespace skincal
