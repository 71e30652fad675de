#include "core/estimation/suspects.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "core/estimation/led_triangulation.h"
#include "core/estimation/module_fit.h"
#include "core/estimation/wrong_links.h"

namespace skincal {
namespace {

/// What speaks against one module.
struct ModuleEvidence {
    std::vector<std::size_t> pairs;  ///< its links that count, by position in the input of the adjustment
    std::size_t doubtful = 0;        ///< of these
    std::size_t takenOut = 0;        ///< links that were taken out before
    std::size_t allLinks = 0;
    std::size_t turnedLinks = 0;  ///< taken for cables because of how the module is turned
    double badness = 0;           ///< disagreement of the doubtful ones together
    std::optional<Vector3d> seenElsewhere;
};

struct BadLink {
    std::size_t pair = 0;  ///< position in the input of the adjustment
    double disagreement = 0;
};

struct Evidence {
    std::vector<ModuleEvidence> modules;
    std::vector<BadLink> badLinks;
};

struct Suspect {
    double weight = 0;  ///< how strongly the rest contradicts it, chi-squared
    std::optional<std::size_t> module{};
    std::optional<std::size_t> pair{};
};

Evidence gather(const BodySolution& solution, const AdjustmentInput& used, const SolutionReview& review,
                const SuspectOptions& options) {
    Evidence evidence;
    evidence.modules.resize(solution.solved.T_r_u.size());
    for (std::size_t i = 0; i < used.links.size(); ++i) {
        if (!review.links[i])
            continue;
        const double disagreement = review.links[i]->disagreement;
        if (disagreement > options.linkDisagreement)
            evidence.badLinks.push_back({i, disagreement});
        for (const std::size_t end : {used.links[i].a, used.links[i].b}) {
            ModuleEvidence& module = evidence.modules[end];
            module.pairs.push_back(i);
            if (disagreement > options.doubtfulLink) {
                ++module.doubtful;
                module.badness += disagreement;
            }
        }
    }
    const auto& links = solution.layout.graph.links();
    for (std::size_t l = 0; l < links.size(); ++l) {
        const LinkReason reason = solution.layout.verdicts[l].reason;
        const bool placed = solution.solved.T_r_u[links[l].a] && solution.solved.T_r_u[links[l].b];
        // Too far apart for neighbours, too near for a cable: one of the modules is not where it was.
        const bool torn = reason == LinkReason::Gap && placed && gapOf(solution, links[l]) < options.farApart;
        for (const std::size_t end : {links[l].a, links[l].b}) {
            ++evidence.modules[end].allLinks;
            evidence.modules[end].turnedLinks += reason == LinkReason::Twist || reason == LinkReason::Bend ? 1 : 0;
            evidence.modules[end].takenOut += torn || !solution.estimate.linkTrouble[l].empty() ? 1 : 0;
        }
    }
    const auto elsewhere = ledsSeenElsewhere(solution);
    for (std::size_t u = 0; u < elsewhere.size(); ++u)
        evidence.modules[u].seenElsewhere = elsewhere[u];
    return evidence;
}

/// Where the views have the LED, whether their detections count or not.
std::optional<Vector3d> ledOf(const BodySolution& solution, const AdjustmentInput& used, const Evidence& evidence,
                              std::size_t u) {
    return evidence.modules[u].seenElsewhere ? evidence.modules[u].seenElsewhere
                                             : triangulateLed(solution, used.pixels, u);
}

std::optional<Suspect> suspectModule(const BodySolution& solution, const AdjustmentInput& used,
                                     const Evidence& evidence, std::size_t u, const SuspectOptions& options) {
    constexpr double kSeenElsewhere = 100;  // as much as a link that is ten standard deviations off
    const ModuleEvidence& own = evidence.modules[u];
    if (!solution.solved.T_r_u[u])
        return std::nullopt;
    if (own.seenElsewhere)
        return Suspect{own.badness + kSeenElsewhere, u, std::nullopt};
    const std::size_t against = own.doubtful + own.takenOut;
    const bool together = against >= 2 && 2 * against >= own.pairs.size() + own.takenOut;
    if (together && (own.takenOut >= 2 || own.badness > options.linkDisagreement))
        return Suspect{own.badness, u, std::nullopt};
    const bool turned = own.turnedLinks > 0 && own.turnedLinks == own.allLinks;
    if (turned && otherTemplate(solution, u, ledOf(solution, used, evidence, u), options.fits))
        return Suspect{kSeenElsewhere, u, std::nullopt};
    return std::nullopt;
}

/// The strongest suspects, none of which another one's error could have brought in: those that share a link with a
/// stronger one wait for the next round.
std::vector<Suspect> strongest(const BodySolution& solution, const AdjustmentInput& used, const Evidence& evidence,
                               const SuspectOptions& options) {
    std::vector<Suspect> all;
    for (std::size_t u = 0; u < evidence.modules.size(); ++u) {
        if (const auto suspect = suspectModule(solution, used, evidence, u, options))
            all.push_back(*suspect);
    }
    for (const BadLink& link : evidence.badLinks)
        all.push_back({link.disagreement, std::nullopt, link.pair});
    std::stable_sort(all.begin(), all.end(), [](const Suspect& x, const Suspect& y) { return x.weight > y.weight; });
    std::vector<Suspect> chosen;
    std::set<std::size_t> touched;
    for (const Suspect& suspect : all) {
        std::vector<std::size_t> ends;
        if (suspect.pair)
            ends = {used.links[*suspect.pair].a, used.links[*suspect.pair].b};
        else
            ends = {*suspect.module};
        if (std::any_of(ends.begin(), ends.end(), [&](std::size_t u) { return touched.contains(u); }))
            continue;
        for (const std::size_t u : ends) {
            touched.insert(u);
            for (const std::size_t i : evidence.modules[u].pairs)
                touched.insert({used.links[i].a, used.links[i].b});
        }
        chosen.push_back(suspect);
    }
    return chosen;
}

Finding explainModule(const BodySolution& solution, const AdjustmentInput& used, const Evidence& evidence,
                      std::size_t u, const SuspectOptions& options) {
    const Skin& skin = *solution.input.skin;
    const ModuleEvidence& own = evidence.modules[u];
    const std::uint32_t id = skin.modules[u].id.value;
    const auto led = ledOf(solution, used, evidence, u);
    Finding finding;
    finding.modules = {skin.modules[u].id};
    if (const auto other = otherTemplate(solution, u, led, options.fits)) {
        finding.kind = Finding::Kind::WrongTemplate;
        finding.text = Sentence::saying(
            "module {}: it is no {} but a {}: its neighbours and its LED lie {:.1f} mm (rms) from where the one would "
            "have them, {:.1f} mm from the other",
            id, skin.templateOf(u).name, other->type->name, other->ownRms * 1e3, other->rms * 1e3);
        return finding;
    }
    finding.kind = Finding::Kind::MovedModule;
    const Isometry3d& T_r_u = *solution.solved.T_r_u[u];
    const auto fit = fitModule(solution, u, skin.templateOf(u), led);
    if (fit && fit->rms < options.fits)
        finding.text = Sentence::saying(
            "module {}: it moved since gravity was read: its neighbours and its LED have it turned by {:.1f}° and "
            "moved "
            "by {:.1f} mm",
            id, rotationAngle(fit->T_r_u.linear() * T_r_u.linear().transpose()) / kDegree,
            (fit->T_r_u.translation() - T_r_u.translation()).norm() * 1e3);
    else if (own.seenElsewhere)
        finding.text = Sentence::saying(
            "module {}: the views see its LED {:.1f} mm from where gravity and links have it: it moved since gravity "
            "was "
            "read, or its links or its type are reported wrongly",
            id, (*own.seenElsewhere - T_r_u * skin.templateOf(u).led).norm() * 1e3);
    else
        finding.text = Sentence::saying(
            "module {}: {} of its {} links disagree with the rest: it moved since gravity was read, or its type is "
            "reported wrongly",
            id, own.doubtful + own.takenOut, own.pairs.size() + own.takenOut);
    return finding;
}

void takeOutModule(BodySolution& solution, std::size_t u, Finding finding) {
    BodyEstimate& estimate = solution.estimate;
    // Links that were blamed before: it was this end of them.
    std::erase_if(estimate.findings, [&](const Finding& earlier) {
        return earlier.kind == Finding::Kind::WrongLink &&
               std::count(earlier.modules.begin(), earlier.modules.end(), finding.modules.front()) > 0;
    });
    for (std::size_t i = 0; i < solution.input.pixels.size(); ++i) {
        if (solution.input.pixels[i].module == u && estimate.setAside[i].empty())
            estimate.setAside[i] = Sentence::saying("its module does not fit the rest");
    }
    solution.solved.T_r_u[u].reset();
    estimate.moduleTrouble[u] = finding.text;
    estimate.findings.push_back(std::move(finding));
}

void takeOutLink(BodySolution& solution, std::size_t l, double disagreement, SolutionHistory& history,
                 const SuspectOptions& options) {
    const GraphLink& link = solution.layout.graph.links()[l];
    const Skin& skin = *solution.input.skin;
    const double gap = gapOf(solution, link) * 1e3;
    const Sentence reported = inWords(skin, link);
    Finding finding;
    finding.kind = Finding::Kind::WrongLink;
    finding.modules = {skin.modules[link.a].id, skin.modules[link.b].id};
    if (const auto meet = portsThatMeet(solution, link, options.portsMeet)) {
        finding.text = reportedWrongly(solution, link, *meet);
    } else if (gap > options.farApart * 1e3 && !link.decided) {
        finding.text = Sentence::saying("{} is a cable: everything else has its ports {:.1f} mm apart", reported, gap);
        history.refuted.resize(solution.layout.verdicts.size());
        history.refuted[l] = Sentence::saying("everything else that was measured has its ports {:.1f} mm apart", gap);
    } else {
        finding.text = Sentence::saying("{} does not fit: everything else has its ports {:.1f} mm apart, {:.0f} sigma",
                                        reported, gap, std::sqrt(disagreement));
    }
    solution.estimate.linkTrouble[l] = finding.text;
    solution.estimate.findings.push_back(std::move(finding));
}

}  // namespace

bool takeOutSuspects(BodySolution& solution, const AdjustmentInput& used, const SolutionReview& review,
                     SolutionHistory& history, const SuspectOptions& options) {
    if (!options.validate())
        throw std::logic_error("SuspectOptions out of range");
    const Evidence evidence = gather(solution, used, review, options);
    const std::vector<Suspect> suspects = strongest(solution, used, evidence, options);
    std::set<std::size_t> linksOut;
    for (const Suspect& suspect : suspects) {
        if (suspect.module) {
            takeOutModule(solution, *suspect.module, explainModule(solution, used, evidence, *suspect.module, options));
        } else {
            linksOut.insert(used.links[*suspect.pair].link);
            takeOutLink(solution, used.links[*suspect.pair].link, suspect.weight, history, options);
        }
    }
    std::erase_if(solution.input.links, [&](const PortPair& pair) { return linksOut.contains(pair.link); });
    return !suspects.empty();
}

}  // namespace skincal
