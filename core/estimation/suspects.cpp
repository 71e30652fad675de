#include "core/estimation/suspects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "core/estimation/led_triangulation.h"

namespace skincal {
namespace {

/// A link that is not believed, by its position in the input of the adjustment.
struct BadLink {
    std::size_t pair = 0;
    double disagreement = 0;
};

struct Suspect {
    double weight = 0;  ///< how strongly the rest contradicts it, chi-squared
    std::optional<std::size_t> module{};
    std::optional<std::size_t> pair{};
};

/// Everything that is needed to judge, gathered once.
struct Evidence {
    std::vector<BadLink> badLinks;
    std::vector<std::vector<std::size_t>> pairsOf;  ///< per module: positions in the input's links
    std::vector<std::vector<std::size_t>> badPairsOf;
    std::vector<double> badness;                     ///< per module: of its bad links together
    std::vector<std::optional<Vector3d>> elsewhere;  ///< per module: where all its rejected detections have its LED
};

Evidence gather(const BodySolution& solution, const AdjustmentInput& used, const SolutionReview& review,
                const SuspectOptions& options) {
    const std::size_t modules = solution.solved.T_r_u.size();
    Evidence evidence;
    evidence.pairsOf.resize(modules);
    evidence.badPairsOf.resize(modules);
    evidence.badness.resize(modules, 0);
    for (std::size_t i = 0; i < used.links.size(); ++i) {
        if (!review.links[i])
            continue;
        for (const std::size_t end : {used.links[i].a, used.links[i].b})
            evidence.pairsOf[end].push_back(i);
        if (review.links[i]->disagreement < options.linkDisagreement)
            continue;
        evidence.badLinks.push_back({i, review.links[i]->disagreement});
        for (const std::size_t end : {used.links[i].a, used.links[i].b}) {
            evidence.badPairsOf[end].push_back(i);
            evidence.badness[end] += review.links[i]->disagreement;
        }
    }
    evidence.elsewhere = ledsSeenElsewhere(solution);
    return evidence;
}

/// The strongest suspects, none of which another one's error could have brought in: those that share a link with a
/// stronger one wait for the next round.
std::vector<Suspect> strongest(const Evidence& evidence, const AdjustmentInput& used) {
    std::vector<Suspect> all;
    for (std::size_t u = 0; u < evidence.badness.size(); ++u) {
        constexpr double kSeenElsewhere = 100;  // as much as a link that is ten standard deviations off
        const std::size_t bad = evidence.badPairsOf[u].size();
        const bool linksDisagree = bad >= 2 && 2 * bad >= evidence.pairsOf[u].size();
        if (linksDisagree || evidence.elsewhere[u])
            all.push_back({evidence.badness[u] + (evidence.elsewhere[u] ? kSeenElsewhere : 0), u, std::nullopt});
    }
    for (const BadLink& link : evidence.badLinks)
        all.push_back({link.disagreement, std::nullopt, link.pair});
    std::stable_sort(all.begin(), all.end(), [](const Suspect& x, const Suspect& y) { return x.weight > y.weight; });
    std::vector<Suspect> chosen;
    std::set<std::size_t> touched;
    for (const Suspect& suspect : all) {
        std::vector<std::size_t> near;
        if (suspect.pair)
            near = {used.links[*suspect.pair].a, used.links[*suspect.pair].b};
        else
            near = {*suspect.module};
        if (std::any_of(near.begin(), near.end(), [&](std::size_t u) { return touched.contains(u); }))
            continue;
        for (const std::size_t u : near) {
            touched.insert(u);
            for (const std::size_t i : evidence.pairsOf[u])
                touched.insert({used.links[i].a, used.links[i].b});
        }
        chosen.push_back(suspect);
    }
    return chosen;
}

/// Points that a module should have, in its own frame, and where the others have them.
struct PointPairs {
    std::vector<Vector3d> own;
    std::vector<Vector3d> body;
};

struct RigidFit {
    Isometry3d T_r_u = Isometry3d::Identity();
    double rms = 1e9;
};

/// At least three points; fewer always fit.
RigidFit fitModule(const PointPairs& points) {
    RigidFit fit;
    if (points.own.size() < 3)
        return fit;
    Eigen::Matrix3Xd own(3, points.own.size());
    Eigen::Matrix3Xd body(3, points.own.size());
    for (std::size_t i = 0; i < points.own.size(); ++i) {
        own.col(static_cast<Eigen::Index>(i)) = points.own[i];
        body.col(static_cast<Eigen::Index>(i)) = points.body[i];
    }
    fit.T_r_u.matrix() = Eigen::umeyama(own, body, false);
    fit.rms = std::sqrt((fit.T_r_u * own - body).colwise().squaredNorm().mean());
    return fit;
}

/// What a module of the given type would have to fit: its neighbours' ports, and its LED where it was seen.
PointPairs pointsOf(const BodySolution& solution, const AdjustmentInput& used, const Evidence& evidence, std::size_t u,
                    const ModuleTemplate& type) {
    PointPairs points;
    for (const std::size_t i : evidence.pairsOf[u]) {
        const PortPair& pair = used.links[i];
        const GraphLink& link = solution.layout.graph.links()[pair.link];
        const bool isA = pair.a == u;
        const auto& T_r_n = solution.solved.T_r_u[isA ? pair.b : pair.a];
        const auto port = static_cast<std::size_t>(link.a == u ? link.a_port : link.b_port);
        if (!T_r_n || port >= type.ports.size())
            continue;
        points.own.push_back(type.ports[port]);
        points.body.push_back(*T_r_n * (isA ? pair.port_b : pair.port_a));
    }
    const auto led = evidence.elsewhere[u] ? evidence.elsewhere[u] : triangulateLed(solution, used.pixels, u);
    if (led) {
        points.own.push_back(type.led);
        points.body.push_back(*led);
    }
    return points;
}

Finding explainModule(const BodySolution& solution, const AdjustmentInput& used, const Evidence& evidence,
                      std::size_t u, const SuspectOptions& options) {
    const Skin& skin = *solution.input.skin;
    const std::uint32_t id = skin.modules[u].id.value;
    Finding finding;
    finding.modules = {skin.modules[u].id};
    const RigidFit own = fitModule(pointsOf(solution, used, evidence, u, skin.templateOf(u)));
    for (const ModuleTemplate& type : skin.templates) {
        if (type.name == skin.templateOf(u).name)
            continue;
        const RigidFit other = fitModule(pointsOf(solution, used, evidence, u, type));
        if (other.rms < options.fits && other.rms < own.rms / 3) {
            finding.kind = Finding::Kind::WrongTemplate;
            finding.text = fmt::format(
                "module {}: it is no {} but a {}: its neighbours and its LED lie {:.1f} mm (rms) from where the one "
                "would "
                "have them, {:.1f} mm from the other",
                id, skin.templateOf(u).name, type.name, own.rms * 1e3, other.rms * 1e3);
            return finding;
        }
    }
    finding.kind = Finding::Kind::MovedModule;
    const Isometry3d& T_r_u = *solution.solved.T_r_u[u];
    if (own.rms < options.fits)
        finding.text = fmt::format(
            "module {}: it moved since gravity was read: its neighbours and its LED have it turned by {:.1f}° and "
            "moved "
            "by {:.1f} mm",
            id, rotationAngle(own.T_r_u.linear() * T_r_u.linear().transpose()) / kDegree,
            (own.T_r_u.translation() - T_r_u.translation()).norm() * 1e3);
    else if (evidence.elsewhere[u])
        finding.text = fmt::format(
            "module {}: the views see its LED {:.1f} mm from where gravity and links have it: it moved since gravity "
            "was "
            "read, or its links or its type are reported wrongly",
            id, (*evidence.elsewhere[u] - T_r_u * skin.templateOf(u).led).norm() * 1e3);
    else
        finding.text = fmt::format(
            "module {}: {} of its {} links disagree with the rest: it moved since gravity was read, or its type is "
            "reported wrongly",
            id, evidence.badPairsOf[u].size(), evidence.pairsOf[u].size());
    return finding;
}

void takeOutModule(BodySolution& solution, std::size_t u, Finding finding) {
    BodyEstimate& estimate = solution.estimate;
    for (std::size_t i = 0; i < solution.input.pixels.size(); ++i) {
        if (solution.input.pixels[i].module == u && estimate.setAside[i].empty())
            estimate.setAside[i] = "its module does not fit the rest";
    }
    solution.solved.T_r_u[u].reset();
    estimate.moduleTrouble[u] = finding.text;
    estimate.findings.push_back(std::move(finding));
}

/// Which ports of two modules come out at one place: not those that were reported.
std::optional<std::pair<std::size_t, std::size_t>> portsThatMeet(const BodySolution& solution, const GraphLink& link,
                                                                 double limit) {
    const Skin& skin = *solution.input.skin;
    const Isometry3d& T_r_a = *solution.solved.T_r_u[link.a];
    const Isometry3d& T_r_b = *solution.solved.T_r_u[link.b];
    std::optional<std::pair<std::size_t, std::size_t>> best;
    for (std::size_t p = 0; p < skin.templateOf(link.a).ports.size(); ++p) {
        for (std::size_t q = 0; q < skin.templateOf(link.b).ports.size(); ++q) {
            const double gap =
                (T_r_a * skin.templateOf(link.a).ports[p] - T_r_b * skin.templateOf(link.b).ports[q]).norm();
            if (gap < limit) {
                limit = gap;
                best = {p, q};
            }
        }
    }
    return best;
}

void takeOutLink(BodySolution& solution, std::size_t pair, double disagreement, LinkHistory& history,
                 const SuspectOptions& options) {
    const std::size_t l = solution.input.links[pair].link;
    const GraphLink& link = solution.layout.graph.links()[l];
    const Skin& skin = *solution.input.skin;
    const double gap = (*solution.solved.T_r_u[link.a] * skin.port(link.a, link.a_port) -
                        *solution.solved.T_r_u[link.b] * skin.port(link.b, link.b_port))
                           .norm();
    const std::uint32_t a = skin.modules[link.a].id.value;
    const std::uint32_t b = skin.modules[link.b].id.value;
    Finding finding;
    finding.kind = Finding::Kind::WrongLink;
    finding.modules = {skin.modules[link.a].id, skin.modules[link.b].id};
    const std::string reported =
        fmt::format("the link from module {} port {} to module {} port {}", a, link.a_port, b, link.b_port);
    if (const auto meet = portsThatMeet(solution, link, options.portsMeet)) {
        finding.text = fmt::format("{} is reported wrongly: ports {} and {} meet there, these are {:.1f} mm apart",
                                   reported, meet->first, meet->second, gap * 1e3);
    } else if (gap > options.farApart && !link.decided) {
        finding.text = fmt::format("{} is a cable: everything else has its ports {:.1f} mm apart", reported, gap * 1e3);
        history.refuted.resize(solution.layout.verdicts.size());
        history.refuted[l] = fmt::format("everything else that was measured has its ports {:.1f} mm apart", gap * 1e3);
    } else {
        finding.text = fmt::format("{} does not fit: everything else has its ports {:.1f} mm apart, {:.0f} sigma",
                                   reported, gap * 1e3, std::sqrt(disagreement));
    }
    solution.estimate.linkTrouble[l] = finding.text;
    solution.estimate.findings.push_back(std::move(finding));
}

}  // namespace

bool takeOutSuspects(BodySolution& solution, const AdjustmentInput& used, const SolutionReview& review,
                     LinkHistory& links, const SuspectOptions& options) {
    if (!options.validate())
        throw std::logic_error("SuspectOptions out of range");
    const Evidence evidence = gather(solution, used, review, options);
    const std::vector<Suspect> suspects = strongest(evidence, used);
    std::set<std::size_t> pairsOut;
    for (const Suspect& suspect : suspects) {
        if (suspect.module) {
            takeOutModule(solution, *suspect.module, explainModule(solution, used, evidence, *suspect.module, options));
            continue;
        }
        takeOutLink(solution, *suspect.pair, suspect.weight, links, options);
        pairsOut.insert(*suspect.pair);
    }
    // The pairs of `used` are those of the solution's own input, in the same order.
    std::vector<PortPair> left;
    for (std::size_t i = 0; i < solution.input.links.size(); ++i) {
        if (!pairsOut.contains(i))
            left.push_back(solution.input.links[i]);
    }
    solution.input.links = std::move(left);
    return !suspects.empty();
}

}  // namespace skincal
