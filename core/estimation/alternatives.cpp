#include "core/estimation/alternatives.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/estimation/edge_rotation.h"
#include "core/estimation/wrong_links.h"

namespace skincal {
namespace {

/// Per patch of a layout: rms distance between ports that should meet, m; 0 where there are too few to tell.
std::vector<double> typicalGaps(const BodySolution& solution, const SkinLayout& layout) {
    std::vector<double> squares(layout.patches.size(), 0);
    std::vector<double> counts(squares.size(), 0);
    for (const PortPair& pair : solution.input.links) {
        if (!solution.solved.T_r_u[pair.a] || !solution.solved.T_r_u[pair.b])
            continue;
        const double gap = gapOf(solution, solution.layout.graph.links()[pair.link]);
        squares[layout.patchOf[pair.a]] += gap * gap;
        counts[layout.patchOf[pair.a]] += 1;
    }
    constexpr double kFewest = 4;
    for (std::size_t k = 0; k < squares.size(); ++k)
        squares[k] = counts[k] < kFewest ? 0 : std::sqrt(squares[k] / counts[k]);
    return squares;
}

/// Per patch of a layout, the solution's own or that before any solution: whether it does not fit.
std::vector<bool> misfits(const BodySolution& solution, const SkinLayout& layout) {
    const std::size_t patches = layout.patches.size();
    std::vector<std::size_t> rejected(patches, 0);
    std::vector<std::size_t> all(patches, 0);
    std::vector<std::size_t> troubles(patches, 0);
    for (std::size_t i = 0; i < solution.input.pixels.size(); ++i) {
        const PixelObservation& o = solution.input.pixels[i];
        if (!solution.solved.T_r_v[o.view])
            continue;
        ++all[layout.patchOf[o.module]];
        rejected[layout.patchOf[o.module]] += solution.estimate.rejected[i] || !solution.solved.T_r_u[o.module] ? 1 : 0;
    }
    for (std::size_t u = 0; u < solution.estimate.moduleTrouble.size(); ++u)
        troubles[layout.patchOf[u]] += solution.estimate.moduleTrouble[u].empty() ? 0 : 1;
    for (std::size_t l = 0; l < solution.layout.verdicts.size(); ++l) {
        const LinkReason reason = solution.layout.verdicts[l].reason;
        const bool torn = layout.verdicts[l].kind == LinkKind::Adjacent &&
                          (reason == LinkReason::Gap || reason == LinkReason::Refuted);
        troubles[layout.patchOf[layout.graph.links()[l].a]] +=
            torn || !solution.estimate.linkTrouble[l].empty() ? 1 : 0;
    }
    const std::vector<double> gaps = typicalGaps(solution, layout);
    constexpr std::size_t kFewest = 5;
    constexpr std::size_t kMuch = 3;
    constexpr double kWide = 1.5e-3;  // m, rms: no patch that fits has its ports so far apart
    std::vector<bool> result(patches);
    for (std::size_t k = 0; k < patches; ++k)
        result[k] = (rejected[k] >= kFewest && 3 * rejected[k] >= all[k]) || troubles[k] >= kMuch || gaps[k] > kWide;
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

/// Half the sum of squares of all that was measured, none of it more than the limit lets one measurement cost.
double costOf(const BodySolution& solution, const AdjustmentOptions& weights, double limit) {
    const AdjustmentInput& input = solution.input;
    const BodyState& state = solution.solved;
    double cost = 0;
    const auto add = [&](double squares) { cost += 0.5 * std::min(squares, limit * limit); };
    for (const PixelObservation& o : input.pixels) {
        const auto r = pixelResidual(input, state, o);
        const double sigma = input.sigmaOf(o, weights);
        add(r ? r->squaredNorm() / (sigma * sigma) : limit * limit);
    }
    for (std::size_t l = 0; l < solution.layout.verdicts.size(); ++l) {
        const GraphLink& link = solution.layout.graph.links()[l];
        if (solution.layout.verdicts[l].kind == LinkKind::Cable)
            continue;
        const bool placed = state.T_r_u[link.a] && state.T_r_u[link.b];
        const double gap = placed ? gapOf(solution, link) / weights.linkSigma : limit;
        add(gap * gap);
    }
    if (state.up_r.empty())
        return cost;
    for (std::size_t u = 0; u < state.T_r_u.size(); ++u) {
        const auto residuals = gravityResiduals(input, state, u);
        for (const Vector3d& r : residuals)
            add(r.squaredNorm() / (weights.accelerometerSigma * weights.accelerometerSigma));
    }
    return cost;
}

/// The smaller of two standard deviations of each kind: a bad solution must not be excused by its own.
AdjustmentOptions stricter(const AdjustmentOptions& a, const AdjustmentOptions& b) {
    AdjustmentOptions weights = a;
    if (b.pixelSigmaFactor * b.pixelSigmaFloor_px < a.pixelSigmaFactor * a.pixelSigmaFloor_px)
        weights = b;
    weights.linkSigma = std::min(a.linkSigma, b.linkSigma);
    weights.accelerometerSigma = std::min(a.accelerometerSigma, b.accelerometerSigma);
    return weights;
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

/// A patch that moved may have been torn to pieces by the gaps that came of it: it is judged as it was at first.
/// Modules that are turned where they sit tear ports apart by no more than they measure; wider gaps are those of
/// cables.
SolutionHistory withoutTurns(const BodySolution& solution, const SolutionHistory& history) {
    SolutionHistory whole = history;
    for (std::size_t l = 0; l < whole.gaps.size(); ++l) {
        const double widest = 2 * solution.input.skin->templateOf(solution.layout.graph.links()[l].a).portRadius();
        if (whole.gaps[l] && *whole.gaps[l] < widest)
            whole.gaps[l].reset();
    }
    return whole;
}

constexpr std::size_t kEnoughForAPose = 4;

}  // namespace

std::vector<SolutionHistory> alternatives(const BodySolution& solution, const SolutionHistory& history,
                                          const LayoutOptions& options, int most) {
    const SkinLayout& layout = solution.layout;
    const SolutionHistory whole = withoutTurns(solution, history);
    const SkinLayout before = layOutSkin(*solution.measurements, *solution.input.gravity, options, whole);
    std::vector<bool> suspicious = misfits(solution, before);
    for (std::size_t k = 0; k < layout.patches.size(); ++k) {
        if (!solution.body.T_r_o[k] && solution.evidence[k].mostUsable >= kEnoughForAPose)
            suspicious[before.patchOf[layout.patches[k].origin]] = true;
    }
    std::vector<SolutionHistory> found;
    for (std::size_t k = 0; k < suspicious.size(); ++k) {
        const std::size_t origin = before.patches[k].origin;
        if (!suspicious[k] || !solution.gravityFrame.R_g_o[layout.patchOf[origin]])
            continue;
        found.push_back(whole);
        found.back().movedPatchesOf.push_back(origin);
    }
    for (const std::size_t l : doubtfulBridges(solution, misfits(solution, layout))) {
        found.push_back(history);
        found.back().refuted.resize(layout.verdicts.size());
        found.back().refuted[l] = Sentence::saying("taken for neighbours, their patch did not fit its pictures");
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
    const AdjustmentOptions weights = stricter(solution.weights, than.weights);
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
        finding.text = turn ? Sentence::saying(
                                  "patch {}: it turned by {:.1f}° against the rest since gravity was read, as when a "
                                  "joint moves: how it is turned rests on the camera alone",
                                  patch.id.value, rotationAngle(turn->R_c_n) / kDegree)
                            : Sentence::saying(
                                  "patch {}: it turned against the rest since gravity was read, as when a joint moves: "
                                  "how it is turned rests on the camera alone",
                                  patch.id.value);
        solution.estimate.findings.push_back(std::move(finding));
    }
}

}  // namespace skincal
