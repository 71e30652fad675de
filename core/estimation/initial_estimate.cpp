#include "core/estimation/initial_estimate.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/estimation/patch_sightings.h"
#include "core/estimation/shape_spots.h"
#include "core/geometry/parallel.h"

namespace skincal {
namespace {

std::optional<Matrix3d> gravityInBody(const InitialEstimate& run) {
    Matrix3d sum = Matrix3d::Zero();
    for (std::size_t k = 0; k < run.body.T_r_o.size(); ++k) {
        if (run.body.T_r_o[k] && run.gravityFrame.R_g_o[k])
            sum += run.body.T_r_o[k]->linear() * run.gravityFrame.R_g_o[k]->transpose();
    }
    if (sum.isZero())
        return std::nullopt;
    return nearestRotation(sum);
}

/// Everything that is known between the steps.
struct Work : InitialEstimate {
    const InitialEstimateOptions& options;
    const RunContext& context;
    std::vector<PatchSighting> sightings;
    std::vector<SightingCandidates> candidates;
};

void takeSpotsByShape(Work& run) {
    const auto chosen = chooseSpotsByShape(*run.measurements, run.layout, run.shapes.shapes, run.input.pixels,
                                           run.options.pose, run.context);
    for (const ChosenSpot& one : chosen) {
        run.spotsByShape.push_back({one.view, one.module, run.input.pixels.size(), one.spot.pixel, one.reason});
        run.input.pixels.push_back({one.view, one.module, one.spot.pixel, one.spot.sigma_px});
    }
}

void findCandidates(Work& run) {
    using Poses = tl::expected<std::vector<PatchPose>, CalibrationError>;
    const std::size_t count = run.sightings.size();
    std::vector<Poses> found(count);
    forEachInParallel(
        count, 1,
        [&](std::size_t s) {
            found[s] = estimatePatchPoses(run.sightings[s].leds, run.measurements->camera, run.options.pose);
        },
        [&](std::size_t s) {
            run.context.report(Sentence::saying("patch poses"), static_cast<double>(s) / static_cast<double>(count));
            return !run.context.isCancelled();
        });
    for (std::size_t s = 0; s < count; ++s) {
        SightingCandidates candidates{run.sightings[s].view, run.sightings[s].patch, {}};
        if (found[s])
            candidates.poses = std::move(*found[s]);
        else if (found[s].error().code != ErrorCode::TooFewPoints)
            ++run.evidence[run.sightings[s].patch].poseFailures[found[s].error().code];
        run.candidates.push_back(std::move(candidates));
    }
}

/// Nodes of the pose graph: views first, then patches, then the frame that gravity gives.
std::vector<PoseEdge> sightingEdges(const Work& run, const std::vector<Selection>& selections) {
    const std::size_t views = run.measurements->views.size();
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
std::vector<bool> largestPart(const Work& run, const std::vector<PoseEdge>& edges) {
    const std::size_t views = run.measurements->views.size();
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

void placeByGraph(Work& run, const std::vector<Selection>& selections) {
    const std::size_t views = run.measurements->views.size();
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

/// Patches that hung from gravity as one piece share its directions; each other one has its own.
std::vector<std::size_t> gravityGroups(const Work& run) {
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

/// Whether a pose that explains a picture worse than another would be as good with a shape that is off by what shapes
/// from gravity are: with s what that makes in pixels, half the difference of their chi-squared is small enough.
bool isWithinReach(const Work& run, const SightingCandidates& sighting, std::size_t rival, std::size_t best) {
    constexpr double kFar = 50;
    const PatchPose& pose = sighting.poses[best];
    const double s = run.options.pose.shapeSigma * run.measurements->camera.fx / pose.T_v_o.translation().z();
    const double more = sighting.poses[rival].cost - pose.cost;
    return static_cast<double>(pose.inliers.size()) * more < 2 * kFar * s * s;
}

/// Where nothing else tells two poses of a view apart (one flat patch alone in the picture), the likelier stands in
/// and the other is kept, for the adjustment to decide.
std::vector<ViewAlternative> placeUndecided(Work& run, std::vector<Selection> selections) {
    if (std::none_of(run.body.T_r_v.begin(), run.body.T_r_v.end(), [](const auto& T) { return T.has_value(); })) {
        for (Selection& selection : selections)
            selection.undecided = false;
        placeByGraph(run, selections);
        for (Selection& selection : selections)
            selection.undecided = true;
        attachRest(run, run.sightings, run.options);
    }
    std::vector<ViewAlternative> alternatives;
    std::vector<bool> standsIn(run.body.T_r_v.size(), false);
    for (std::size_t s = 0; s < run.candidates.size(); ++s) {
        const SightingCandidates& sighting = run.candidates[s];
        if (!run.body.T_r_o[sighting.patch])
            continue;
        const auto placeOf = [&](std::size_t candidate) -> Isometry3d {
            return *run.body.T_r_o[sighting.patch] * sighting.poses[candidate].T_v_o.inverse();
        };
        if (!selections[s].undecided) {
            for (const std::size_t rival : selections[s].rivals) {
                if (isWithinReach(run, sighting, rival, *selections[s].candidate))
                    alternatives.push_back({sighting.view, placeOf(rival), sighting.patch});
            }
            continue;
        }
        auto& T_r_v = run.body.T_r_v[sighting.view];
        for (std::size_t k = 0; k < sighting.poses.size(); ++k) {
            const Isometry3d place = placeOf(k);
            if (!T_r_v) {
                T_r_v = place;
                standsIn[sighting.view] = true;
            } else if (standsIn[sighting.view] || selections[s].candidate != k) {
                alternatives.push_back({sighting.view, place, sighting.patch});
            }
        }
    }
    return alternatives;
}

}  // namespace

bool InitialEstimateOptions::validate() const {
    return layout.validate() && pose.validate() && gravity.validate() && selection.validate() && averaging.validate() &&
           shapes.validate() && gravityRotationSigma > 0;
}

BodyState InitialEstimate::state() const {
    BodyState result;
    result.T_r_u.resize(layout.patchOf.size());
    result.T_r_v = body.T_r_v;
    result.accelerometers = shapes.accelerometers;
    for (std::size_t k = 0; k < layout.patches.size(); ++k) {
        if (!body.T_r_o[k])
            continue;
        const Patch& patch = layout.patches[k];
        for (std::size_t i = 0; i < patch.modules.size(); ++i) {
            if (shapes.shapes[k].T_o_u[i])
                result.T_r_u[patch.modules[i]] = *body.T_r_o[k] * *shapes.shapes[k].T_o_u[i];
        }
    }
    return result;
}

void attachRest(InitialEstimate& run, const std::vector<PatchSighting>& sightings,
                const InitialEstimateOptions& options) {
    const auto R_r_g = gravityInBody(run);
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t v = 0; v < run.body.T_r_v.size(); ++v) {
            if (!run.body.T_r_v[v]) {
                run.body.T_r_v[v] = resectView(sightings, v, run.body, run.measurements->camera, options.pose,
                                               options.selection.decisiveCostRatio);
                changed = changed || run.body.T_r_v[v].has_value();
            }
        }
        for (std::size_t k = 0; R_r_g && k < run.body.T_r_o.size(); ++k) {
            if (!run.body.T_r_o[k] && run.gravityFrame.R_g_o[k]) {
                run.body.T_r_o[k] = triangulatePatch(sightings, k, *R_r_g * *run.gravityFrame.R_g_o[k], run.body,
                                                     run.measurements->camera);
                changed = changed || run.body.T_r_o[k].has_value();
            }
        }
    }
}

tl::expected<InitialEstimate, CalibrationError> estimateInitially(const Measurements& measurements,
                                                                  const GravityTable& gravity,
                                                                  const SolutionHistory& history,
                                                                  const InitialEstimateOptions& options,
                                                                  const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("InitialEstimateOptions out of range");
    const Skin& skin = measurements.skin;
    Work run{{}, options, context, {}, {}};
    run.measurements = &measurements;
    run.layout = layOutSkin(measurements, gravity, options.layout, history);
    run.input.skin = &skin;
    run.input.camera = &measurements.camera;
    run.input.gravity = &gravity;
    run.input.pixels = flattenDetections(measurements);
    run.input.links = adjacentPorts(skin, run.layout);

    auto shapes = estimatePatchShapes(skin, run.layout, gravity, options.shapes, context);
    if (!shapes)
        return tl::unexpected(shapes.error());
    run.shapes = std::move(*shapes);
    takeSpotsByShape(run);
    run.sightings = collectSightings(skin, run.layout, run.shapes.shapes, run.input.pixels);
    run.evidence = patchEvidence(run.layout, run.shapes.shapes, run.input.pixels);
    findCandidates(run);
    if (context.isCancelled())
        return tl::unexpected(CalibrationError{ErrorCode::Cancelled, {}});
    run.gravityFrame = alignPatchesByGravity(run.shapes.up_o, options.gravity);
    for (const std::size_t u : history.movedPatchesOf)
        run.gravityFrame.R_g_o[run.layout.patchOf[u]].reset();
    run.input.gravityGroup = gravityGroups(run);
    const auto selections = selectCandidates(run.candidates, run.gravityFrame.R_g_o, options.selection);
    placeByGraph(run, selections);
    attachRest(run, run.sightings, run.options);
    run.alternatives = placeUndecided(run, selections);
    return std::move(static_cast<InitialEstimate&>(run));
}

}  // namespace skincal
