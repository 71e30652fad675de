#include "core/estimation/second_place.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace skincal {
namespace {

constexpr double kNear = 0.10;               // m
constexpr double kNearAngle = 10 * kDegree;  // a knock, no other place
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

/// The place that explains the most of some detections.
std::optional<Place> placeOf(const BodySolution& solution, const Seen& seen, const std::vector<std::size_t>& among) {
    std::vector<LedCorrespondence> leds;
    for (const std::size_t i : among)
        leds.push_back(seen.leds[i]);
    PatchPoseOptions options;
    options.shapeSigma = 0.2e-3;  // modules are known this well by now, where they were seen by other views
    options.minInlierShare = 0.2;
    options.minInliers = static_cast<int>(kFewest);
    options.maxCandidates = 1;
    const auto poses = estimatePatchPoses(leds, *solution.input.camera, options);
    if (!poses)
        return std::nullopt;
    Place place{poses->front().T_v_o.inverse(), {}};
    for (std::size_t i = 0; i < among.size(); ++i) {
        if (poses->front().inliers[i])
            place.members.push_back(among[i]);
    }
    return place;
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
    const auto first = placeOf(solution, seen, all);
    if (!first)
        return false;
    std::vector<std::size_t> rest;
    std::set_difference(all.begin(), all.end(), first->members.begin(), first->members.end(), std::back_inserter(rest));
    const auto second = rest.size() < kFewest ? std::nullopt : placeOf(solution, seen, rest);
    const Isometry3d T = second ? first->T_r_v.inverse() * second->T_r_v : Isometry3d::Identity();
    if (!second || 2 * second->members.size() < rest.size() || T.translation().norm() > kNear ||
        rotationAngle(T.linear()) > kNearAngle) {
        // One place, but not where the view was taken to stand: between two that it can't be at once, or astray.
        const bool better = first->members.size() > countedIn(solution, seen) + kFewest;
        if (better)
            solution.solved.T_r_v[view] = first->T_r_v;
        return better;
    }
    BodyEstimate& estimate = solution.estimate;
    const std::string name = solution.measurements->views[view].name;
    Finding finding;
    finding.kind = Finding::Kind::BumpedView;
    finding.view = name;
    finding.text = fmt::format(
        "view {}: the camera was moved half-way, by {:.1f} mm and {:.2f}°: {} of its {} detections fit the second "
        "place "
        "and do not count",
        name, T.translation().norm() * 1e3, rotationAngle(T.linear()) / kDegree, second->members.size(),
        seen.pixels.size());
    for (const std::size_t i : second->members) {
        finding.modules.push_back(solution.input.skin->modules[solution.input.pixels[seen.pixels[i]].module].id);
        estimate.setAside[seen.pixels[i]] = "seen from where the camera stood after it was moved";
    }
    estimate.findings.push_back(std::move(finding));
    solution.solved.T_r_v[view] = first->T_r_v;
    solution.input.viewNoise[view] = 1;
    return true;
}

}  // namespace skincal
