#include "core/skin/cable_detection.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace skincal {
namespace {

constexpr double kPi = 180 * kDegree;

LinkVerdict cable(LinkReason reason, Sentence explanation) {
    return {LinkKind::Cable, reason, std::move(explanation), std::nullopt, std::nullopt};
}

/// What one link says for itself, leaving aside which others claim its ports.
LinkVerdict judgeAlone(const Skin& skin, const GraphLink& link, const CableEvidence& evidence, std::size_t l,
                       const CableOptions& options) {
    const auto& R_a_b = evidence.R_a_b[l];
    const auto& rotationResidual = evidence.rotationResidual[l];
    const auto& separation = evidence.separation[l];
    const auto& gap = evidence.gap[l];
    if (link.a == link.b)
        return cable(LinkReason::SelfLink, Sentence::saying("both ends are at the same module"));
    if (link.has(LinkIssue::HostPort))
        return cable(LinkReason::ComputerPort, Sentence::saying("its port is the one that is wired to the computer"));
    LinkVerdict verdict;
    if (R_a_b) {
        const Matrix3d flat = flatNeighbourRotation(skin.port(link.a, link.a_port), skin.port(link.b, link.b_port));
        const BendAndTwist found = bendAndTwist(*R_a_b, flat);
        verdict.bend = found.bend;
        verdict.twist = found.twist;
        if (found.bend > options.maxBend) {
            verdict.kind = LinkKind::Cable;
            verdict.reason = LinkReason::Bend;
            verdict.explanation = Sentence::saying("the modules are folded by {:.0f}°, neighbours by {:.0f}° at most",
                                                   found.bend / kDegree, options.maxBend / kDegree);
            return verdict;
        }
        if (found.twist > options.maxTwist) {
            verdict.kind = LinkKind::Cable;
            verdict.reason = LinkReason::Twist;
            verdict.explanation = Sentence::saying(
                "the modules are turned by {:.0f}° in the plane of the skin, neighbours by {:.0f}° at most",
                found.twist / kDegree, options.maxTwist / kDegree);
            return verdict;
        }
    }
    if (R_a_b && rotationResidual && *rotationResidual > options.maxRotationResidual) {
        verdict.kind = LinkKind::Cable;
        verdict.reason = LinkReason::Movement;
        verdict.explanation = Sentence::saying(
            "the modules turned against each other between the poses: their readings differ by {:.1f} m/s², those of "
            "neighbours by {:.1f} at most",
            *rotationResidual, options.maxRotationResidual);
        return verdict;
    }
    if (!evidence.refuted[l].empty()) {
        verdict.kind = LinkKind::Cable;
        verdict.reason = LinkReason::Refuted;
        verdict.explanation = evidence.refuted[l];
        return verdict;
    }
    if (gap && *gap > options.maxGap) {
        verdict.kind = LinkKind::Cable;
        verdict.reason = LinkReason::Gap;
        verdict.explanation =
            Sentence::saying("taken for neighbours, their ports came out {:.1f} mm apart, {:.1f} at most", *gap * 1e3,
                             options.maxGap * 1e3);
        return verdict;
    }
    // Where the two ports did meet, they did not by chance.
    if (!gap && separation && *separation > options.maxSeparation) {
        verdict.kind = LinkKind::Cable;
        verdict.reason = LinkReason::Separation;
        verdict.explanation = Sentence::saying(
            "in the pictures the LEDs are {:.1f} times as far apart as those of neighbours, {:.1f} at most",
            *separation, options.maxSeparation);
        return verdict;
    }
    verdict.explanation = verdict.bend ? Sentence::saying("bend {:.1f}°, twist {:.1f}°: as neighbours have",
                                                          *verdict.bend / kDegree, *verdict.twist / kDegree)
                                       : Sentence::saying("nothing measured contradicts neighbours");
    return verdict;
}

/// What to say of a link that lost one of its ports to another, or to nobody.
enum class Contest { Won, LostToOperator, LostToRotation, Undecided };

/// Of several links at one port at most one is real: the one that the operator named, else the only one whose rotation
/// was measured and is one of neighbours. What nobody measured is not believed against another claim.
void settleContradictions(const SkinGraph& graph, std::vector<LinkVerdict>& verdicts) {
    const auto& links = graph.links();
    std::map<std::pair<std::size_t, int>, std::vector<std::size_t>> claims;
    for (std::size_t l = 0; l < verdicts.size(); ++l) {
        // A link that the operator called a cable contests nothing any more: that word settles it.
        if (!links[l].has(LinkIssue::Contradictory) || links[l].decided == LinkKind::Cable)
            continue;
        claims[{links[l].a, links[l].a_port}].push_back(l);
        claims[{links[l].b, links[l].b_port}].push_back(l);
    }
    const auto named = [&](std::size_t l) {
        return verdicts[l].kind == LinkKind::Adjacent && verdicts[l].reason == LinkReason::OperatorsWord;
    };
    const auto fits = [&](std::size_t l) { return verdicts[l].kind == LinkKind::Adjacent && verdicts[l].bend; };
    std::vector<Contest> outcome(verdicts.size(), Contest::Won);
    for (const auto& [port, claimants] : claims) {
        if (claimants.size() < 2)
            continue;
        const bool operatorNamed = std::any_of(claimants.begin(), claimants.end(), named);
        const bool oneFits = std::count_if(claimants.begin(), claimants.end(), fits) == 1;
        for (const std::size_t l : claimants) {
            if (named(l) || (!operatorNamed && oneFits && fits(l)))
                continue;
            outcome[l] = operatorNamed ? Contest::LostToOperator
                         : oneFits     ? Contest::LostToRotation
                                       : Contest::Undecided;
        }
    }
    for (std::size_t l = 0; l < verdicts.size(); ++l) {
        if (outcome[l] == Contest::Won || verdicts[l].kind == LinkKind::Cable)
            continue;
        verdicts[l].kind = LinkKind::Cable;
        verdicts[l].reason = LinkReason::Contradictory;
        verdicts[l].explanation =
            outcome[l] == Contest::LostToOperator
                ? Sentence::saying("another link claims the same port, and the operator called that one a neighbour")
            : outcome[l] == Contest::LostToRotation
                ? Sentence::saying("another link claims the same port, and its measured rotation fits neighbours")
                : Sentence::saying(
                      "several links claim the same port and nothing tells which of them is real: none is believed");
    }
}

}  // namespace

bool CableOptions::validate() const {
    return maxBend > 0 && maxBend <= kPi && maxTwist > 0 && maxTwist <= kPi && maxRotationResidual > 0 &&
           maxSeparation > 1 && maxGap > 0;
}

Matrix3d flatNeighbourRotation(const Vector3d& port_a, const Vector3d& port_b) {
    const double azimuth = std::atan2(port_a.y(), port_a.x()) + kPi - std::atan2(port_b.y(), port_b.x());
    return Eigen::AngleAxisd(azimuth, Vector3d::UnitZ()).toRotationMatrix();
}

BendAndTwist bendAndTwist(const Matrix3d& R_a_b, const Matrix3d& flat) {
    const Matrix3d D = R_a_b * flat.transpose();
    BendAndTwist result;
    result.bend = std::acos(std::clamp(D(2, 2), -1.0, 1.0));
    // Swing-twist: the quaternion's part along z, with its scalar part, is the twist.
    const Quaterniond q(D);
    result.twist = 2 * std::atan2(std::abs(q.z()), std::abs(q.w()));
    return result;
}

std::vector<LinkVerdict> detectCables(const Skin& skin, const SkinGraph& graph, const CableEvidence& evidence,
                                      const CableOptions& options) {
    const auto& links = graph.links();
    if (!options.validate())
        throw std::logic_error("CableOptions out of range");
    if (evidence.R_a_b.size() != links.size() || evidence.rotationResidual.size() != links.size() ||
        evidence.separation.size() != links.size() || evidence.gap.size() != links.size() ||
        evidence.refuted.size() != links.size())
        throw std::logic_error("detectCables: evidence and graph differ in size");
    std::vector<LinkVerdict> verdicts;
    verdicts.reserve(links.size());
    for (std::size_t l = 0; l < links.size(); ++l) {
        LinkVerdict verdict = judgeAlone(skin, links[l], evidence, l, options);
        // A module can't be its own neighbour, whatever anybody says.
        if (links[l].decided && links[l].a != links[l].b) {
            verdict.kind = *links[l].decided;
            verdict.reason = LinkReason::OperatorsWord;
            verdict.explanation = Sentence::saying("the operator said so");
        }
        verdicts.push_back(std::move(verdict));
    }
    settleContradictions(graph, verdicts);
    return verdicts;
}

}  // namespace skincal
