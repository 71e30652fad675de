#include "core/estimation/second_place.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace skincal {
namespace {

constexpr double kNear = 0.10;               // m
constexpr double kNearAngle = 10 * kDegree;  // a knock, no other place
constexpr double kModuleSigma = 0.2e-3;      // m: how well modules are known by then that other views see, too
constexpr std::size_t kFewest = 5;           // three always fit some pose, a fourth one sometimes by chance

/// Detections of a view whose modules have a place, by their position in the input.
struct Seen {
    std::vector<std::size_t> pixels;
    std::vector<LedCorrespondence> leds;
};

Seen seenIn(const BodySolution& solution, std::size_t view) {
    Seen seen;
    for (std::size_t i = 0; i < solution.input.pixels.size(); ++i) {
        const PixelObservation& o = solution.input.pixels[i];
        const auto& T_r_u = solution.solved.T_r_u[o.module];
        if (o.view != view || !T_r_u || !solution.estimate.setAside[i].empty())
            continue;
        seen.pixels.push_back(i);
        seen.leds.push_back({*T_r_u * solution.input.skin->templateOf(o.module).led, T_r_u->linear().col(2), o.pixel,
                             solution.weights.pixelSigmaFactor * o.sigma_px});
    }
    return seen;
}

struct Place {
    Isometry3d T_r_v;
    std::vector<std::size_t> members;  ///< positions in Seen
};

/// From a place that explains many detections to within a pixel or two to the one that explains the most of them
/// exactly: modules stay where they are, and what does not fit fades out as the scale shrinks. Two places may be less
/// than a pixel apart for half of what they show.
Isometry3d settledPlace(const BodySolution& solution, std::size_t view, const Isometry3d& start,
                        const std::vector<PixelObservation>& pixels, double from_px) {
    const GravityTable none(*solution.input.skin, {});
    AdjustmentInput input;
    input.skin = solution.input.skin;
    input.camera = solution.input.camera;
    input.gravity = &none;
    input.pixels = pixels;
    input.gravityGroup = solution.input.gravityGroup;
    BodyState state = solution.solved;
    state.up_r.clear();
    std::fill(state.T_r_v.begin(), state.T_r_v.end(), std::nullopt);
    state.T_r_v[view] = start;
    Gauge modules;
    for (const PixelObservation& o : pixels)
        modules.modules.push_back(o.module);
    AdjustmentOptions options = solution.weights;
    options.pixelLoss = 2;
    options.lossBegins = 0;
    for (const double scale_px : {1.0, 0.3, 0.1, 0.0}) {
        if (scale_px > from_px)
            continue;
        options.pixelSigmaFloor_px = std::max(scale_px, solution.weights.pixelSigmaFloor_px);
        if (auto result = adjustBody(input, state, modules, options))
            state = std::move(result->state);
    }
    return *state.T_r_v[view];
}

bool fits(const BodySolution& solution, const Isometry3d& T_r_v, const Vector3d& led_r, const PixelObservation& o) {
    const Vector3d p_v = T_r_v.inverse() * led_r;
    const auto pixel = solution.input.camera->project(p_v);
    const double sigma =
        std::hypot(solution.input.sigmaOf(o, solution.weights), kModuleSigma / 2 * solution.input.camera->fx / p_v.z());
    constexpr double kWithin = 4;
    return pixel && (*pixel - o.pixel).norm() < kWithin * sigma;
}

/// The place that explains the most of some detections.
std::optional<Place> placeOf(const BodySolution& solution, std::size_t view, const Seen& seen,
                             const std::vector<std::size_t>& among) {
    std::vector<LedCorrespondence> leds;
    std::vector<PixelObservation> pixels;
    for (const std::size_t i : among) {
        leds.push_back(seen.leds[i]);
        pixels.push_back(solution.input.pixels[seen.pixels[i]]);
    }
    PatchPoseOptions options;
    options.shapeSigma = kModuleSigma;
    options.minInlierShare = 0.2;
    options.minInliers = static_cast<int>(kFewest);
    options.maxCandidates = 1;
    const auto poses = estimatePatchPoses(leds, *solution.input.camera, options);
    if (!poses)
        return std::nullopt;
    std::optional<Place> best;
    // A coarse start finds the larger of two places that were taken together, a fine one keeps to that which was found.
    for (const double from_px : {1.0, 0.1}) {
        Place place{settledPlace(solution, view, poses->front().T_v_o.inverse(), pixels, from_px), {}};
        for (std::size_t i = 0; i < among.size(); ++i) {
            if (fits(solution, place.T_r_v, leds[i].led_o, pixels[i]))
                place.members.push_back(among[i]);
        }
        if (!best || place.members.size() > best->members.size())
            best = std::move(place);
    }
    if (best->members.size() < kFewest)
        return std::nullopt;
    return best;
}

std::size_t countedIn(const BodySolution& solution, const Seen& seen) {
    return static_cast<std::size_t>(std::count_if(seen.pixels.begin(), seen.pixels.end(),
                                                  [&](std::size_t i) { return !solution.estimate.rejected[i]; }));
}

}  // namespace

std::vector<bool> viewsWithManyRejected(const BodySolution& solution) {
    std::vector<std::size_t> rejected(solution.solved.T_r_v.size(), 0);
    std::vector<std::size_t> all(rejected.size(), 0);
    for (std::size_t i = 0; i < solution.input.pixels.size(); ++i) {
        if (!solution.estimate.setAside[i].empty())
            continue;
        ++all[solution.input.pixels[i].view];
        rejected[solution.input.pixels[i].view] += solution.estimate.rejected[i] ? 1 : 0;
    }
    std::vector<bool> many(all.size());
    for (std::size_t v = 0; v < many.size(); ++v)
        many[v] = rejected[v] >= kFewest && 6 * rejected[v] > all[v];
    return many;
}

bool setSecondPlaceAside(BodySolution& solution, std::size_t view) {
    if (!solution.solved.T_r_v[view])
        return false;
    const Seen seen = seenIn(solution, view);
    std::vector<std::size_t> all(seen.pixels.size());
    for (std::size_t i = 0; i < all.size(); ++i)
        all[i] = i;
    const auto first = placeOf(solution, view, seen, all);
    if (!first)
        return false;
    std::vector<std::size_t> rest;
    std::set_difference(all.begin(), all.end(), first->members.begin(), first->members.end(), std::back_inserter(rest));
    const auto second = rest.size() < kFewest ? std::nullopt : placeOf(solution, view, seen, rest);
    const Isometry3d T = second ? first->T_r_v.inverse() * second->T_r_v : Isometry3d::Identity();
    if (!second || 2 * second->members.size() < rest.size() || T.translation().norm() > kNear ||
        rotationAngle(T.linear()) > kNearAngle) {
        // One place, but not where the view was taken to stand: between two that it can't be at once, or astray.
        const bool better = first->members.size() > countedIn(solution, seen) + kFewest;
        if (better) {
            solution.solved.T_r_v[view] = first->T_r_v;
            anchorAtFirstView(solution);
        }
        return better;
    }
    BodyEstimate& estimate = solution.estimate;
    const std::string name = solution.measurements->views[view].name;
    Finding finding;
    finding.kind = Finding::Kind::BumpedView;
    finding.view = name;
    finding.text = Sentence::saying(
        "view {}: the camera was moved half-way, by {:.1f} mm and {:.2f}°: what it saw from the second place does not "
        "count",
        name, T.translation().norm() * 1e3, rotationAngle(T.linear()) / kDegree);
    for (const std::size_t i : second->members) {
        finding.modules.push_back(solution.input.skin->modules[solution.input.pixels[seen.pixels[i]].module].id);
        estimate.setAside[seen.pixels[i]] = Sentence::saying("seen from where the camera stood after it was moved");
    }
    estimate.findings.push_back(std::move(finding));
    solution.solved.T_r_v[view] = first->T_r_v;
    anchorAtFirstView(solution);
    solution.input.viewNoise[view] = 1;
    return true;
}

}  // namespace skincal
