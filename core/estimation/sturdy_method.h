#pragma once

#include <functional>
#include <tl/expected.hpp>

#include "core/adjustment/body_adjustment.h"
#include "core/adjustment/measurements.h"
#include "core/estimation/body_model.h"
#include "core/estimation/initial_estimate.h"
#include "core/geometry/run_context.h"

namespace skincal {

struct BodyEstimate;

/// A last step in place of none: a better state from one that is already near, with what is said about it.
/// @param input     all detections, the rejected among them
/// @param options   with the weights that the state was found with
/// @param estimate  rejections and covariances may be changed, condition and warnings added
using Refinement = std::function<tl::expected<BodyState, CalibrationError>(
    const AdjustmentInput& input, BodyState state, const Gauge& gauge, const AdjustmentOptions& options,
    BodyEstimate& estimate, const RunContext& context)>;

struct SturdyMethodOptions {
    InitialEstimateOptions initial;
    AdjustmentOptions adjustment;
    /// Detections farther from the result than this many sigmas are rejected.
    double rejectionSigmas = 5.0;
    int maxRelinkings = 2;  ///< rounds after the first, for links that the solution shows to be misjudged

    [[nodiscard]] bool validate() const;
};

/// The paper's pipeline without its weaknesses: the initial estimate, then a robust
/// adjustment of modules and views over pixels, gravity and links, from a coarse pixel scale to a fine one. Detections
/// that disagree are rejected and named. Links whose ports came out far apart are cables after all, those that met are
/// neighbours: solved again with them.
/// Fails with Cancelled or NotConverged. Where nothing can be placed the body says so, with what is missing.
[[nodiscard]] tl::expected<BodyModel, CalibrationError> calibrateSturdy(const Measurements& measurements,
                                                                        const SturdyMethodOptions& options = {},
                                                                        const RunContext& context = {},
                                                                        const Refinement& refine = {});

}  // namespace skincal
