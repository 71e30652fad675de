#pragma once

#include <tl/expected.hpp>

#include "core/estimation/body_solution.h"
#include "core/estimation/joint_refinement.h"

namespace skincal {

/// Settles which of two places a view has where a flat patch alone is in its picture, for a solution whose weights are
/// known from its residuals. Each hypothesis is solved with weights of its own, for a wrong one finds the noise larger
/// and would excuse itself by it; they are compared by
///   -log L = 1/2 sum r^T r / sigma^2 + sum n log sigma
/// where detections that are rejected cost what one at the limit of rejection does. Views of one patch are also tried
/// elsewhere all together and with its shape reversed: one alone would contradict the shape that the others, wrong
/// alike, have bent.
/// Looks at the views and patches of `solution.alternatives`; `estimate.undecidedViews` are then those whose other
/// place is nearly as likely.
/// @return whether a view stands elsewhere now: the body frame is no longer that of the first view. Fails with
/// Cancelled.
[[nodiscard]] tl::expected<bool, CalibrationError> settleViewsByLikelihood(BodySolution& solution,
                                                                           const RefinementOptions& options = {},
                                                                           const RunContext& context = {});

}  // namespace skincal
