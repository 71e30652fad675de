#include "core/estimation/joint_method.h"

#include <algorithm>
#include <stdexcept>

#include "core/estimation/alternatives.h"
#include "core/estimation/noise_findings.h"
#include "core/estimation/stage_clock.h"
#include "core/estimation/view_hypotheses.h"
#include "core/estimation/wrong_links.h"

namespace skincal {
namespace {

void noteWeights(BodySolution& solution) {
    auto& condition = solution.estimate.condition;
    condition["pixel noise factor"] = solution.weights.pixelSigmaFactor;
    condition["accelerometer sigma"] = solution.weights.accelerometerSigma;
    condition["link sigma"] = solution.weights.linkSigma;
    condition["bias sigma"] = solution.weights.biasSigma;
    condition["scale sigma"] = solution.weights.scaleSigma;
}

/// The factor takes the place of the floor: detections may be better than any floor.
void startWeights(BodySolution& solution, const JointMethodOptions& options) {
    constexpr double kFloor_px = 1e-3;
    AdjustmentOptions& weights = solution.weights;
    weights.pixelSigmaFactor *= std::max(1.0, weights.pixelSigmaFloor_px / 0.05);
    weights.pixelSigmaFloor_px = kFloor_px;
    weights.pixelLoss = 0;
    weights.misalignmentSigma = options.misalignmentSigma;
    weights.tolerance = options.start.adjustment.tolerance;
    weights.lossBegins = options.refinement.lossBegins;
}

/// The sturdy method as a start only.
SturdyMethodOptions startOptions(const JointMethodOptions& options) {
    constexpr double kRoughly = 1e-6;
    SturdyMethodOptions start = options.start;
    start.adjustment.tolerance = std::max(start.adjustment.tolerance, kRoughly);
    return start;
}

/// Refines, and takes out suspects until none is left.
tl::expected<void, CalibrationError> refineAndTakeOut(BodySolution& solution, SolutionHistory& history,
                                                      const JointMethodOptions& options, const RunContext& context) {
    for (int round = 0;; ++round) {
        auto review = refineJointly(solution, options.refinement, context);
        if (!review)
            return tl::unexpected(review.error());
        if (!*review)
            return {};
        solution.estimate.covariances = (*review)->covariances;
        // What was taken by the shape of a patch and does not stand is no evidence against anything.
        dropRejectedSpots(solution);
        if (round == options.maxTakeOuts)
            return {};
        if (!takeOutSuspects(solution, usedMeasurements(solution), **review, history, options.suspects))
            return {};
    }
}

/// What the sturdy method's weights said of views that could stand in two places, said again by the weights that the
/// residuals gave. @return whether a view stands elsewhere now.
tl::expected<bool, CalibrationError> settleViewsAgain(BodySolution& solution, const JointMethodOptions& options,
                                                      const RunContext& context) {
    if (solution.alternatives.empty())
        return false;
    StageClock clock("views that could stand elsewhere");
    auto moved = settleViewsByLikelihood(solution, options.refinement, context);
    if (moved)
        solution.estimate.stages.push_back(clock.stop());
    return moved;
}

/// One solution with the links as they are known, suspects taken out.
tl::expected<BodySolution, CalibrationError> solveOnce(const Measurements& measurements, const GravityTable& gravity,
                                                       SolutionHistory& history, const JointMethodOptions& options,
                                                       const RunContext& context) {
    auto solution = solveSturdily(measurements, gravity, history, startOptions(options), context);
    if (!solution)
        return solution;
    solution->estimate.method = "joint";
    if (!solution->anyViewPlaced())
        return solution;
    startWeights(*solution, options);
    dropWhatNothingHolds(*solution);
    if (const auto refined = refineAndTakeOut(*solution, history, options, context); !refined)
        return tl::unexpected(refined.error());
    const auto moved = settleViewsAgain(*solution, options, context);
    if (!moved)
        return tl::unexpected(moved.error());
    if (*moved) {
        anchorAtFirstView(*solution);
        if (const auto refined = refineAndTakeOut(*solution, history, options, context); !refined)
            return tl::unexpected(refined.error());
    }
    noteWeights(*solution);
    return solution;
}

/// What was computed before counts in the time that the result took.
void addStagesBefore(std::vector<StageReport> before, BodySolution& solution) {
    auto& stages = solution.estimate.stages;
    stages.insert(stages.begin(), std::make_move_iterator(before.begin()), std::make_move_iterator(before.end()));
}

/// Links that turn out to be cables: again without them, their patches fall apart.
tl::expected<BodySolution, CalibrationError> solveWithHistory(const Measurements& measurements,
                                                              const GravityTable& gravity, SolutionHistory& history,
                                                              const JointMethodOptions& options,
                                                              const RunContext& context) {
    std::vector<Sentence> known = history.refuted;
    auto solution = solveOnce(measurements, gravity, history, options, context);
    constexpr int kMostRounds = 3;
    for (int round = 0; solution && history.refuted != known && round < kMostRounds; ++round) {
        known = history.refuted;
        auto stages = std::move(solution->estimate.stages);
        solution = solveOnce(measurements, gravity, history, options, context);
        if (solution)
            addStagesBefore(std::move(stages), *solution);
    }
    return solution;
}

}  // namespace

bool JointMethodOptions::validate() const {
    return start.validate() && refinement.validate() && suspects.validate() && spots.validate() &&
           misalignmentSigma >= 0 && maxTakeOuts >= 0 && maxTrials >= 0;
}

tl::expected<BodySolution, CalibrationError> solveJointly(const Measurements& measurements, const GravityTable& gravity,
                                                          const JointMethodOptions& options,
                                                          const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("JointMethodOptions out of range");
    SolutionHistory history;
    auto best = solveWithHistory(measurements, gravity, history, options, context);
    if (!best)
        return best;
    for (int trials = 0; trials < options.maxTrials;) {
        const auto others = alternatives(*best, history, options.start.initial.layout, options.maxTrials - trials);
        bool better = false;
        for (const SolutionHistory& other : others) {
            ++trials;
            SolutionHistory own = other;
            auto next = solveWithHistory(measurements, gravity, own, options, context);
            if (!next && next.error().code == ErrorCode::Cancelled)
                return next;
            better = next && explainsMore(*next, *best);
            if (!better) {
                if (next)
                    addStagesBefore(std::move(next->estimate.stages), *best);
                continue;
            }
            addStagesBefore(std::move(best->estimate.stages), *next);
            best = std::move(next);
            history = std::move(own);
            break;
        }
        if (!better)
            break;
    }
    if (const auto chosen = chooseSpots(*best, options.refinement, options.spots, context); !chosen)
        return tl::unexpected(chosen.error());
    noteMovedPatches(*best, history);
    nameMisportedLinks(*best, options.suspects.portsMeet);
    noteNoiseFindings(*best);
    return best;
}

tl::expected<void, CalibrationError> chooseSpots(BodySolution& solution, const RefinementOptions& refinement,
                                                 const SpotOptions& options, const RunContext& context) {
    dropRejectedSpots(solution);
    // Without covariances nothing tells how well an LED's place is known.
    if (!solution.anyViewPlaced() || solution.estimate.covariances.empty())
        return {};
    bool isChanged = false;
    for (int round = 0; round < options.maxRounds; ++round) {
        StageClock clock("which of several spots");
        const auto taken = settleSpots(solution, options, context);
        if (!taken)
            return tl::unexpected(taken.error());
        if (*taken == 0)
            break;
        isChanged = true;
        // Against its own noise a spot may be far from where the body had a module that nothing else showed: the body
        // goes there before anything is judged.
        const auto took = adjustSolution(solution, usedMeasurements(solution), context);
        if (!took)
            return tl::unexpected(took.error());
        solution.estimate.stages.push_back(clock.stop(*took));
        const auto review = refineJointly(solution, refinement, context);
        if (!review)
            return tl::unexpected(review.error());
        if (*review)
            solution.estimate.covariances = (*review)->covariances;
        dropRejectedSpots(solution);
    }
    if (isChanged)
        noteWeights(solution);
    const auto& spots = solution.estimate.spots;
    const auto taken = std::count_if(spots.begin(), spots.end(), [](const SpotVerdict& v) { return v.pixel; });
    auto& condition = solution.estimate.condition;
    condition.erase("spots taken");
    condition.erase("spots open");
    if (!spots.empty()) {
        condition["spots taken"] = static_cast<double>(taken);
        condition["spots open"] = static_cast<double>(spots.size()) - static_cast<double>(taken);
    }
    return {};
}

tl::expected<BodyModel, CalibrationError> calibrateJoint(const Measurements& measurements,
                                                         const JointMethodOptions& options, const RunContext& context) {
    const GravityTable gravity(measurements.skin, measurements.gravity);
    auto solution = solveJointly(measurements, gravity, options, context);
    if (!solution)
        return tl::unexpected(solution.error());
    return describeSolution(std::move(*solution), options.start.initial.pose);
}

}  // namespace skincal
