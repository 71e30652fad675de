#include "core/estimation/sturdy_method.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/estimation/spot_settlement.h"
#include "core/estimation/stage_clock.h"
#include "core/geometry/statistics.h"

namespace skincal {
namespace {

/// Robust standard deviation per axis of the pixel residuals, in units of each detection's own sigma.
double pixelNoiseFactor(const AdjustmentInput& input, const BodyState& state, double floor_px) {
    std::vector<double> lengths;
    for (const PixelObservation& o : input.pixels) {
        if (const auto r = pixelResidual(input, state, o))
            lengths.push_back(r->norm() / std::max(o.sigma_px, floor_px));
    }
    // The median of a two-dimensional normal's length is 1.1774 sigma.
    return lengths.empty() ? 1.0 : median(std::move(lengths)) / 1.1774;
}

/// A relative change of the cost that is small against what is still to come: what follows moves the body farther than
/// the last iterations at one pixel scale would.
constexpr double kRoughly = 1e-5;

/// From a pixel scale at which the initial shapes are right to that of the detections.
tl::expected<int, CalibrationError> adjustGradually(BodySolution& solution, const SturdyMethodOptions& options,
                                                    const RunContext& context) {
    AdjustmentOptions& weights = solution.weights;
    if (solution.shapes.accelerometerSigma > 0)
        weights.accelerometerSigma = std::clamp(solution.shapes.accelerometerSigma, 1e-3, 2.0);
    const double floor_px = options.adjustment.pixelSigmaFloor_px;
    int iterations = 0;
    // Shapes that are guessed flat are off by many pixels, those from gravity by one or two.
    const auto& guessed = solution.shapes.assumedFlat;
    const bool mostlyGuessed =
        2 * std::count(guessed.begin(), guessed.end(), true) > static_cast<std::ptrdiff_t>(guessed.size());
    std::vector<double> scales_px{1.0, 0.25, floor_px};
    if (mostlyGuessed)
        scales_px.insert(scales_px.begin(), {30.0, 10.0, 3.0});
    else
        weights.tolerance = std::max(options.adjustment.tolerance, kRoughly);
    for (const double scale_px : scales_px) {
        context.report(Sentence::saying("adjusting the body"), std::max(0.0, 1 - scale_px));
        weights.pixelSigmaFloor_px = std::max(floor_px, scale_px);
        const auto took = adjustSolution(solution, solution.input, context);
        if (!took)
            return took;
        iterations += *took;
    }

    // Detections are rejected against the noise that they show themselves; what is left is solved once more.
    weights.pixelSigmaFactor = std::max(1.0, pixelNoiseFactor(solution.input, solution.solved, floor_px));
    rejectFarDetections(solution, options.rejectionSigmas);
    weights.tolerance = options.adjustment.tolerance;
    const auto took = adjustSolution(solution, usedMeasurements(solution), context);
    if (!took)
        return took;
    return iterations + *took;
}

std::vector<LinkKind> kindsOf(const SkinLayout& layout) {
    std::vector<LinkKind> kinds;
    for (const LinkVerdict& verdict : layout.verdicts)
        kinds.push_back(verdict.kind);
    return kinds;
}

/// One round with the links as they are judged now.
tl::expected<BodySolution, CalibrationError> solveRound(const Measurements& measurements, const GravityTable& gravity,
                                                        const SolutionHistory& history,
                                                        const SturdyMethodOptions& options, const RunContext& context) {
    StageClock clock("initial estimate");
    auto initial = estimateInitially(measurements, gravity, history, options.initial, context);
    if (!initial)
        return tl::unexpected(initial.error());
    BodySolution solution{std::move(*initial), {}, {}, options.adjustment, {}};
    BodyEstimate& estimate = solution.estimate;
    estimate.method = "sturdy";
    estimate.spots = std::exchange(solution.spotsByShape, {});
    estimate.rejected.assign(solution.input.pixels.size(), false);
    estimate.rejectedReason.resize(solution.input.pixels.size());
    estimate.setAside.resize(solution.input.pixels.size());
    estimate.moduleTrouble.resize(measurements.skin.modules.size());
    estimate.linkTrouble.resize(solution.layout.verdicts.size());
    estimate.patchStatus.resize(solution.layout.patches.size());
    estimate.viewStatus.resize(measurements.views.size());
    estimate.T_r_o.resize(solution.layout.patches.size());

    solution.solved = solution.state();
    if (!solution.alternatives.empty()) {
        auto settled =
            settleViews(solution.input, std::move(solution.solved), solution.alternatives, options.adjustment, context);
        if (!settled)
            return tl::unexpected(settled.error());
        solution.solved = std::move(settled->state);
        solution.alternatives = std::move(settled->alternatives);
        estimate.undecidedViews = std::move(settled->undecided);
    }
    estimate.stages.push_back(clock.stop());
    if (!solution.anyViewPlaced())
        return solution;
    anchorAtFirstView(solution);
    StageClock adjusting("coarse adjustment");
    const auto iterations = adjustGradually(solution, options, context);
    if (!iterations)
        return tl::unexpected(iterations.error());
    estimate.stages.push_back(adjusting.stop(*iterations));
    estimate.condition["pixel noise factor"] = solution.weights.pixelSigmaFactor;
    estimate.condition["accelerometer sigma"] = solution.weights.accelerometerSigma;
    estimate.condition["adjustment iterations"] = *iterations;
    return solution;
}

}  // namespace

bool SturdyMethodOptions::validate() const {
    return initial.validate() && adjustment.validate() && rejectionSigmas > 1 && maxRelinkings >= 0;
}

tl::expected<BodySolution, CalibrationError> solveSturdily(const Measurements& measurements,
                                                           const GravityTable& gravity, SolutionHistory& history,
                                                           const SturdyMethodOptions& options,
                                                           const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("SturdyMethodOptions out of range");
    auto solution = solveRound(measurements, gravity, history, options, context);
    // A solution tells better than any single measurement which links are cables; so long as it does, solve again.
    for (int more = 0; solution && more < options.maxRelinkings; ++more) {
        SolutionHistory after = history;
        after.gaps = linkGaps(*solution, history.gaps);
        if (kindsOf(layOutSkin(measurements, gravity, options.initial.layout, after)) == kindsOf(solution->layout))
            break;
        history = std::move(after);
        auto stages = std::move(solution->estimate.stages);
        solution = solveRound(measurements, gravity, history, options, context);
        if (solution)
            solution->estimate.stages.insert(solution->estimate.stages.begin(), stages.begin(), stages.end());
    }
    return solution;
}

tl::expected<BodyModel, CalibrationError> calibrateSturdy(const Measurements& measurements,
                                                          const SturdyMethodOptions& options,
                                                          const RunContext& context) {
    const GravityTable gravity(measurements.skin, measurements.gravity);
    SolutionHistory history;
    auto solution = solveSturdily(measurements, gravity, history, options, context);
    if (!solution)
        return tl::unexpected(solution.error());
    dropRejectedSpots(*solution);
    return describeSolution(std::move(*solution), options.initial.pose);
}

}  // namespace skincal
