#pragma once

#include <string>
#include <vector>

#include "core/estimation/advice_basis.h"
#include "core/estimation/observability.h"

namespace skincal {

/// What findShortfalls looks at, and what it found so far.
struct ShortfallSearch {
    const BodySolution& solution;
    const ShortfallOptions& options;
    AdviceBasis basis;
    std::vector<Shortfall> found{};

    [[nodiscard]] const Skin& skin() const { return solution.measurements->skin; }
    [[nodiscard]] const Patch& patch(std::size_t k) const { return solution.layout.patches[k]; }
    [[nodiscard]] ModuleId id(std::size_t u) const { return skin().modules[u].id; }
    [[nodiscard]] const std::string& viewName(std::size_t v) const { return solution.measurements->views[v].name; }
};

/// One shortfall per patch that has no place, with why: unseen, seen too little, never with a placed one (and which
/// placed patches it is wired to, near which it is likely to be), contradicted or in two places. What gravity lacks for
/// its shape is gravityShortfalls' to tell.
void findUnplacedPatches(ShortfallSearch& search);

/// Views that could be in two places: those of which the likelier was taken, and those that show enough of placed
/// patches and have no place.
void findUndecidedViews(ShortfallSearch& search);

}  // namespace skincal
