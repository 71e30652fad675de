#include "core/estimation/next_measurement.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "core/estimation/advice_basis.h"
#include "core/estimation/gravity_spread.h"
#include "core/geometry/statistics.h"

namespace skincal {
namespace {

tl::unexpected<CalibrationError> failure(ErrorCode code) {
    return tl::unexpected(CalibrationError{code, {}});
}

struct Ground {
    AdviceBasis basis;
    BodyPrecision before;
};

tl::expected<Ground, CalibrationError> groundOf(const BodySolution& solution, const NextMeasurementOptions& options,
                                                const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("NextMeasurementOptions out of range");
    if (context.isCancelled())
        return failure(ErrorCode::Cancelled);
    AdviceBasis basis = adviceBasis(solution);
    if (basis.placedModules() == 0)
        return failure(ErrorCode::NothingPlaced);
    auto before = bodyPrecision(basis.used, basis.state, solution.gauge, solution.weights);
    if (!before)
        return tl::unexpected(before.error());
    return Ground{std::move(basis), std::move(*before)};
}

ForecastGain gainOf(const BodyPrecision& before, const BodyPrecision& after, std::size_t modules) {
    return {before.worstSigma(), after.worstSigma(), before.rmsSigma(), after.rmsSigma(), modules};
}

template <class Next>
void sortByGain(std::vector<Next>& ranked) {
    std::stable_sort(ranked.begin(), ranked.end(), [](const Next& a, const Next& b) {
        return std::pair(a.gain.worstAfter, a.gain.rmsAfter) < std::pair(b.gain.worstAfter, b.gain.rmsAfter);
    });
}

std::size_t affordable(std::size_t most, const AdviceBasis& basis, const NextMeasurementOptions& options) {
    constexpr std::size_t kFewest = 8;
    return std::min(most, std::max(kFewest, options.maxWork / basis.placedModules()));
}

/// What a reading of module u would be, with the noise that its others claim.
GravityReading forecastReading(const AdviceBasis& basis, std::size_t u, int pose, const Vector3d& up_r,
                               double gravity) {
    std::vector<double> sigmas;
    for (const GravityTable::Entry& entry : basis.used.gravity->of(u)) {
        if (entry.sigma)
            sigmas.push_back(*entry.sigma);
    }
    GravityReading reading{pose, basis.used.skin->modules[u].id, Vector3d::Zero(), {}, {}};
    reading.acceleration =
        basis.state.accelerometers[u].reading(gravity * (basis.state.T_r_u[u]->linear().transpose() * up_r));
    if (!sigmas.empty())
        reading.sigma = median(std::move(sigmas));
    return reading;
}

/// Angle to the nearest pose that the placed modules were in.
double nearestPose(const BodyState& complete, const Vector3d& up_r) {
    double cosine = -1;
    for (const auto& group : complete.up_r) {
        for (const auto& up : group)
            cosine = std::max(cosine, up ? up->dot(up_r) : -1);
    }
    return std::acos(std::clamp(cosine, -1.0, 1.0));
}

/// One axis of a way in a picture's directions.
Sentence inWords(const Vector3d& way_cm, Eigen::Index axis) {
    const double length = std::abs(way_cm[axis]);
    const bool isBack = way_cm[axis] < 0;
    if (axis == 0)
        return isBack ? Sentence::saying("{:.0f} cm left", length) : Sentence::saying("{:.0f} cm right", length);
    if (axis == 1)
        return isBack ? Sentence::saying("{:.0f} cm up", length) : Sentence::saying("{:.0f} cm down", length);
    return isBack ? Sentence::saying("{:.0f} cm back", length) : Sentence::saying("{:.0f} cm forward", length);
}

/// What a view looks at, and, for a person behind the camera, which way to carry it from where it stood, in that
/// picture's directions.
Sentence whereToStand(const BodySolution& solution, const AdviceBasis& basis, const Sentence& words,
                      const Vector3d& place) {
    std::optional<std::size_t> nearest;
    const auto distance = [&](std::size_t v) { return (basis.state.T_r_v[v]->translation() - place).norm(); };
    for (std::size_t v = 0; v < basis.state.T_r_v.size(); ++v) {
        if (basis.state.T_r_v[v] && (!nearest || distance(v) < distance(*nearest)))
            nearest = v;
    }
    if (!nearest)
        return words;
    const Vector3d way_cm = 100 * (basis.state.T_r_v[*nearest]->inverse() * place);
    // What is small beside the rest is lost in the hand.
    const double least_cm = std::max(1.0, 0.2 * way_cm.norm());
    Sentence ways;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
        if (std::abs(way_cm[axis]) < least_cm)
            continue;
        const Sentence way = inWords(way_cm, axis);
        ways = ways.empty() ? way : Sentence::saying("{}, {}", ways, way);
    }
    const std::string& view = solution.measurements->views[*nearest].name;
    return ways.empty() ? Sentence::saying("{}: where the camera of {} was", words, view)
                        : Sentence::saying("{}: {} from where the camera of {} was", words, ways, view);
}

struct SeenCandidate {
    ViewCandidate candidate;
    std::vector<std::optional<Vector2d>> pixels;
    std::size_t leds = 0;
    double promise = 0;  ///< how much it sees of what is uncertain
};

/// Unseen ones and the worst of all, the most uncertain first.
std::vector<std::size_t> modulesOfInterest(const Ground& ground, const UnseenModules& dark) {
    std::vector<std::size_t> modules = dark.unseen;
    const auto worst = ground.before.worst();
    if (worst && !dark.isHidden(*worst) && std::find(modules.begin(), modules.end(), *worst) == modules.end())
        modules.push_back(*worst);
    std::stable_sort(modules.begin(), modules.end(),
                     [&](std::size_t a, std::size_t b) { return ground.before.sigma(a) > ground.before.sigma(b); });
    constexpr std::size_t kMost = 6;
    modules.resize(std::min(kMost, modules.size()));
    return modules;
}

/// Only the candidates that see the most of what is uncertain are worth a closer look.
std::vector<SeenCandidate> promisingViews(const BodySolution& solution, const Ground& ground, const UnseenModules& dark,
                                          const NextMeasurementOptions& options) {
    std::vector<SeenCandidate> seen;
    for (ViewCandidate& candidate :
         viewCandidates(solution, ground.basis, modulesOfInterest(ground, dark), options.views)) {
        SeenCandidate own{std::move(candidate), {}, 0, 0};
        own.pixels = forecastPixels(ground.basis, own.candidate.T_r_v, options.limits);
        for (const std::size_t u : dark.hidden)
            own.pixels[u].reset();
        for (std::size_t u = 0; u < own.pixels.size(); ++u) {
            own.leds += own.pixels[u] ? 1 : 0;
            // The worst counts: a high power, so that many good modules do not outweigh it.
            own.promise += own.pixels[u] ? std::pow(ground.before.sigma(u) / ground.before.worstSigma(), 8) : 0;
        }
        if (own.leds >= options.minLeds)
            seen.push_back(std::move(own));
    }
    std::stable_sort(seen.begin(), seen.end(),
                     [](const SeenCandidate& a, const SeenCandidate& b) { return a.promise > b.promise; });
    const std::size_t count = affordable(options.maxViews, ground.basis, options);
    if (seen.size() > count)
        seen.resize(count);
    return seen;
}

}  // namespace

tl::expected<std::vector<NextPose>, CalibrationError> rankNextPoses(const BodySolution& solution,
                                                                    const NextMeasurementOptions& options,
                                                                    const RunContext& context) {
    const auto ground = groundOf(solution, options, context);
    if (!ground)
        return tl::unexpected(ground.error());
    const AdviceBasis& basis = ground->basis;
    const GravityTable& table = *basis.used.gravity;
    if (table.poseCount() == 0)
        return failure(ErrorCode::TooFewPoses);
    const int pose = table.poseNumber(table.poseCount() - 1) + 1;
    BodyState complete = basis.state;
    if (complete.up_r.empty())
        estimateUpDirections(basis.used, complete);

    std::vector<NextPose> ranked;
    const auto directions = evenDirections(affordable(options.directions, basis, options));
    for (std::size_t i = 0; i < directions.size(); ++i) {
        context.report(Sentence::saying("trying gravity poses"),
                       static_cast<double>(i) / static_cast<double>(directions.size()));
        if (context.isCancelled())
            return failure(ErrorCode::Cancelled);
        std::vector<GravityReading> readings = solution.measurements->gravity;
        std::size_t modules = 0;
        for (std::size_t u = 0; u < basis.state.T_r_u.size(); ++u) {
            if (!basis.isPlaced(u) || table.of(u).empty())
                continue;
            readings.push_back(forecastReading(basis, u, pose, directions[i], solution.weights.gravity));
            ++modules;
        }
        const GravityTable more(*basis.used.skin, readings);
        AdjustmentInput input = basis.used;
        input.gravity = &more;
        if (!input.poseNoise.empty())
            input.poseNoise.push_back(1);
        BodyState state = complete;
        for (auto& group : state.up_r)
            group.emplace_back(directions[i]);
        const auto after = bodyPrecision(input, state, solution.gauge, solution.weights);
        if (!after)
            return tl::unexpected(after.error());
        ranked.push_back({directions[i], nearestPose(complete, directions[i]), gainOf(ground->before, *after, modules),
                          wordsForUp(directions[i], solution)});
    }
    sortByGain(ranked);
    return ranked;
}

tl::expected<std::vector<NextView>, CalibrationError> rankNextViews(const BodySolution& solution,
                                                                    const NextMeasurementOptions& options,
                                                                    const RunContext& context) {
    const auto ground = groundOf(solution, options, context);
    if (!ground)
        return tl::unexpected(ground.error());
    const AdviceBasis& basis = ground->basis;
    std::vector<double> sigmas;
    for (const PixelObservation& o : basis.used.pixels)
        sigmas.push_back(o.sigma_px);
    const double sigma_px = sigmas.empty() ? PixelObservation{}.sigma_px : median(std::move(sigmas));

    const UnseenModules dark = unseenModules(basis, options.limits);
    std::vector<NextView> ranked;
    const auto candidates = promisingViews(solution, *ground, dark, options);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        context.report(Sentence::saying("trying views"),
                       static_cast<double>(i) / static_cast<double>(candidates.size()));
        if (context.isCancelled())
            return failure(ErrorCode::Cancelled);
        const SeenCandidate& seen = candidates[i];
        AdjustmentInput input = basis.used;
        BodyState state = basis.state;
        const std::size_t view = state.T_r_v.size();
        state.T_r_v.emplace_back(seen.candidate.T_r_v);
        if (!input.viewNoise.empty())
            input.viewNoise.push_back(1);
        std::vector<ModuleId> firstSeen;
        for (std::size_t u = 0; u < seen.pixels.size(); ++u) {
            if (!seen.pixels[u])
                continue;
            input.pixels.push_back({view, u, *seen.pixels[u], sigma_px});
            if (std::binary_search(dark.unseen.begin(), dark.unseen.end(), u))
                firstSeen.push_back(basis.used.skin->modules[u].id);
        }
        const auto after = bodyPrecision(input, state, solution.gauge, solution.weights);
        if (!after)
            return tl::unexpected(after.error());
        ranked.push_back({seen.candidate.T_r_v, seen.candidate.patches, std::move(firstSeen),
                          gainOf(ground->before, *after, seen.leds),
                          whereToStand(solution, basis, seen.candidate.words, seen.candidate.T_r_v.translation())});
    }
    sortByGain(ranked);
    return ranked;
}

}  // namespace skincal
