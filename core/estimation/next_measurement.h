#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "core/estimation/body_solution.h"
#include "core/estimation/view_candidates.h"
#include "core/estimation/view_forecast.h"
#include "core/geometry/run_context.h"

namespace skincal {

/// Standard deviations of module positions (BodyPrecision: in the body itself, wherever it stands) without and with a
/// measurement that was not made yet, m.
struct ForecastGain {
    double worstBefore = 0;  ///< of the module that is the worst
    double worstAfter = 0;   ///< of the one that is the worst then
    double rmsBefore = 0;    ///< over all placed modules
    double rmsAfter = 0;
    std::size_t modules = 0;  ///< placed modules that would be measured

    [[nodiscard]] double worstDrop() const { return worstBefore - worstAfter; }
    [[nodiscard]] double rmsDrop() const { return rmsBefore - rmsAfter; }
};

struct NextPose {
    Vector3d up_r = Vector3d::UnitZ();  ///< unit vector against gravity, body frame
    double nearest = 0;                 ///< rad, to the nearest pose there is; pi where there is none
    ForecastGain gain;
    Sentence words;  ///< how to hold the body (wordsForUp)
};

struct NextView {
    Isometry3d T_r_v = Isometry3d::Identity();
    std::vector<PatchId> patches;     ///< that it looks at
    std::vector<ModuleId> firstSeen;  ///< placed modules that no view looked at so far
    ForecastGain gain;
    Sentence words;  ///< where to put the camera, and which way that is from where it stood before
};

struct NextMeasurementOptions {
    std::size_t directions = 32;  ///< gravity poses tried, spread evenly over the sphere
    std::size_t maxViews = 40;    ///< views tried: those that see the most uncertain modules
    /// Candidates times placed modules evaluated at most, of poses and of views; never fewer than eight candidates.
    std::size_t maxWork = 2500;
    std::size_t minLeds = 6;  ///< views that would see fewer are not offered
    ViewCandidateOptions views;
    ViewLimits limits;

    [[nodiscard]] bool validate() const {
        return directions > 0 && maxViews > 0 && views.validate() && limits.validate() && minLeds >= 4;
    }
};

/// Gravity poses to add, the best first: those that bring the worst module's standard deviation down the most, among
/// equals the rms over all. Every candidate is evaluated exactly, to first order: a reading of each placed module that
/// has any, with the noise of its others, is added to the measurements, and all covariances are computed anew.
/// Where patches moved against each other between poses, the new one is as they lie at the scan.
/// Modules that are not placed take no part; where patches are missing, see findShortfalls first.
/// Fails with Cancelled (asked between candidates), NothingPlaced, TooFewPoses (no readings at all, so that nothing is
/// known of their noise) or DegeneratePoints (the data do not fix all unknowns).
/// Throws std::logic_error where options are out of range.
[[nodiscard]] tl::expected<std::vector<NextPose>, CalibrationError> rankNextPoses(
    const BodySolution& solution, const NextMeasurementOptions& options = {}, const RunContext& context = {});

/// Views to add, likewise: a detection of each placed module that forecastPixels sees, with the noise of the others;
/// not of hidden ones (UnseenModules), which earlier views looked at in vain. Empty where no candidate sees enough.
/// Fails as above, but for TooFewPoses.
[[nodiscard]] tl::expected<std::vector<NextView>, CalibrationError> rankNextViews(
    const BodySolution& solution, const NextMeasurementOptions& options = {}, const RunContext& context = {});

}  // namespace skincal
