#pragma once

#include <tl/expected.hpp>

#include "core/adjustment/solution_review.h"
#include "core/estimation/sturdy_method.h"

namespace skincal {

struct JointMethodOptions {
    SturdyMethodOptions start;
    ReviewOptions review;
    /// Detections farther from the result than this many of their estimated standard deviations are rejected: by chance
    /// it happens to one of 250,000.
    double rejectionSigmas = 5.0;
    int maxReweightings = 10;
    double weightTolerance = 0.01;  ///< relative change of the standard deviations at which they stand
    double losses = 6;              ///< where gravity and links stop to count in full, in standard deviations

    [[nodiscard]] bool validate() const;
};

/// The joint estimate: started by the sturdy method, then maximum a posteriori over module and view poses, gravity
/// directions, biases and scales at once, with the weight of each kind of measurement estimated from the residuals and
/// every detection judged anew by what it then deserves. Gives each module its covariance relative to the first placed
/// view, which is the body frame.
/// Fails with Cancelled or NotConverged. Where the data do not fix all unknowns the sturdy method's weights stand and
/// there are no covariances.
[[nodiscard]] tl::expected<BodyModel, CalibrationError> calibrateJoint(const Measurements& measurements,
                                                                       const JointMethodOptions& options = {},
                                                                       const RunContext& context = {});

}  // namespace skincal
