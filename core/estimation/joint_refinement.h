#pragma once

#include <tl/expected.hpp>

#include "core/adjustment/solution_review.h"
#include "core/estimation/body_solution.h"

namespace skincal {

struct RefinementOptions {
    /// What is known of skins, webcams and accelerometers in general counts as so many measurements of each kind (the
    /// defaults of AdjustmentOptions): where few are redundant, it steadies the weights.
    double priorMeasurements = 4;
    /// Detections farther from the result than this many of their estimated standard deviations are rejected: by chance
    /// it happens to one of 250,000.
    double rejectionSigmas = 5.0;
    int maxReweightings = 12;
    /// Relative change of the standard deviations at which they stand. What a factor of 1.02 costs in accuracy is a
    /// matter of 1e-4.
    double weightTolerance = 0.02;
    double lossBegins = 5;   ///< where gravity and links stop to count in full, in standard deviations
    double noisyPose = 1.6;  ///< poses noisier than the others by this count as much less as they are
    double noisyAccelerometer = 2.5;
    double noisyView = 2.0;

    [[nodiscard]] bool validate() const;
};

/// From a solution that is near to the most probable one: all unknowns at once, the weight of each kind of measurement
/// from the residuals (variance components), every detection judged anew by what it then deserves. Poses in which the
/// body shook, broken accelerometers and views that disagree with themselves are weighed for themselves; detections
/// that fit another place of their camera are set aside.
/// @return the review of the solution; nothing where the data do not fix all unknowns: then the weights that it came
/// with stand. Fails with Cancelled or NotConverged.
[[nodiscard]] tl::expected<std::optional<SolutionReview>, CalibrationError> refineJointly(
    BodySolution& solution, const RefinementOptions& options = {}, const RunContext& context = {});

}  // namespace skincal
