#include "core/study/accuracy_study.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "core/estimation/compare.h"
#include "core/estimation/joint_method.h"
#include "core/geometry/random.h"
#include "core/study/random_world.h"
#include "core/study/study_world.h"

namespace skincal {
namespace {

using OptionalPoses = std::vector<std::optional<Isometry3d>>;

std::optional<PoseAccuracy> accuracyOf(const Skin& skin, const OptionalPoses& found, const KnownTruth& truth,
                                       const std::vector<bool>& compared) {
    std::vector<NamedPose> estimated;
    std::vector<NamedPose> real;
    for (std::size_t u = 0; u < found.size(); ++u) {
        real.push_back({skin.modules[u].id, truth.T_r_u[u]});
        if (compared[u])
            estimated.push_back({skin.modules[u].id, *found[u]});
    }
    const auto difference = compareBodies(estimated, real);
    return difference ? std::optional(PoseAccuracy{difference->positionRms, difference->rotationRms}) : std::nullopt;
}

void compareEstimates(const Measurements& measurements, const KnownTruth& truth, const BodyModel& body,
                      const TruthEstimate& best, WorldAccuracy& result) {
    OptionalPoses found;
    std::vector<bool> both;
    for (std::size_t u = 0; u < body.modules.size(); ++u) {
        found.push_back(body.modules[u].T_body_module);
        const bool placeable = best.state.T_r_u[u].has_value();
        both.push_back(found[u] && placeable);
        result.placed += found[u] ? 1U : 0U;
        result.placeable += placeable ? 1U : 0U;
        result.missed += placeable && !found[u] ? 1U : 0U;
    }
    result.fromData = accuracyOf(measurements.skin, found, truth, both);
    result.fromTruth = accuracyOf(measurements.skin, best.state.T_r_u, truth, both);
    // A single module is always where it should be, once aligned.
    if (result.fromData && result.fromTruth && result.fromTruth->positionRms > 0)
        result.ratio = result.fromData->positionRms / result.fromTruth->positionRms;
}

using OptionalCovariances = std::vector<std::optional<Matrix6d>>;

std::optional<Consistency> consistencyOf(const OptionalPoses& found, const std::vector<Isometry3d>& real,
                                         const OptionalCovariances& covariances, std::uint64_t seed) {
    std::vector<double> nees;
    Consistency result;
    for (std::size_t u = 0; u < found.size(); ++u) {
        if (!found[u] || !covariances[u])
            continue;
        const Matrix6d& C = *covariances[u];
        Vector6d e;
        e << so3Log(found[u]->linear() * real[u].linear().transpose()), found[u]->translation() - real[u].translation();
        nees.push_back(e.dot(C.ldlt().solve(e)));
        const double sigmas = e.cwiseQuotient(C.diagonal().cwiseSqrt()).cwiseAbs().maxCoeff();
        result.largestSigmas = std::max(result.largestSigmas, sigmas);
        result.beyondFive += sigmas > 5 ? 1U : 0U;
    }
    if (nees.empty())
        return std::nullopt;
    result.modules = nees.size();
    for (const double value : nees)
        result.meanNees += value / static_cast<double>(nees.size());
    Random draw(seed, "consistency");
    result.drawnNees = nees[draw.index(nees.size())];
    return result;
}

std::optional<Consistency> consistencyOf(const BodyModel& body, const KnownTruth& truth, std::uint64_t seed) {
    const auto root = std::find_if(body.views.begin(), body.views.end(),
                                   [](const BodyView& v) { return v.T_body_camera.has_value(); });
    if (root == body.views.end())
        return std::nullopt;
    // The true body in the frame of the estimated one, which the covariances are relative to: no alignment may take
    // away what they are about.
    const Isometry3d T_v_r = truth.T_r_v[static_cast<std::size_t>(root - body.views.begin())].inverse();
    const Isometry3d T_body_r = *root->T_body_camera * T_v_r;
    OptionalPoses found;
    OptionalCovariances covariances;
    std::vector<Isometry3d> real;
    for (std::size_t u = 0; u < body.modules.size(); ++u) {
        found.push_back(body.modules[u].T_body_module);
        covariances.push_back(body.modules[u].covariance);
        real.push_back(T_body_r * truth.T_r_u[u]);
    }
    return consistencyOf(found, real, covariances, seed);
}

std::optional<NeesTest> neesTest(const std::vector<WorldAccuracy>& worlds,
                                 std::optional<Consistency> WorldAccuracy::*which) {
    NeesTest test;
    double sum = 0;
    for (const WorldAccuracy& world : worlds) {
        if (!(world.*which))
            continue;
        ++test.worlds;
        sum += (world.*which)->drawnNees;
    }
    if (test.worlds == 0)
        return std::nullopt;
    const auto count = static_cast<double>(test.worlds);
    const boost::math::chi_squared distribution(6 * count);
    test.mean = sum / count;
    test.low = boost::math::quantile(distribution, 0.025) / count;
    test.high = boost::math::quantile(distribution, 0.975) / count;
    return test;
}

bool isCancellation(const CalibrationError& error) {
    return error.code == ErrorCode::Cancelled;
}

}  // namespace

tl::expected<WorldAccuracy, CalibrationError> assessAccuracy(const Measurements& measurements, const KnownTruth& truth,
                                                             std::uint64_t seed, const RunContext& context) {
    WorldAccuracy result;
    result.seed = seed;
    result.modules = measurements.skin.modules.size();
    const auto best = estimateFromTruth(measurements, truth, context);
    if (!best && isCancellation(best.error()))
        return tl::unexpected(best.error());
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const auto body = calibrateJoint(measurements, {}, context);
    result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (!body && isCancellation(body.error()))
        return tl::unexpected(body.error());
    if (body) {
        result.verdict = body->quality.trust;
        result.consistency = consistencyOf(*body, truth, seed);
    } else {
        result.failure = body.error().message();
    }
    if (best)
        result.consistencyFromTruth = consistencyOf(best->state.T_r_u, truth.T_r_u, best->covariances, seed);
    if (!best)
        result.failure = "from the truth: " + best.error().message();
    else if (body)
        compareEstimates(measurements, truth, *body, *best, result);
    else
        result.placeable = result.missed = static_cast<std::size_t>(std::count_if(
            best->state.T_r_u.begin(), best->state.T_r_u.end(), [](const auto& T) { return T.has_value(); }));
    return result;
}

AccuracySummary summarise(const std::vector<WorldAccuracy>& worlds) {
    AccuracySummary summary;
    double logarithms = 0;
    for (const WorldAccuracy& world : worlds) {
        summary.modules += world.modules;
        summary.missed += world.missed;
        summary.beyondFive += world.consistency ? world.consistency->beyondFive : 0;
        if (!world.ratio) {
            ++summary.withoutResult;
            continue;
        }
        logarithms += std::log(*world.ratio);
        if (!summary.worst || *world.ratio > *summary.worst) {
            summary.worst = world.ratio;
            summary.worstSeed = world.seed;
        }
    }
    if (const std::size_t compared = worlds.size() - summary.withoutResult; compared > 0)
        summary.geometricMean = std::exp(logarithms / static_cast<double>(compared));
    summary.nees = neesTest(worlds, &WorldAccuracy::consistency);
    summary.neesFromTruth = neesTest(worlds, &WorldAccuracy::consistencyFromTruth);
    return summary;
}

AccuracyStudy runAccuracyStudy(const AccuracyStudyOptions& options, const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("AccuracyStudyOptions out of range");
    AccuracyStudy study{options, {}, false};
    RunContext part;
    part.isCancelled = context.isCancelled;
    for (int i = 0; i < options.worlds; ++i) {
        const std::uint64_t seed = options.firstSeed + static_cast<std::uint64_t>(i);
        context.report(Sentence::saying("world {}", seed), static_cast<double>(i) / options.worlds);
        const World world = randomWorld(seed);
        auto accuracy = assessAccuracy(measurementsOf(world), knownTruth(world), seed, part);
        if (!accuracy || context.isCancelled()) {
            study.cancelled = true;
            return study;
        }
        accuracy->world = world.scenario.description;
        study.worlds.push_back(std::move(*accuracy));
    }
    return study;
}

}  // namespace skincal
