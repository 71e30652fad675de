#include "core/estimation/cable_trials.h"

#include <algorithm>
#include <numeric>

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
    constexpr std::size_t kFewest = 5;
    std::vector<bool> result(patches);
    for (std::size_t k = 0; k < patches; ++k)
        result[k] = rejected[k] >= kFewest && 3 * rejected[k] >= all[k];
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

std::size_t cablesIn(const SkinLayout& layout) {
    return static_cast<std::size_t>(std::count_if(layout.verdicts.begin(), layout.verdicts.end(),
                                                  [](const LinkVerdict& v) { return v.kind == LinkKind::Cable; }));
}

}  // namespace

std::vector<LinkHistory> cableTrials(const BodySolution& solution, const LinkHistory& links, int most) {
    const SkinLayout& layout = solution.layout;
    const std::vector<bool> misfit = misfits(solution);
    if (most == 0 || std::none_of(misfit.begin(), misfit.end(), [](bool m) { return m; }))
        return {};
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
    std::vector<LinkHistory> trials;
    for (const Candidate& candidate : candidates) {
        if (static_cast<int>(trials.size()) == most)
            break;
        LinkHistory trial = links;
        trial.refuted.resize(count);
        trial.refuted[candidate.link] = "taken for neighbours, their patch did not fit its pictures";
        if (!trial.gaps.empty())
            trial.gaps[candidate.link].reset();
        trials.push_back(std::move(trial));
    }
    return trials;
}

bool explainsMore(const BodySolution& solution, const BodySolution& than) {
    constexpr double kLimit = 5;       // standard deviations, where a detection is rejected
    constexpr double kChanceFit = 15;  // half the chi-squared of a link that would show
    const AdjustmentOptions& weights = solution.weights.pixelSigmaFactor * solution.weights.pixelSigmaFloor_px <
                                               than.weights.pixelSigmaFactor * than.weights.pixelSigmaFloor_px
                                           ? solution.weights
                                           : than.weights;
    const double more =
        kChanceFit * (static_cast<double>(cablesIn(solution.layout)) - static_cast<double>(cablesIn(than.layout)));
    return costOf(solution, weights, kLimit) + more < costOf(than, weights, kLimit);
}

}  // namespace skincal
