#include "core/estimation/alternatives.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/estimation/edge_rotation.h"

namespace skincal {
namespace {

std::vector<bool> misfits(const BodySolution& solution) {
    const std::size_t patches = solution.layout.patches.size();
    std::vector<std::size_t> rejected(patches, 0);
    std::vector<std::size_t> all(patches, 0);
    for (std::size_t i = 0; i < solution.input.pixels.size(); ++i) {
        const PixelObservation& o = solution.input.pixels[i];
        const std::size_t k = solution.layout.patchOf[o.module];
        if (!solution.solved.T_r_v[o.view])
            continue;
        ++all[k];
        rejected[k] += solution.estimate.rejected[i] || !solution.solved.T_r_u[o.module] ? 1 : 0;
    }
    std::vector<std::size_t> troubles(patches, 0);
    for (std::size_t u = 0; u < solution.estimate.moduleTrouble.size(); ++u)
        troubles[solution.layout.patchOf[u]] += solution.estimate.moduleTrouble[u].empty() ? 0 : 1;
    for (std::size_t l = 0; l < solution.estimate.linkTrouble.size(); ++l)
        troubles[solution.layout.patchOf[solution.layout.graph.links()[l].a]] +=
            solution.estimate.linkTrouble[l].empty() ? 0 : 1;
    constexpr std::size_t kFewest = 5;
    constexpr std::size_t kMuch = 3;
    std::vector<bool> result(patches);
    for (std::size_t k = 0; k < patches; ++k)
        result[k] = (rejected[k] >= kFewest && 3 * rejected[k] >= all[k]) || troubles[k] >= kMuch;
    return result;
}

/// Whether a patch falls apart without one of its links.
bool isBridge(const SkinLayout& layout, const Patch& patch, std::size_t without) {
    std::vector<std::size_t> root(layout.patchOf.size());
    std::iota(root.begin(), root.end(), 0U);
    const auto find = [&](std::size_t u) {
        while (root[u] != u)
            u = root[u] = root[root[u]];
        return u;
    };
    for (std::size_t l = 0; l < layout.verdicts.size(); ++l) {
        const GraphLink& link = layout.graph.links()[l];
        if (l != without && layout.verdicts[l].kind == LinkKind::Adjacent)
            root[find(link.a)] = find(link.b);
    }
    const std::size_t first = find(patch.modules.front());
    return std::any_of(patch.modules.begin(), patch.modules.end(), [&](std::size_t u) { return find(u) != first; });
}

double costOf(const BodySolution& solution, const AdjustmentOptions& weights, double limit) {
    double cost = 0;
    for (const PixelObservation& o : solution.input.pixels) {
        const auto r = pixelResidual(solution.input, solution.solved, o);
        const double sigma = solution.input.sigmaOf(o, weights);
        cost += 0.5 * std::min(r ? r->squaredNorm() / (sigma * sigma) : limit * limit, limit * limit);
    }
    return cost;
}

/// How many liberties a solution takes: cables, and patches whose gravity is their own.
double libertiesOf(const BodySolution& solution) {
    const auto& verdicts = solution.layout.verdicts;
    const auto& frames = solution.gravityFrame.R_g_o;
    return static_cast<double>(
        std::count_if(verdicts.begin(), verdicts.end(),
                      [](const LinkVerdict& v) { return v.kind == LinkKind::Cable; }) +
        std::count_if(frames.begin(), frames.end(), [](const auto& R) { return !R.has_value(); }));
}

/// Links without which a patch that does not fit falls apart, the likeliest cable first.
std::vector<std::size_t> doubtfulBridges(const BodySolution& solution, const std::vector<bool>& misfit) {
    if (std::none_of(misfit.begin(), misfit.end(), [](bool m) { return m; }))
        return {};
    const SkinLayout& layout = solution.layout;
    const std::size_t count = layout.verdicts.size();
    const auto separations =
        linkSeparations(*solution.measurements, layout.graph, std::vector<std::optional<Matrix3d>>(count),
                        CableOptions{}.maxSeparation, 1);
    struct Candidate {
        std::size_t link;
        double separation;
    };
    std::vector<Candidate> candidates;
    for (std::size_t l = 0; l < count; ++l) {
        const GraphLink& link = layout.graph.links()[l];
        const std::size_t k = layout.patchOf[link.a];
        if (layout.verdicts[l].kind == LinkKind::Adjacent && !link.decided && misfit[k] &&
            isBridge(layout, layout.patches[k], l))
            candidates.push_back({l, separations[l].value_or(0)});
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& x, const Candidate& y) { return x.separation > y.separation; });
    std::vector<std::size_t> links;
    for (const Candidate& candidate : candidates)
        links.push_back(candidate.link);
    return links;
}

constexpr std::size_t kEnoughForAPose = 4;

}  // namespace

std::vector<SolutionHistory> alternatives(const BodySolution& solution, const SolutionHistory& history, int most) {
    const SkinLayout& layout = solution.layout;
    const std::vector<bool> misfit = misfits(solution);
    std::vector<SolutionHistory> found;
    for (std::size_t k = 0; k < layout.patches.size(); ++k) {
        const bool lost = !solution.body.T_r_o[k] && solution.evidence[k].mostUsable >= kEnoughForAPose;
        if (!solution.gravityFrame.R_g_o[k] || !(misfit[k] || lost))
            continue;
        found.push_back(history);
        found.back().movedPatchesOf.push_back(layout.patches[k].origin);
    }
    for (const std::size_t l : doubtfulBridges(solution, misfit)) {
        found.push_back(history);
        found.back().refuted.resize(layout.verdicts.size());
        found.back().refuted[l] = "taken for neighbours, their patch did not fit its pictures";
        if (!found.back().gaps.empty())
            found.back().gaps[l].reset();
    }
    if (found.size() > static_cast<std::size_t>(most))
        found.resize(static_cast<std::size_t>(most));
    return found;
}

bool explainsMore(const BodySolution& solution, const BodySolution& than) {
    constexpr double kLimit = 5;       // standard deviations, where a detection is rejected
    constexpr double kChanceFit = 15;  // half the chi-squared of a link that would show
    const AdjustmentOptions& weights = solution.weights.pixelSigmaFactor * solution.weights.pixelSigmaFloor_px <
                                               than.weights.pixelSigmaFactor * than.weights.pixelSigmaFloor_px
                                           ? solution.weights
                                           : than.weights;
    const double more = kChanceFit * (libertiesOf(solution) - libertiesOf(than));
    return costOf(solution, weights, kLimit) + more < costOf(than, weights, kLimit);
}

void noteMovedPatches(BodySolution& solution, const SolutionHistory& history) {
    const auto& up_r = solution.solved.up_r;
    for (const std::size_t u : history.movedPatchesOf) {
        const Patch& patch = solution.layout.patches[solution.layout.patchOf[u]];
        Finding finding;
        finding.kind = Finding::Kind::MovedPatch;
        for (const std::size_t module : patch.modules)
            finding.modules.push_back(solution.input.skin->modules[module].id);
        std::vector<Vector3d> own;
        std::vector<Vector3d> rest;
        const std::size_t group = solution.input.gravityGroup[u];
        for (std::size_t p = 0; group < up_r.size() && p < up_r[group].size(); ++p) {
            if (up_r[group][p] && up_r[0][p]) {
                own.push_back(*up_r[group][p]);
                rest.push_back(*up_r[0][p]);
            }
        }
        const auto turn = estimateRelativeRotation(rest, own);
        finding.text = fmt::format(
            "patch {}: it turned{} against the rest since gravity was read, as when a joint moves: how it is turned "
            "rests "
            "on the camera alone",
            patch.id.value, turn ? fmt::format(" by {:.1f}°", rotationAngle(turn->R_c_n) / kDegree) : "");
        solution.estimate.findings.push_back(std::move(finding));
    }
}

}  // namespace skincal
