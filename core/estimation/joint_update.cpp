#include <algorithm>
#include <map>

#include "core/estimation/joint_method.h"
#include "core/estimation/noise_findings.h"
#include "core/estimation/shape_spots.h"
#include "core/estimation/stage_clock.h"

namespace skincal {
namespace {

bool sameSkin(const Skin& a, const Skin& b) {
    const auto sameModule = [](const SkinModule& x, const SkinModule& y) { return x.id == y.id && x.type == y.type; };
    const auto sameLink = [](const Link& x, const Link& y) {
        return x.a == y.a && x.a_port == y.a_port && x.b == y.b && x.b_port == y.b_port && x.decided == y.decided;
    };
    return a.templates.size() == b.templates.size() &&
           std::equal(a.modules.begin(), a.modules.end(), b.modules.begin(), b.modules.end(), sameModule) &&
           std::equal(a.links.begin(), a.links.end(), b.links.begin(), b.links.end(), sameLink);
}

/// Views that both have come first, and in the same order.
bool sameViews(const Measurements& a, const Measurements& b) {
    const std::size_t common = std::min(a.views.size(), b.views.size());
    for (std::size_t v = 0; v < common; ++v) {
        if (a.views[v].name != b.views[v].name)
            return false;
    }
    return true;
}

/// What belongs to poses goes where they are now: numbers may have come in between.
void movePoses(BodySolution& next, const GravityTable& before, const GravityTable& now) {
    std::map<int, std::size_t> index;
    for (std::size_t p = 0; p < now.poseCount(); ++p)
        index[now.poseNumber(p)] = p;
    std::vector<double> noise(now.poseCount(), 1);
    std::vector<std::vector<std::optional<Vector3d>>> up_r(next.solved.up_r.size());
    for (auto& ofGroup : up_r)
        ofGroup.resize(now.poseCount());
    for (std::size_t p = 0; p < before.poseCount(); ++p) {
        const auto found = index.find(before.poseNumber(p));
        if (found == index.end())
            continue;
        if (!next.input.poseNoise.empty())
            noise[found->second] = next.input.poseNoise[p];
        for (std::size_t g = 0; g < up_r.size(); ++g)
            up_r[g][found->second] = next.solved.up_r[g][p];
    }
    next.input.poseNoise = std::move(noise);
    next.solved.up_r = std::move(up_r);
}

/// Detections as they are now; those that were part of a finding stay set aside.
void replaceDetections(BodySolution& next, const Measurements& measurements) {
    std::map<std::pair<std::size_t, std::size_t>, Sentence> setAside;
    for (std::size_t i = 0; i < next.input.pixels.size(); ++i) {
        if (!next.estimate.setAside[i].empty())
            setAside[{next.input.pixels[i].view, next.input.pixels[i].module}] = next.estimate.setAside[i];
    }
    next.input.pixels = flattenDetections(measurements);
    restoreSpots(next);
    next.estimate.setAside.assign(next.input.pixels.size(), {});
    next.estimate.rejected.assign(next.input.pixels.size(), false);
    next.estimate.rejectedReason.assign(next.input.pixels.size(), {});
    for (std::size_t i = 0; i < next.input.pixels.size(); ++i) {
        const auto found = setAside.find({next.input.pixels[i].view, next.input.pixels[i].module});
        if (found != setAside.end())
            next.estimate.setAside[i] = found->second;
    }
}

/// Of views with hardly a sure LED.
void takeSpotsByShape(BodySolution& next, const PatchPoseOptions& options, const RunContext& context) {
    std::vector<PixelObservation> sure;
    for (std::size_t i = 0; i < next.input.pixels.size(); ++i) {
        if (next.estimate.setAside[i].empty())
            sure.push_back(next.input.pixels[i]);
    }
    for (const ChosenSpot& one :
         chooseSpotsByShape(*next.measurements, next.layout, next.shapes.shapes, sure, options, context))
        takeSpot(next, {one.view, one.module}, one.spot, one.reason);
}

/// Views and patches that the new pictures bring within reach.
/// @return true where a patch is new: it lies where gravity and a few rays have it.
bool attachWhatIsNew(BodySolution& next, const InitialEstimateOptions& options, const RunContext& context) {
    next.body.T_r_v = next.solved.T_r_v;
    for (std::size_t k = 0; k < next.layout.patches.size(); ++k) {
        const Patch& patch = next.layout.patches[k];
        next.body.T_r_o[k] = next.solved.T_r_u[patch.origin];
        for (std::size_t i = 0; next.body.T_r_o[k] && i < patch.modules.size(); ++i) {
            const auto& T_r_u = next.solved.T_r_u[patch.modules[i]];
            if (T_r_u)
                next.shapes.shapes[k].T_o_u[i] = next.body.T_r_o[k]->inverse() * *T_r_u;
        }
    }
    std::vector<bool> before(next.body.T_r_o.size());
    for (std::size_t k = 0; k < before.size(); ++k)
        before[k] = next.body.T_r_o[k].has_value();
    takeSpotsByShape(next, options.pose, context);
    const auto sightings = collectSightings(*next.input.skin, next.layout, next.shapes.shapes, next.input.pixels);
    attachRest(next, sightings, options);
    next.solved.T_r_v = next.body.T_r_v;
    bool newPatch = false;
    for (std::size_t k = 0; k < before.size(); ++k) {
        const Patch& patch = next.layout.patches[k];
        newPatch = newPatch || (!before[k] && next.body.T_r_o[k]);
        for (std::size_t i = 0; !before[k] && next.body.T_r_o[k] && i < patch.modules.size(); ++i) {
            if (next.shapes.shapes[k].T_o_u[i])
                next.solved.T_r_u[patch.modules[i]] = *next.body.T_r_o[k] * *next.shapes.shapes[k].T_o_u[i];
        }
    }
    return newPatch;
}

/// From pixels off to the weights that the solution has.
tl::expected<int, CalibrationError> adjustCoarsely(BodySolution& next, const AdjustmentOptions& coarse,
                                                   const RunContext& context) {
    const AdjustmentOptions fine = next.weights;
    next.weights.pixelLoss = coarse.pixelLoss;
    next.weights.lossBegins = 0;
    int iterations = 0;
    for (const double scale_px : {1.0, 0.25, 0.0}) {
        next.weights.pixelSigmaFloor_px = std::max(scale_px, fine.pixelSigmaFloor_px);
        const auto took = adjustSolution(next, usedMeasurements(next), context);
        if (!took)
            return took;
        iterations += *took;
    }
    next.weights = fine;
    return iterations;
}

}  // namespace

tl::expected<BodySolution, CalibrationError> updateJointly(const BodySolution& last, const Measurements& measurements,
                                                           const GravityTable& gravity,
                                                           const JointMethodOptions& options,
                                                           const RunContext& context) {
    const bool gaugeStands = !last.gauge.views.empty() && last.gauge.views.front() < measurements.views.size();
    if (!last.anyViewPlaced() || !gaugeStands || !sameSkin(*last.input.skin, measurements.skin) ||
        !sameViews(*last.measurements, measurements))
        return solveJointly(measurements, gravity, options, context);
    StageClock clock("attaching what is new");
    BodySolution next = last;
    next.measurements = &measurements;
    next.input.skin = &measurements.skin;
    next.input.camera = &measurements.camera;
    next.input.gravity = &gravity;
    next.estimate.stages.clear();
    next.estimate.viewStatus.resize(measurements.views.size());
    next.solved.T_r_v.resize(measurements.views.size());
    if (!next.input.viewNoise.empty())
        next.input.viewNoise.resize(measurements.views.size(), 1);
    movePoses(next, *last.input.gravity, gravity);
    replaceDetections(next, measurements);
    RefinementOptions once = options.refinement;
    once.maxReweightings = 1;
    int iterations = 0;
    if (attachWhatIsNew(next, options.start.initial, context)) {
        const auto took = adjustCoarsely(next, options.start.adjustment, context);
        if (!took)
            return tl::unexpected(took.error());
        iterations = *took;
        once.maxReweightings = 3;
    }
    next.evidence = patchEvidence(next.layout, next.shapes.shapes, next.input.pixels);
    next.estimate.stages.push_back(clock.stop(iterations));
    const auto review = refineJointly(next, once, context);
    if (!review)
        return tl::unexpected(review.error());
    if (*review)
        next.estimate.covariances = (*review)->covariances;
    if (const auto chosen = chooseSpots(next, once, options.spots, context); !chosen)
        return tl::unexpected(chosen.error());
    noteNoiseFindings(next);
    return next;
}

}  // namespace skincal
