#include "core/estimation/view_hypotheses.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace skincal {
namespace {

/// Differences below this (in log likelihood) leave the choice open. By the model, odds of e^6 would do; but links
/// count as independent where the play of a module moves all its ports, and the shapes so derived are trusted too much:
/// in 600 worlds of a flat patch of seven at 1.4 m the wrong place was likelier by up to 12.8.
constexpr double kDecisive = 14;
/// And from here on it is settled without solving the other with weights of its own.
constexpr double kSettled = 150;
/// By how much pixels count less (as standard deviations) while a view is on its way to another place.
constexpr double kLoose = 30;
constexpr double kAll = std::numeric_limits<double>::infinity();
/// Nearer places are one: adjusting has led back to where the view stands.
constexpr double kSamePlace_rad = 1 * kDegree;

/// Views that see one patch, to be turned over together.
struct Hypothesis {
    std::size_t patch = 0;
    std::vector<std::size_t> views;
    bool isReversed = false;  ///< and what bulges is hollow
};

std::vector<Hypothesis> hypothesesOf(const BodySolution& solution) {
    std::map<std::size_t, std::set<std::size_t>> viewsOf;
    for (const ViewAlternative& alternative : solution.alternatives) {
        if (solution.solved.T_r_v[alternative.view])
            viewsOf[alternative.patch].insert(alternative.view);
    }
    std::vector<Hypothesis> hypotheses;
    for (const auto& [patch, views] : viewsOf) {
        for (const std::size_t v : views)
            hypotheses.push_back({patch, {v}});
        hypotheses.push_back({patch, {views.begin(), views.end()}, true});
    }
    return hypotheses;
}

struct Plane {
    Vector3d centre = Vector3d::Zero();
    Vector3d normal = Vector3d::UnitZ();

    [[nodiscard]] Matrix3d reflection() const { return Matrix3d::Identity() - 2 * normal * normal.transpose(); }
};

/// The plane that a patch's modules come nearest to; nothing where fewer than three are placed.
std::optional<Plane> planeOf(const BodySolution& solution, std::size_t patch) {
    Eigen::Matrix3Xd points(3, 0);
    for (const std::size_t u : solution.layout.patches[patch].modules) {
        if (const auto& T = solution.solved.T_r_u[u]) {
            points.conservativeResize(Eigen::NoChange, points.cols() + 1);
            points.rightCols<1>() = T->translation();
        }
    }
    if (points.cols() < 3)
        return std::nullopt;
    const Vector3d centre = points.rowwise().mean();
    const Matrix3d scatter = (points.colwise() - centre) * (points.colwise() - centre).transpose();
    return Plane{centre, Eigen::SelfAdjointEigenSolver<Matrix3d>(scatter).eigenvectors().col(0)};
}

/// The other place from which what is flat looks the same, but for perspective: with M_x the reflection at a plane
/// through the patch's centre, d along the line of sight and n the patch's normal, the patch turns by M_d M_n before
/// the camera. Ref: Oberkampf, DeMenthon, Davis, Iterative pose estimation using coplanar feature points, CVIU 1996.
Isometry3d turnedOver(const Isometry3d& T_r_v, const Plane& patch_r) {
    const Plane sight{patch_r.centre, (patch_r.centre - T_r_v.translation()).normalized()};
    const Matrix3d Q = sight.reflection() * patch_r.reflection();
    const Isometry3d turn = makeIsometry(Q, patch_r.centre - Q * patch_r.centre);
    return turn.inverse() * T_r_v;
}

void apply(const Hypothesis& hypothesis, const Plane& plane, BodySolution& solution) {
    for (const std::size_t v : hypothesis.views)
        solution.solved.T_r_v[v] = turnedOver(*solution.solved.T_r_v[v], plane);
    if (!hypothesis.isReversed)
        return;
    for (const std::size_t u : solution.layout.patches[hypothesis.patch].modules) {
        if (auto& T = solution.solved.T_r_u[u])
            T->translation() = plane.centre + plane.reflection() * (T->translation() - plane.centre);
    }
}

Gauge heldByAModule(const BodyState& state) {
    const auto first =
        std::find_if(state.T_r_u.begin(), state.T_r_u.end(), [](const auto& T) { return T.has_value(); });
    return first == state.T_r_u.end() ? Gauge{} : Gauge{{}, {static_cast<std::size_t>(first - state.T_r_u.begin())}};
}

struct Weighed {
    BodySolution solution;
    double cost = 0;      ///< 1/2 sum r^T r / sigma^2
    double surprise = 0;  ///< -log L
};

/// Sum of n log sigma over all measurements and priors.
double logSigmas(const BodySolution& solution, const AdjustmentInput& used) {
    const AdjustmentOptions& weights = solution.weights;
    double sum = 3 * static_cast<double>(used.links.size()) * std::log(weights.linkSigma);
    for (const PixelObservation& o : solution.input.pixels)
        sum += 2 * std::log(used.sigmaOf(o, weights));
    for (std::size_t u = 0; u < solution.solved.T_r_u.size(); ++u) {
        if (!solution.solved.T_r_u[u])
            continue;
        for (const GravityTable::Entry& reading : used.gravity->of(u))
            sum += 3 * std::log(used.sigmaOf(u, reading, weights));
        sum += 3 * std::log(weights.biasSigma) + 3 * std::log(weights.scaleSigma);
    }
    return sum;
}

tl::expected<Weighed, CalibrationError> weigh(BodySolution solution, const RefinementOptions& options,
                                              const RunContext& context) {
    const AdjustmentInput used = usedMeasurements(solution);
    auto adjusted = adjustBody(used, solution.solved, heldByAModule(solution.solved), solution.weights, context);
    if (!adjusted)
        return tl::unexpected(adjusted.error());
    const double limit = options.rejectionSigmas;
    const auto rejected = static_cast<double>(solution.input.pixels.size() - used.pixels.size());
    solution.solved = std::move(adjusted->state);
    const double cost = adjusted->summary.finalCost + 0.5 * limit * limit * rejected;
    const double surprise = cost + logSigmas(solution, used);
    return Weighed{std::move(solution), cost, surprise};
}

/// By how much any of the views is turned against another solution, seen from the body.
double turnedBy(const BodySolution& solution, const std::vector<std::size_t>& views, const BodySolution& against) {
    double turned = 0;
    for (const std::size_t v : views)
        turned = std::max(
            turned, rotationAngle(against.solved.T_r_v[v]->linear().transpose() * solution.solved.T_r_v[v]->linear()));
    return turned;
}

/// The solution that has its views elsewhere, with weights of its own; nothing where it has led back, failed, or is far
/// from likely.
tl::expected<std::optional<Weighed>, CalibrationError> solveElsewhere(const Weighed& standing,
                                                                      const Hypothesis& hypothesis,
                                                                      const RefinementOptions& options,
                                                                      const RunContext& context) {
    const auto unlessCancelled = [](const CalibrationError& error) {
        using Result = tl::expected<std::optional<Weighed>, CalibrationError>;
        return error.code == ErrorCode::Cancelled ? Result(tl::unexpected(error)) : Result(std::nullopt);
    };
    const auto plane = planeOf(standing.solution, hypothesis.patch);
    if (!plane)
        return std::nullopt;
    BodySolution other = standing.solution;
    apply(hypothesis, *plane, other);
    // Gravity and links first: pixels would have the shape that has bent to them fall back to where the views stood.
    // And what does not fit the one solution may well fit the other.
    const AdjustmentOptions weights = other.weights;
    other.weights.pixelSigmaFactor *= kLoose;
    rejectFarDetections(other, kAll);
    auto begun = adjustBody(usedMeasurements(other), std::move(other.solved), heldByAModule(standing.solution.solved),
                            other.weights, context);
    if (!begun)
        return unlessCancelled(begun.error());
    other.solved = std::move(begun->state);
    rejectFarDetections(other, options.rejectionSigmas);
    other.weights = weights;
    auto result = weigh(std::move(other), options, context);
    if (!result)
        return unlessCancelled(result.error());
    if (turnedBy(result->solution, hypothesis.views, standing.solution) < kSamePlace_rad ||
        result->cost > standing.cost + kSettled)
        return std::nullopt;
    const auto refined = refineJointly(result->solution, options, context);
    if (!refined)
        return unlessCancelled(refined.error());
    result = weigh(std::move(result->solution), options, context);
    if (!result)
        return unlessCancelled(result.error());
    return std::optional<Weighed>(*std::move(result));
}

}  // namespace

tl::expected<bool, CalibrationError> settleViewsByLikelihood(BodySolution& solution, const RefinementOptions& options,
                                                             const RunContext& context) {
    auto best = weigh(solution, options, context);
    if (!best && best.error().code == ErrorCode::Cancelled)
        return tl::unexpected(best.error());
    if (!best)
        return false;
    std::vector<std::size_t> open;
    for (const ViewAlternative& alternative : solution.alternatives) {
        if (solution.solved.T_r_v[alternative.view])
            open.push_back(alternative.view);
    }
    bool changed = turnedBy(best->solution, open, solution) > kSamePlace_rad;
    std::set<std::size_t> undecided;
    std::vector<BodyState> rivals;
    // Every move is to a likelier solution: it comes to an end, and this is for rounding that might go in circles.
    const std::size_t mostRounds = 4 * (1 + hypothesesOf(best->solution).size());
    bool moved = true;
    for (std::size_t round = 0; moved && round < mostRounds; ++round) {
        moved = false;
        undecided.clear();
        rivals.clear();
        for (const Hypothesis& hypothesis : hypothesesOf(best->solution)) {
            auto other = solveElsewhere(*best, hypothesis, options, context);
            if (!other)
                return tl::unexpected(other.error());
            if (!*other)
                continue;
            const double more = (*other)->surprise - best->surprise;
            if (std::abs(more) < kDecisive)
                undecided.insert(hypothesis.views.begin(), hypothesis.views.end());
            if (more >= 0 && more < kDecisive)
                rivals.push_back((*other)->solution.solved);
            if (more >= 0)
                continue;
            best = *std::move(*other);
            changed = moved = true;
            break;  // what was tried so far was tried against another solution
        }
    }
    if (moved)
        undecided.insert(open.begin(), open.end());
    if (changed)
        solution = std::move(best->solution);
    solution.estimate.undecidedViews.assign(undecided.begin(), undecided.end());
    solution.rivals = std::move(rivals);
    return changed;
}

}  // namespace skincal
