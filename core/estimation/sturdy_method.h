#pragma once

#include <tl/expected.hpp>

#include "core/estimation/body_solution.h"

namespace skincal {

struct SturdyMethodOptions {
    InitialEstimateOptions initial;
    AdjustmentOptions adjustment;
    /// Detections farther from the result than this many sigmas are rejected.
    double rejectionSigmas = 5.0;
    int maxRelinkings = 2;  ///< rounds after the first, for links that the solution shows to be misjudged

    [[nodiscard]] bool validate() const;
};

/// The initial estimate, then a robust adjustment of modules and views over pixels, gravity and links, from a coarse
/// pixel scale to a fine one. Detections that disagree are rejected and named. Links whose ports came out far apart are
/// cables after all, those that met are neighbours: solved again with them.
/// @param history  what earlier solutions taught, and afterwards this one, too.
/// Fails with Cancelled or NotConverged. Where nothing can be placed the solution has no placed view.
[[nodiscard]] tl::expected<BodySolution, CalibrationError> solveSturdily(const Measurements& measurements,
                                                                         const GravityTable& gravity,
                                                                         SolutionHistory& history,
                                                                         const SturdyMethodOptions& options = {},
                                                                         const RunContext& context = {});

/// The paper's pipeline without its weaknesses: solveSturdily as a body model. Fails as it does; where nothing can be
/// placed the body says so, with what is missing.
[[nodiscard]] tl::expected<BodyModel, CalibrationError> calibrateSturdy(const Measurements& measurements,
                                                                        const SturdyMethodOptions& options = {},
                                                                        const RunContext& context = {});

}  // namespace skincal
