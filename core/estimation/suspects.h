#pragma once

#include "core/adjustment/solution_review.h"
#include "core/estimation/body_solution.h"

namespace skincal {

struct SuspectOptions {
    /// Squared distance, in standard deviations, of a link from what everything else forecasts, at which it is not
    /// believed. Chi-squared with 3 degrees of freedom: by chance once in ten million.
    double linkDisagreement = 36;
    /// The same for links of one module that disagree together: by chance one link in a thousand is this far off.
    double doubtfulLink = 16;
    double portsMeet = 2.5e-3;  ///< m: other ports that come out this near are those that are really joined
    double farApart = 8e-3;     ///< m: no ports of neighbours that are this far apart
    double fits = 1.5e-3;       ///< m, rms: a rigid module explains where its neighbours and its LED have it

    [[nodiscard]] bool validate() const {
        return linkDisagreement > 0 && doubtfulLink > 0 && portsMeet > 0 && farApart > portsMeet && fits > 0;
    }
};

/// Modules and links that everything else contradicts are taken out of the solution, the worst first, and named for
/// what they probably are:
///   - a link alone: reported between ports that do not meet (others of the same modules do), or a cable
///   - a module whose links disagree together or are all taken for cables because of how it is turned, or whose LED all
///     views see at one place, but another than its own: it is of another type than the skin says, where one of the
///     skin's templates fits, or else has moved since gravity was read
/// Links that must be cables are noted in `history` for the next round: without them patches fall
/// apart.
/// @return true where something was taken out: solve again.
bool takeOutSuspects(BodySolution& solution, const AdjustmentInput& used, const SolutionReview& review,
                     SolutionHistory& history, const SuspectOptions& options = {});

}  // namespace skincal
