#include "core/estimation/sturdy_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "core/estimation/body_assembly.h"
#include "core/estimation/body_attachment.h"
#include "core/estimation/missing_data.h"
#include "core/estimation/module_support.h"
#include "core/estimation/patch_sightings.h"
#include "core/estimation/view_alternatives.h"
#include "core/geometry/statistics.h"

namespace skincal {
namespace {

/// Everything that is known between the steps of one run.
struct Run {
    const Measurements& measurements;
    const SturdyMethodOptions& options;
    const RunContext& context;
    GravityTable gravity;
    SkinLayout layout;
    AdjustmentInput input;
    PatchShapesResult shapes;
    std::vector<PatchSighting> sightings;
    std::vector<SightingCandidates> candidates;
    std::vector<PatchEvidence> evidence;
    GravityFrame gravityFrame;
    GrowingBody body;
    BodyEstimate estimate;
};

void findCandidates(Run& run) {
    for (std::size_t s = 0; s < run.sightings.size(); ++s) {
        const PatchSighting& sighting = run.sightings[s];
        run.context.report("patch poses", static_cast<double>(s) / static_cast<double>(run.sightings.size()));
        if (run.context.isCancelled())
            return;
        SightingCandidates candidates{sighting.view, sighting.patch, {}};
        auto poses = estimatePatchPoses(sighting.leds, run.measurements.camera, run.options.pose);
        if (poses)
            candidates.poses = std::move(*poses);
        else if (poses.error().code != ErrorCode::TooFewPoints)
            ++run.evidence[sighting.patch].poseFailures[poses.error().code];
        run.candidates.push_back(std::move(candidates));
    }
}

/// Nodes of the pose graph: views first, then patches, then the frame that gravity gives.
std::vector<PoseEdge> sightingEdges(const Run& run, const std::vector<Selection>& selections) {
    const std::size_t views = run.measurements.views.size();
    std::vector<PoseEdge> edges;
    for (std::size_t s = 0; s < run.candidates.size(); ++s) {
        if (!selections[s].candidate || selections[s].undecided)
            continue;
        const PatchPose& pose = run.candidates[s].poses[*selections[s].candidate];
        // The covariance turns about the camera; an edge's translation is the patch's own.
        Eigen::Matrix<double, 3, 6> J;
        J.leftCols<3>() = -skew(pose.T_v_o.translation());
        J.rightCols<3>() = Matrix3d::Identity();
        const Matrix3d covT = J * pose.covariance * J.transpose();
        PoseEdge edge;
        edge.from = run.candidates[s].view;
        edge.to = views + run.candidates[s].patch;
        edge.T_from_to = pose.T_v_o;
        edge.sigmaRotation = std::sqrt(std::max(1e-12, pose.covariance.topLeftCorner<3, 3>().trace() / 3));
        edge.sigmaTranslation = std::sqrt(std::max(1e-14, covT.trace() / 3));
        edges.push_back(edge);
    }
    return edges;
}

/// The connected part that holds the most modules, by its nodes; empty where no patch has a pose.
std::vector<bool> largestPart(const Run& run, const std::vector<PoseEdge>& edges) {
    const std::size_t views = run.measurements.views.size();
    const std::size_t nodes = views + run.layout.patches.size();
    const auto part = connectedParts(nodes, edges);
    std::vector<std::size_t> modules(nodes, 0);
    for (std::size_t k = 0; k < run.layout.patches.size(); ++k)
        modules[part[views + k]] += run.layout.patches[k].modules.size();
    std::optional<std::size_t> best;
    for (const PoseEdge& edge : edges) {
        if (!best || modules[part[edge.from]] > modules[*best])
            best = part[edge.from];
    }
    std::vector<bool> inside(nodes, false);
    for (std::size_t n = 0; n < nodes; ++n)
        inside[n] = best && part[n] == *best;
    return inside;
}

void placeByGraph(Run& run, const std::vector<Selection>& selections) {
    const std::size_t views = run.measurements.views.size();
    const std::size_t patches = run.layout.patches.size();
    auto edges = sightingEdges(run, selections);
    const auto inside = largestPart(run, edges);
    const auto first = std::find(inside.begin(), inside.begin() + static_cast<std::ptrdiff_t>(views), true);
    run.body.T_r_v.assign(views, std::nullopt);
    run.body.T_r_o.assign(patches, std::nullopt);
    if (first == inside.begin() + static_cast<std::ptrdiff_t>(views))
        return;
    const auto root = static_cast<std::size_t>(first - inside.begin());
    auto poses = spanningTreePoses(views + patches, edges, root);

    // Gravity takes part in the averaging as one more node that all patches are tied to by rotation alone.
    const std::size_t gravityNode = views + patches;
    poses.emplace_back();
    for (std::size_t k = 0; k < patches; ++k) {
        const auto& R_g_o = run.gravityFrame.R_g_o[k];
        if (!R_g_o || !poses[views + k])
            continue;
        if (!poses[gravityNode])
            poses[gravityNode] = makeIsometry(poses[views + k]->linear() * R_g_o->transpose(), Vector3d::Zero());
        constexpr double kNoTranslation = 1e3;  // m
        edges.push_back({gravityNode, views + k, makeIsometry(*R_g_o, Vector3d::Zero()),
                         run.options.gravityRotationSigma, kNoTranslation});
    }
    poses = averagePoses(edges, std::move(poses), root, run.options.averaging);
    for (std::size_t v = 0; v < views; ++v)
        run.body.T_r_v[v] = poses[v];
    for (std::size_t k = 0; k < patches; ++k)
        run.body.T_r_o[k] = poses[views + k];
}

std::optional<Matrix3d> gravityInBody(const Run& run) {
    Matrix3d sum = Matrix3d::Zero();
    for (std::size_t k = 0; k < run.body.T_r_o.size(); ++k) {
        if (run.body.T_r_o[k] && run.gravityFrame.R_g_o[k])
            sum += run.body.T_r_o[k]->linear() * run.gravityFrame.R_g_o[k]->transpose();
    }
    if (sum.isZero())
        return std::nullopt;
    return nearestRotation(sum);
}

/// Attaches what the graph could not reach, until nothing changes.
void attachRest(Run& run) {
    const auto R_r_g = gravityInBody(run);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t v = 0; v < run.body.T_r_v.size(); ++v) {
            if (!run.body.T_r_v[v]) {
                run.body.T_r_v[v] = resectView(run.sightings, v, run.body, run.measurements.camera, run.options.pose,
                                               run.options.selection.decisiveCostRatio);
                changed = changed || run.body.T_r_v[v].has_value();
            }
        }
        for (std::size_t k = 0; R_r_g && k < run.body.T_r_o.size(); ++k) {
            if (!run.body.T_r_o[k] && run.gravityFrame.R_g_o[k]) {
                run.body.T_r_o[k] = triangulatePatch(run.sightings, k, *R_r_g * *run.gravityFrame.R_g_o[k], run.body,
                                                     run.measurements.camera);
                changed = changed || run.body.T_r_o[k].has_value();
            }
        }
    }
}

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

BodyState initialState(const Run& run) {
    BodyState state;
    state.T_r_u.resize(run.measurements.skin.modules.size());
    state.T_r_v = run.body.T_r_v;
    state.accelerometers = run.shapes.accelerometers;
    for (std::size_t k = 0; k < run.layout.patches.size(); ++k) {
        if (!run.body.T_r_o[k])
            continue;
        const Patch& patch = run.layout.patches[k];
        for (std::size_t i = 0; i < patch.modules.size(); ++i) {
            if (run.shapes.shapes[k].T_o_u[i])
                state.T_r_u[patch.modules[i]] = *run.body.T_r_o[k] * *run.shapes.shapes[k].T_o_u[i];
        }
    }
    return state;
}

/// Patches that hung from gravity as one piece share its directions; each other one has its own.
std::vector<std::size_t> gravityGroups(const Run& run) {
    std::vector<std::size_t> groupOfPatch(run.layout.patches.size(), 0);
    std::size_t next = 1;
    for (std::size_t k = 0; k < groupOfPatch.size(); ++k) {
        if (!run.gravityFrame.R_g_o[k])
            groupOfPatch[k] = next++;
    }
    std::vector<std::size_t> groups;
    for (const std::size_t k : run.layout.patchOf)
        groups.push_back(groupOfPatch[k]);
    return groups;
}

/// Where nothing else tells two poses of a view apart (one flat patch alone in the picture), the likelier stands in
/// and the other is kept, for the adjustment to decide.
std::vector<ViewAlternative> placeUndecided(Run& run, std::vector<Selection> selections) {
    if (std::none_of(run.body.T_r_v.begin(), run.body.T_r_v.end(), [](const auto& T) { return T.has_value(); })) {
        for (Selection& selection : selections)
            selection.undecided = false;
        placeByGraph(run, selections);
        for (Selection& selection : selections)
            selection.undecided = true;
        attachRest(run);
    }
    std::vector<ViewAlternative> alternatives;
    std::vector<bool> standsIn(run.body.T_r_v.size(), false);
    for (std::size_t s = 0; s < run.candidates.size(); ++s) {
        const SightingCandidates& sighting = run.candidates[s];
        if (!selections[s].undecided || !run.body.T_r_o[sighting.patch])
            continue;
        auto& T_r_v = run.body.T_r_v[sighting.view];
        for (std::size_t k = 0; k < sighting.poses.size(); ++k) {
            const Isometry3d place = *run.body.T_r_o[sighting.patch] * sighting.poses[k].T_v_o.inverse();
            if (!T_r_v) {
                T_r_v = place;
                standsIn[sighting.view] = true;
            } else if (standsIn[sighting.view] || selections[s].candidate != k) {
                alternatives.push_back({sighting.view, place});
            }
        }
    }
    return alternatives;
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
    return result->state;
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
        estimate.patchStatus[k] = "not seen with a placed patch";
        estimate.missing.push_back(whyNotPlaced(skin, patch, run.evidence[k], run.options.pose.minInliers, anyPlaced));
    }
    for (std::size_t v = 0; v < run.body.T_r_v.size(); ++v) {
        estimate.viewStatus[v] =
            run.body.T_r_v[v] ? "placed" : "shows no placed patch well enough, or could be in two places";
        if (!run.body.T_r_v[v])
            estimate.warnings.push_back(
                fmt::format("view {} is not used: it {}", run.measurements.views[v].name, estimate.viewStatus[v]));
    }
    const bool anyGravity = run.gravity.poseCount() > 0;
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
tl::expected<Round, CalibrationError> solveRound(const Measurements& measurements, const LinkGaps& gaps,
                                                 const SturdyMethodOptions& options, const RunContext& context) {
    const Skin& skin = measurements.skin;
    Run run{measurements, options, context, GravityTable(skin, measurements.gravity), {}, {}, {}, {}, {}, {},
            {},           {},      {}};
    run.layout = layOutSkin(measurements, run.gravity, options.layout, gaps);
    run.input.skin = &skin;
    run.input.camera = &measurements.camera;
    run.input.gravity = &run.gravity;
    run.input.pixels = flattenDetections(measurements);
    run.input.links = adjacentPorts(skin, run.layout);

    auto shapes = estimatePatchShapes(skin, run.layout, run.gravity, options.adjustment, context);
    if (!shapes)
        return tl::unexpected(shapes.error());
    run.shapes = std::move(*shapes);
    run.sightings = collectSightings(skin, run.layout, run.shapes.shapes, run.input.pixels);
    run.evidence = patchEvidence(run.layout, run.shapes.shapes, run.input.pixels);
    findCandidates(run);
    if (context.isCancelled())
        return tl::unexpected(CalibrationError{ErrorCode::Cancelled, {}});
    run.gravityFrame = alignPatchesByGravity(run.shapes.up_o, options.gravity);
    run.input.gravityGroup = gravityGroups(run);
    const auto selections = selectCandidates(run.candidates, run.gravityFrame.R_g_o, options.selection);
    placeByGraph(run, selections);
    attachRest(run);
    const auto alternatives = placeUndecided(run, selections);

    BodyEstimate& estimate = run.estimate;
    estimate.method = "sturdy";
    estimate.rejected.assign(run.input.pixels.size(), false);
    estimate.rejectedReason.resize(run.input.pixels.size());
    estimate.patchStatus.resize(run.layout.patches.size());
    estimate.viewStatus.resize(measurements.views.size());
    estimate.T_r_o.resize(run.layout.patches.size());

    BodyState state = initialState(run);
    if (!alternatives.empty()) {
        auto settled = settleViews(run.input, std::move(state), alternatives, options.adjustment, context);
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
    return Round{assembleBody(measurements, run.gravity, run.layout, run.input, estimate), gapsOf(run, state, gaps)};
}

}  // namespace

bool SturdyMethodOptions::validate() const {
    return layout.validate() && pose.validate() && gravity.validate() && selection.validate() && averaging.validate() &&
           adjustment.validate() && rejectionSigmas > 1 && maxRelinkings >= 0 && gravityRotationSigma > 0;
}

tl::expected<BodyModel, CalibrationError> calibrateSturdy(const Measurements& measurements,
                                                          const SturdyMethodOptions& options,
                                                          const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("SturdyMethodOptions out of range");
    const GravityTable gravity(measurements.skin, measurements.gravity);
    LinkGaps gaps;
    auto round = solveRound(measurements, gaps, options, context);
    // A solution tells better than any single measurement which links are cables; so long as it does, solve again.
    for (int more = 0; round && more < options.maxRelinkings; ++more) {
        const auto before = kindsOf(layOutSkin(measurements, gravity, options.layout, gaps));
        if (kindsOf(layOutSkin(measurements, gravity, options.layout, round->gaps)) == before)
            break;
        gaps = round->gaps;
        round = solveRound(measurements, gaps, options, context);
    }
    if (!round)
        return tl::unexpected(round.error());
    return std::move(round->body);
}

}  // namespace skincal
