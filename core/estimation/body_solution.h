#pragma once

#include "core/estimation/body_assembly.h"
#include "core/estimation/initial_estimate.h"

namespace skincal {

/// A body that has been solved, with all that the next solution can start from. It refers to the measurements and to
/// the gravity table that it was made of; both must outlive it.
struct BodySolution : InitialEstimate {
    /// Modules, views, accelerometers and gravity; the frame is the first placed view's, or what `estimate.bodyFrame`
    /// says. Replaces where the initial estimate had them.
    BodyState solved;
    Gauge gauge;
    AdjustmentOptions weights;
    BodyEstimate estimate;  ///< verdicts so far; poses are filled in by describeSolution
    /// Other solutions that are nearly as likely, each in a frame of its own (see settleViewsByLikelihood).
    std::vector<BodyState> rivals{};

    [[nodiscard]] bool anyViewPlaced() const;
};

/// Moves the body frame to where the first placed view stands, which is held from here on.
void anchorAtFirstView(BodySolution& solution);

/// Judges every detection by the solution's weights: those farther than so many standard deviations from where the body
/// has them are rejected, the others count (again). Those that were set aside do only where they fit after all.
void rejectFarDetections(BodySolution& solution, double sigmas);

/// The detections that count, in the form that the adjustment takes.
[[nodiscard]] AdjustmentInput usedMeasurements(const BodySolution& solution);

/// How far apart the ports of each link came out (m); `before` where an end has no pose.
[[nodiscard]] std::vector<std::optional<double>> linkGaps(const BodySolution& solution,
                                                          std::vector<std::optional<double>> before);

/// Takes the poses away from modules that started flat for want of readings and that the rest of the data did not come
/// to hold (see heldModules): nothing is made up.
void dropWhatNothingHolds(BodySolution& solution);

/// One adjustment, and its result in the solution. @return how many iterations it took.
/// Fails with Cancelled or NotConverged.
[[nodiscard]] tl::expected<int, CalibrationError> adjustSolution(BodySolution& solution, const AdjustmentInput& input,
                                                                 const RunContext& context);

/// The solution as a body model: takes out what nothing holds, says what is missing and why, and whether to trust it.
[[nodiscard]] BodyModel describeSolution(BodySolution solution, const PatchPoseOptions& pose);

}  // namespace skincal
