#pragma once

#include <vector>

#include "core/estimation/advice_basis.h"
#include "core/estimation/observability.h"

namespace skincal {

/// What gravity does not tell, in the solution as a whole: at most one shortfall of either kind,
///   GravityMissing  modules with readings in fewer than two poses
///   PosesAlike      modules whose rotation gravityRotationCovariance gives no better than ShortfallOptions say; the
///                   figure is the median of the worst axis' standard deviation over them, and the direction the one of
///                   evenDirections that makes the determinants of their covariances the smallest
/// A patch of a single module is as well off without.
[[nodiscard]] std::vector<Shortfall> gravityShortfalls(const BodySolution& solution, const AdviceBasis& basis,
                                                       const ShortfallOptions& options);

}  // namespace skincal
