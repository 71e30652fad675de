#include "core/estimation/sturdy_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "core/estimation/body_assembly.h"
#include "core/estimation/missing_data.h"
#include "core/estimation/module_support.h"
#include "core/estimation/view_alternatives.h"
#include "core/geometry/statistics.h"

namespace skincal {
namespace {

/// Everything that is known between the steps of one round.
struct Run : InitialEstimate {
    const Measurements& measurements;
    const SturdyMethodOptions& options;
    const RunContext& context;
    const Refinement& refine;
    BodyEstimate estimate;
};

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

/// From a pixel scale at which the initial shapes are right to that of the detections.
tl::expected<BodyState, CalibrationError> adjustGradually(Run& run, BodyState state) {
    const auto root = std::find_if(state.T_r_v.begin(), state.T_r_v.end(), [](const auto& T) { return T.has_value(); });
    const auto fixedView = static_cast<std::size_t>(root - state.T_r_v.begin());
    AdjustmentOptions options = run.options.adjustment;
    if (run.shapes.accelerometerSigma > 0)
        options.accelerometerSigma = std::clamp(run.shapes.accelerometerSigma, 1e-3, 2.0);

    const double floor_px = run.options.adjustment.pixelSigmaFloor_px;
    int iterations = 0;
    for (const double scale_px : {1.0, 0.25, floor_px}) {
        run.context.report("adjusting the body", 1 - scale_px);
        options.pixelSigmaFloor_px = std::max(floor_px, scale_px);
        const auto result = adjustBody(run.input, state, Gauge{{fixedView}, {}}, options, run.context);
        if (!result)
            return tl::unexpected(result.error());
        state = result->state;
        iterations += result->summary.iterations;
    }

    // Detections are rejected against the noise that they show themselves; what is left is solved once more.
    const double factor = std::max(1.0, pixelNoiseFactor(run.input, state, floor_px));
    AdjustmentInput kept = run.input;
    kept.pixels.clear();
    for (std::size_t i = 0; i < run.input.pixels.size(); ++i) {
        const PixelObservation& o = run.input.pixels[i];
        const auto r = pixelResidual(run.input, state, o);
        if (!r)
            continue;
        const double sigma = factor * std::max(o.sigma_px, floor_px);
        if (r->norm() > run.options.rejectionSigmas * sigma) {
            run.estimate.rejected[i] = true;
            run.estimate.rejectedReason[i] =
                fmt::format("{:.1f} px from where the body has it, {:.0f} sigma", r->norm(), r->norm() / sigma);
        } else {
            kept.pixels.push_back(o);
            kept.pixels.back().sigma_px = sigma;
        }
    }
    const auto result = adjustBody(kept, state, Gauge{{fixedView}, {}}, options, run.context);
    if (!result)
        return tl::unexpected(result.error());
    run.estimate.condition["pixel noise factor"] = factor;
    run.estimate.condition["accelerometer sigma"] = options.accelerometerSigma;
    run.estimate.condition["adjustment iterations"] = iterations + result->summary.iterations;
    if (!run.refine)
        return result->state;
    options.pixelSigmaFactor = factor;
    return run.refine(run.input, result->state, Gauge{{fixedView}, {}}, options, run.estimate, run.context);
}

/// Modules that started flat for want of readings keep a pose only where the rest of the data came to hold it.
void dropWhatNothingHolds(Run& run, BodyState& state) {
    AdjustmentInput used = run.input;
    used.pixels.clear();
    for (std::size_t i = 0; i < run.input.pixels.size(); ++i) {
        if (!run.estimate.rejected[i])
            used.pixels.push_back(run.input.pixels[i]);
    }
    std::vector<bool> measured = run.shapes.assumedFlat;
    measured.flip();
    const std::vector<bool> held = heldModules(used, state, std::move(measured));
    std::vector<std::size_t> dropped;
    for (std::size_t u = 0; u < held.size(); ++u) {
        if (!held[u] && state.T_r_u[u]) {
            state.T_r_u[u].reset();
            dropped.push_back(u);
        }
    }
    for (std::size_t k = 0; k < run.layout.patches.size(); ++k) {
        for (std::size_t i = 0; i < run.layout.patches[k].modules.size(); ++i) {
            if (!held[run.layout.patches[k].modules[i]] && run.shapes.assumedFlat[run.layout.patches[k].modules[i]])
                run.shapes.shapes[k].T_o_u[i].reset();
        }
    }
    if (!dropped.empty())
        run.estimate.missing.push_back(whyNotHeld(run.measurements.skin, dropped));
}

void reportMissing(Run& run, const BodyState& state) {
    BodyEstimate& estimate = run.estimate;
    const Skin& skin = run.measurements.skin;
    const bool anyPlaced =
        std::any_of(state.T_r_u.begin(), state.T_r_u.end(), [](const auto& T) { return T.has_value(); });
    for (std::size_t k = 0; k < run.layout.patches.size(); ++k) {
        const Patch& patch = run.layout.patches[k];
        if (run.body.T_r_o[k]) {
            estimate.patchStatus[k] = "placed";
            continue;
        }
        estimate.patchStatus[k] = run.evidence[k].mostDetected > 0 && run.evidence[k].mostUsable == 0
                                      ? "gravity does not tell its shape"
                                      : "not seen with a placed patch";
        estimate.missing.push_back(
            whyNotPlaced(skin, patch, run.evidence[k], run.options.initial.pose.minInliers, anyPlaced));
    }
    for (std::size_t v = 0; v < run.body.T_r_v.size(); ++v) {
        estimate.viewStatus[v] =
            run.body.T_r_v[v] ? "placed" : "shows no placed patch well enough, or could be in two places";
        if (!run.body.T_r_v[v] && anyPlaced)
            estimate.warnings.push_back(
                fmt::format("view {} is not used: it {}", run.measurements.views[v].name, estimate.viewStatus[v]));
    }
    const bool anyGravity = run.input.gravity->poseCount() > 0;
    for (std::size_t k = 0; anyGravity && k < run.layout.patches.size(); ++k) {
        if (!run.gravityFrame.R_g_o[k] && run.body.T_r_o[k] && run.layout.patches[k].modules.size() > 1) {
            estimate.trustAtMost = Trust::Usable;
            estimate.warnings.push_back(
                fmt::format("patch {}: gravity disagrees with the other patches or is too alike in all poses; its "
                            "rotation rests on the camera alone",
                            run.layout.patches[k].id.value));
        }
    }
    for (const NoisyAccelerometer& noisy : run.shapes.noisy)
        estimate.warnings.push_back(
            fmt::format("module {}: its accelerometer is off by {:.2f} m/s² rms, the others by {:.2f}",
                        skin.modules[noisy.module].id.value, noisy.sigma, run.shapes.accelerometerSigma));
}

/// The views whose pictures have a say in where each patch lies.
void listPatchViews(Run& run, const BodyState& state) {
    std::vector<std::set<std::size_t>> views(run.layout.patches.size());
    for (std::size_t i = 0; i < run.input.pixels.size(); ++i) {
        const PixelObservation& o = run.input.pixels[i];
        if (!run.estimate.rejected[i] && state.T_r_v[o.view] && state.T_r_u[o.module])
            views[run.layout.patchOf[o.module]].insert(o.view);
    }
    for (const auto& of : views)
        run.estimate.patchViews.emplace_back(of.begin(), of.end());
}

/// A patch's frame is its origin's: it has none where nothing holds the origin.
void placePatchFrames(Run& run, const BodyState& state) {
    for (std::size_t k = 0; k < run.layout.patches.size(); ++k) {
        const Patch& patch = run.layout.patches[k];
        run.estimate.T_r_o[k] = state.T_r_u[patch.origin];
        if (!run.estimate.T_r_o[k])
            continue;
        for (std::size_t i = 0; i < patch.modules.size(); ++i) {
            if (state.T_r_u[patch.modules[i]])
                run.shapes.shapes[k].T_o_u[i] = run.estimate.T_r_o[k]->inverse() * *state.T_r_u[patch.modules[i]];
        }
    }
}

/// Places the body frame where the first placed view stands.
void useFirstViewAsFrame(BodyState& state) {
    const auto root = std::find_if(state.T_r_v.begin(), state.T_r_v.end(), [](const auto& T) { return T.has_value(); });
    if (root == state.T_r_v.end())
        return;
    const Isometry3d T_v_r = (*root)->inverse();
    for (auto* poses : {&state.T_r_v, &state.T_r_u}) {
        for (auto& T : *poses) {
            if (T)
                T = T_v_r * *T;
        }
    }
    state.up_r.clear();
}

using LinkGaps = std::vector<std::optional<double>>;

struct Round {
    BodyModel body;
    LinkGaps gaps;
};

/// How far apart the ports of each link came out; what an earlier round knew where this one does not.
LinkGaps gapsOf(const Run& run, const BodyState& state, const LinkGaps& before) {
    const auto& links = run.layout.graph.links();
    LinkGaps gaps = before;
    gaps.resize(links.size());
    for (std::size_t l = 0; l < links.size(); ++l) {
        const GraphLink& link = links[l];
        const auto& T_r_a = state.T_r_u[link.a];
        const auto& T_r_b = state.T_r_u[link.b];
        if (T_r_a && T_r_b)
            gaps[l] = (*T_r_a * run.measurements.skin.port(link.a, link.a_port) -
                       *T_r_b * run.measurements.skin.port(link.b, link.b_port))
                          .norm();
    }
    return gaps;
}

std::vector<LinkKind> kindsOf(const SkinLayout& layout) {
    std::vector<LinkKind> kinds;
    for (const LinkVerdict& verdict : layout.verdicts)
        kinds.push_back(verdict.kind);
    return kinds;
}

/// One round with the links as they are judged now.
tl::expected<Round, CalibrationError> solveRound(const Measurements& measurements, const GravityTable& gravity,
                                                 const LinkGaps& gaps, const SturdyMethodOptions& options,
                                                 const RunContext& context, const Refinement& refine) {
    auto initial = estimateInitially(measurements, gravity, gaps, options.initial, context);
    if (!initial)
        return tl::unexpected(initial.error());
    Run run{std::move(*initial), measurements, options, context, refine, {}};

    BodyEstimate& estimate = run.estimate;
    estimate.method = "sturdy";
    estimate.rejected.assign(run.input.pixels.size(), false);
    estimate.rejectedReason.resize(run.input.pixels.size());
    estimate.patchStatus.resize(run.layout.patches.size());
    estimate.viewStatus.resize(measurements.views.size());
    estimate.T_r_o.resize(run.layout.patches.size());

    BodyState state = run.state();
    if (!run.alternatives.empty()) {
        auto settled = settleViews(run.input, std::move(state), run.alternatives, options.adjustment, context);
        if (!settled)
            return tl::unexpected(settled.error());
        state = std::move(settled->state);
        if (settled->undecided > 0) {
            estimate.trustAtMost = Trust::Usable;
            estimate.warnings.push_back(
                fmt::format("{} views show a flat patch alone and could be in two places: the likelier was taken",
                            settled->undecided));
        }
    }
    useFirstViewAsFrame(state);
    if (std::any_of(state.T_r_v.begin(), state.T_r_v.end(), [](const auto& T) { return T.has_value(); })) {
        auto adjusted = adjustGradually(run, std::move(state));
        if (!adjusted)
            return tl::unexpected(adjusted.error());
        state = std::move(*adjusted);
    }
    dropWhatNothingHolds(run, state);
    reportMissing(run, state);
    listPatchViews(run, state);
    placePatchFrames(run, state);
    estimate.shapes = run.shapes.shapes;
    estimate.T_r_u = state.T_r_u;
    estimate.T_r_v = state.T_r_v;
    estimate.accelerometers = state.accelerometers;
    return Round{assembleBody(measurements, gravity, run.layout, run.input, estimate), gapsOf(run, state, gaps)};
}

}  // namespace

bool SturdyMethodOptions::validate() const {
    return initial.validate() && adjustment.validate() && rejectionSigmas > 1 && maxRelinkings >= 0;
}

tl::expected<BodyModel, CalibrationError> calibrateSturdy(const Measurements& measurements,
                                                          const SturdyMethodOptions& options, const RunContext& context,
                                                          const Refinement& refine) {
    if (!options.validate())
        throw std::logic_error("SturdyMethodOptions out of range");
    const GravityTable gravity(measurements.skin, measurements.gravity);
    LinkGaps gaps;
    auto round = solveRound(measurements, gravity, gaps, options, context, refine);
    // A solution tells better than any single measurement which links are cables; so long as it does, solve again.
    for (int more = 0; round && more < options.maxRelinkings; ++more) {
        const auto before = kindsOf(layOutSkin(measurements, gravity, options.initial.layout, gaps));
        if (kindsOf(layOutSkin(measurements, gravity, options.initial.layout, round->gaps)) == before)
            break;
        gaps = round->gaps;
        round = solveRound(measurements, gravity, gaps, options, context, refine);
    }
    if (!round)
        return tl::unexpected(round.error());
    return std::move(round->body);
}

}  // namespace skincal
