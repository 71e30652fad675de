#include "core/estimation/candidate_selection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace skincal {
namespace {

using View = std::vector<std::size_t>;  // positions of one view's sightings

/// Support that one statement about the view's rotation finds among the sightings: small is good.
double disagreement(const std::vector<SightingCandidates>& sightings, const View& view,
                    const std::vector<std::optional<Matrix3d>>& R_g_o, const Matrix3d& R_v_g, double limit) {
    double cost = 0;
    for (const std::size_t s : view) {
        const auto& R = R_g_o[sightings[s].patch];
        if (!R)
            continue;
        double best = 1;
        for (const PatchPose& pose : sightings[s].poses) {
            const double angle = rotationAngle(pose.T_v_o.linear().transpose() * R_v_g * *R);
            // The cost of the picture counts a little, so that it decides where gravity does not.
            const double picture =
                0.05 * std::min(1.0, std::log(std::max(1.0, pose.cost / sightings[s].poses[0].cost)));
            best = std::min(best, std::min(1.0, angle * angle / (limit * limit)) + picture);
        }
        cost += best * static_cast<double>(sightings[s].poses[0].inlierCount());
    }
    return cost;
}

/// False where fewer than two patches of the view have a say.
bool selectByGravity(const std::vector<SightingCandidates>& sightings, const View& view,
                     const std::vector<std::optional<Matrix3d>>& R_g_o, const SelectionOptions& options,
                     std::vector<Selection>& selections) {
    double best = std::numeric_limits<double>::infinity();
    std::optional<Matrix3d> R_v_g;
    std::size_t voters = 0;
    for (const std::size_t s : view) {
        const auto& R = R_g_o[sightings[s].patch];
        if (!R)
            continue;
        ++voters;
        for (const PatchPose& pose : sightings[s].poses) {
            const Matrix3d statement = pose.T_v_o.linear() * R->transpose();
            const double cost = disagreement(sightings, view, R_g_o, statement, options.maxDisagreement_rad);
            if (cost < best) {
                best = cost;
                R_v_g = statement;
            }
        }
    }
    if (voters < 2 || !R_v_g)
        return false;
    for (const std::size_t s : view) {
        const auto& R = R_g_o[sightings[s].patch];
        if (!R)
            continue;
        double nearest = options.maxDisagreement_rad;
        selections[s] = {};
        for (std::size_t k = 0; k < sightings[s].poses.size(); ++k) {
            const double angle = rotationAngle(sightings[s].poses[k].T_v_o.linear().transpose() * *R_v_g * *R);
            if (angle < nearest) {
                nearest = angle;
                selections[s].candidate = k;
            }
        }
    }
    return true;
}

/// Votes of other views for the relative rotations that each candidate of an open sighting implies. Quadratic in the
/// views that show a pair of patches: not for sightings that gravity decides.
std::vector<std::vector<double>> votesAcrossViews(const std::vector<SightingCandidates>& sightings,
                                                  const std::map<std::size_t, View>& views,
                                                  const std::vector<bool>& open, double limit) {
    struct Statement {
        std::size_t view, sightingA, candidateA, sightingB, candidateB;
        Matrix3d R_a_b;
    };
    std::map<std::pair<std::size_t, std::size_t>, std::vector<Statement>> byPair;
    for (const auto& [v, view] : views) {
        for (const std::size_t a : view) {
            for (const std::size_t b : view) {
                if (sightings[a].patch >= sightings[b].patch)
                    continue;
                for (std::size_t i = 0; i < sightings[a].poses.size(); ++i) {
                    for (std::size_t k = 0; k < sightings[b].poses.size(); ++k)
                        byPair[{sightings[a].patch, sightings[b].patch}].push_back(
                            {v, a, i, b, k,
                             sightings[a].poses[i].T_v_o.linear().transpose() * sightings[b].poses[k].T_v_o.linear()});
                }
            }
        }
    }
    std::vector<std::vector<double>> votes(sightings.size());
    for (std::size_t s = 0; s < sightings.size(); ++s)
        votes[s].assign(sightings[s].poses.size(), 0);
    for (const auto& [pair, statements] : byPair) {
        for (const Statement& mine : statements) {
            if (!open[mine.sightingA] && !open[mine.sightingB])
                continue;
            std::map<std::size_t, double> support;  // the best of each other view counts once
            for (const Statement& other : statements) {
                if (other.view == mine.view)
                    continue;
                const double angle = rotationAngle(mine.R_a_b.transpose() * other.R_a_b);
                support[other.view] = std::max(support[other.view], 1 - std::min(1.0, angle / limit));
            }
            double sum = 0;
            for (const auto& [view, value] : support)
                sum += value;
            votes[mine.sightingA][mine.candidateA] = std::max(votes[mine.sightingA][mine.candidateA], sum);
            votes[mine.sightingB][mine.candidateB] = std::max(votes[mine.sightingB][mine.candidateB], sum);
        }
    }
    return votes;
}

}  // namespace

std::vector<Selection> selectCandidates(const std::vector<SightingCandidates>& sightings,
                                        const std::vector<std::optional<Matrix3d>>& R_g_o,
                                        const SelectionOptions& options) {
    if (!options.validate())
        throw std::logic_error("SelectionOptions out of range");
    std::map<std::size_t, View> views;
    for (std::size_t s = 0; s < sightings.size(); ++s) {
        if (!sightings[s].poses.empty())
            views[sightings[s].view].push_back(s);
    }
    std::vector<Selection> selections(sightings.size());
    std::vector<bool> open(sightings.size(), false);
    for (const auto& [v, view] : views) {
        if (!selectByGravity(sightings, view, R_g_o, options, selections)) {
            for (const std::size_t s : view)
                open[s] = true;
        }
        for (const std::size_t s : view)
            open[s] = open[s] || !R_g_o[sightings[s].patch];
    }
    const auto votes = votesAcrossViews(sightings, views, open, options.maxDisagreement_rad);
    for (std::size_t s = 0; s < sightings.size(); ++s) {
        const auto& poses = sightings[s].poses;
        if (poses.empty() || !open[s])
            continue;
        std::size_t best = 0;
        for (std::size_t k = 1; k < poses.size(); ++k) {
            if (votes[s][k] > votes[s][best] + 0.25)
                best = k;
        }
        selections[s].candidate = best;
        for (std::size_t k = 0; k < poses.size(); ++k) {
            if (k == best || votes[s][k] <= votes[s][best] - 0.25)
                continue;
            selections[s].rivals.push_back(k);
            if (poses[k].cost < options.decisiveCostRatio * poses[best].cost + 1e-12)
                selections[s].undecided = true;
        }
    }
    return selections;
}

}  // namespace skincal
