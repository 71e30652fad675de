#include "core/estimation/wrong_links.h"

namespace skincal {

Sentence inWords(const Skin& skin, const GraphLink& link) {
    return Sentence::saying("the link from module {} port {} to module {} port {}", skin.modules[link.a].id.value,
                            link.a_port, skin.modules[link.b].id.value, link.b_port);
}

Sentence reportedWrongly(const BodySolution& solution, const GraphLink& link,
                         const std::pair<std::size_t, std::size_t>& meet) {
    return Sentence::saying("{} is reported wrongly: ports {} and {} meet there, these are {:.1f} mm apart",
                            inWords(*solution.input.skin, link), meet.first, meet.second, gapOf(solution, link) * 1e3);
}

std::optional<std::pair<std::size_t, std::size_t>> portsThatMeet(const BodySolution& solution, const GraphLink& link,
                                                                 double limit) {
    const Skin& skin = *solution.input.skin;
    const Isometry3d& T_r_a = *solution.solved.T_r_u[link.a];
    const Isometry3d& T_r_b = *solution.solved.T_r_u[link.b];
    const auto& portsOfA = skin.templateOf(link.a).ports;
    const auto& portsOfB = skin.templateOf(link.b).ports;
    std::optional<std::pair<std::size_t, std::size_t>> best;
    for (std::size_t p = 0; p < portsOfA.size(); ++p) {
        for (std::size_t q = 0; q < portsOfB.size(); ++q) {
            const double gap = (T_r_a * portsOfA[p] - T_r_b * portsOfB[q]).norm();
            if (gap < limit) {
                limit = gap;
                best = {p, q};
            }
        }
    }
    return best;
}

double gapOf(const BodySolution& solution, const GraphLink& link) {
    const Skin& skin = *solution.input.skin;
    return (*solution.solved.T_r_u[link.a] * skin.port(link.a, link.a_port) -
            *solution.solved.T_r_u[link.b] * skin.port(link.b, link.b_port))
        .norm();
}

void nameMisportedLinks(BodySolution& solution, double limit) {
    const Skin& skin = *solution.input.skin;
    BodyEstimate& estimate = solution.estimate;
    for (std::size_t l = 0; l < solution.layout.verdicts.size(); ++l) {
        const GraphLink& link = solution.layout.graph.links()[l];
        if (solution.layout.verdicts[l].kind != LinkKind::Cable || link.decided || link.a == link.b ||
            !link.issues.empty() || !estimate.linkTrouble[l].empty() || !solution.solved.T_r_u[link.a] ||
            !solution.solved.T_r_u[link.b])
            continue;
        const auto meet = portsThatMeet(solution, link, limit);
        if (!meet || *meet == std::pair(static_cast<std::size_t>(link.a_port), static_cast<std::size_t>(link.b_port)))
            continue;
        Finding finding;
        finding.kind = Finding::Kind::WrongLink;
        finding.modules = {skin.modules[link.a].id, skin.modules[link.b].id};
        finding.text = reportedWrongly(solution, link, *meet);
        estimate.linkTrouble[l] = finding.text;
        estimate.findings.push_back(std::move(finding));
    }
}

}  // namespace skincal
