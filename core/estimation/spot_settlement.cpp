#include "core/estimation/spot_settlement.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace skincal {
namespace {

/// A module of a view with several spots, or a single one that may be a reflection.
struct Case {
    LedInView led;
    const Undetected* undetected = nullptr;
};

std::vector<Case> openCases(const BodySolution& solution) {
    std::set<std::pair<std::size_t, std::size_t>> taken;
    for (const PixelObservation& o : solution.input.pixels)
        taken.insert({o.view, o.module});
    const auto index = solution.input.skin->indexById();
    std::vector<Case> cases;
    for (std::size_t v = 0; v < solution.measurements->views.size(); ++v) {
        for (const Undetected& undetected : solution.measurements->views[v].undetected) {
            const auto module = index.find(undetected.module);
            if (!undetected.spots.empty() && module != index.end() && !taken.contains({v, module->second}))
                cases.push_back({{v, module->second}, &undetected});
        }
    }
    return cases;
}

/// Why nothing of what is known of the body can be said of this LED in this view; empty where it can.
Sentence whyUnknown(const BodySolution& solution, const LedInView& led, const SpotOptions& options) {
    const auto& T_r_v = solution.solved.T_r_v[led.view];
    const auto& T_r_u = solution.solved.T_r_u[led.module];
    const auto& undecided = solution.estimate.undecidedViews;
    if (!T_r_v)
        return Sentence::saying("its view has no pose");
    if (!T_r_u)
        return Sentence::saying("its module has no pose");
    if (std::find(undecided.begin(), undecided.end(), led.view) != undecided.end())
        return Sentence::saying("its view could be in two places");
    const Vector3d ray = T_r_v->translation() - *T_r_u * solution.input.skin->templateOf(led.module).led;
    if (std::acos(std::clamp(ray.normalized().dot(T_r_u->linear().col(2)), -1.0, 1.0)) > options.maxAngle)
        return Sentence::saying("the body has it turned away");
    return {};
}

struct Fit {
    std::size_t spot = 0;
    double sigmas = std::numeric_limits<double>::infinity();  ///< of the nearest spot
    double next = std::numeric_limits<double>::infinity();    ///< of the nearest of the others
    double distance_px = 0;
};

/// @param spots  at least one.
Fit nearestSpot(const BodySolution& solution, const LedInView& led, const std::vector<SpotChoice>& spots,
                const PixelPrediction& prediction) {
    Fit fit;
    for (std::size_t i = 0; i < spots.size(); ++i) {
        const double own =
            solution.input.sigmaOf({led.view, led.module, spots[i].pixel, spots[i].sigma_px}, solution.weights);
        const Eigen::Matrix2d S = prediction.covariance + own * own * Eigen::Matrix2d::Identity();
        const Vector2d r = spots[i].pixel - prediction.pixel;
        const double sigmas = std::sqrt(r.dot(S.ldlt().solve(r)));
        if (sigmas < fit.sigmas) {
            fit.next = fit.sigmas;
            fit.sigmas = sigmas;
            fit.spot = i;
            fit.distance_px = r.norm();
        } else {
            fit.next = std::min(fit.next, sigmas);
        }
    }
    return fit;
}

double worstSigma(const PixelPrediction& prediction) {
    return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(prediction.covariance).eigenvalues()[1]);
}

/// Why the fit decides nothing; empty where it does.
Sentence whyOpen(const Fit& fit, bool isAlone, const PixelPrediction& prediction, const SpotOptions& options) {
    const double sigma = worstSigma(prediction);
    if (!(sigma <= (isAlone ? options.maxSigmaAlone_px : options.maxSigma_px)))
        return Sentence::saying("the body tells where it must appear to {:.1f} px only", sigma);
    if (!(fit.sigmas <= options.fits) && isAlone)
        return Sentence::saying("the body has it {:.1f} px or {:.0f} sigma off", fit.distance_px, fit.sigmas);
    if (!(fit.sigmas <= options.fits))
        return Sentence::saying("none lies where the body has it, the nearest {:.1f} px or {:.0f} sigma off",
                                fit.distance_px, fit.sigmas);
    if (!(fit.next >= options.others))
        return Sentence::saying("another lies where the body has it, too: {:.1f} and {:.1f} sigma off", fit.sigmas,
                                fit.next);
    return {};
}

Sentence whyTaken(const Undetected& undetected, const Fit& fit) {
    if (undetected.spots.size() == 1)
        return Sentence::saying("{}: it lies where the body has it, {:.1f} sigma off", undetected.reason, fit.sigmas);
    return undetected.spots.size() > 2
               ? Sentence::saying(
                     "{}: this one lies where the body has it, {:.1f} sigma off, the others at least {:.0f}",
                     undetected.reason, fit.sigmas, fit.next)
               : Sentence::saying("{}: this one lies where the body has it, {:.1f} sigma off, the other {:.0f}",
                                  undetected.reason, fit.sigmas, fit.next);
}

}  // namespace

void takeSpot(BodySolution& solution, const LedInView& led, const SpotChoice& spot, const Sentence& reason) {
    BodyEstimate& estimate = solution.estimate;
    estimate.spots.push_back({led.view, led.module, solution.input.pixels.size(), spot.pixel, reason});
    solution.input.pixels.push_back({led.view, led.module, spot.pixel, spot.sigma_px});
    estimate.rejected.push_back(false);
    estimate.rejectedReason.emplace_back();
    estimate.setAside.emplace_back();
}

tl::expected<std::size_t, CalibrationError> settleSpots(BodySolution& solution, const SpotOptions& options,
                                                        const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("SpotOptions out of range");
    std::erase_if(solution.estimate.spots, [](const SpotVerdict& verdict) { return !verdict.pixel; });
    const auto leaveOpen = [&](const Case& open, const Sentence& why) {
        solution.estimate.spots.push_back({open.led.view,
                                           open.led.module,
                                           std::nullopt,
                                           {},
                                           Sentence::saying("{}; {}", open.undetected->reason, why)});
    };
    std::vector<Case> cases;
    std::vector<LedInView> leds;
    for (const Case& open : openCases(solution)) {
        const Sentence why = whyUnknown(solution, open.led, options);
        if (!why.empty()) {
            leaveOpen(open, why);
            continue;
        }
        cases.push_back(open);
        leds.push_back(open.led);
    }
    if (cases.empty())
        return std::size_t{0};
    const auto predictions =
        predictPixels(usedMeasurements(solution), solution.solved, solution.gauge, solution.weights, leds, context);
    if (!predictions && predictions.error().code == ErrorCode::Cancelled)
        return tl::unexpected(predictions.error());
    std::size_t taken = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (!predictions || !(*predictions)[i]) {
            leaveOpen(cases[i], Sentence::saying("the data do not tell where it must appear"));
            continue;
        }
        const Fit fit = nearestSpot(solution, cases[i].led, cases[i].undetected->spots, *(*predictions)[i]);
        const Sentence why = whyOpen(fit, cases[i].undetected->spots.size() == 1, *(*predictions)[i], options);
        if (!why.empty()) {
            leaveOpen(cases[i], why);
            continue;
        }
        takeSpot(solution, cases[i].led, cases[i].undetected->spots[fit.spot], whyTaken(*cases[i].undetected, fit));
        ++taken;
    }
    return taken;
}

void dropRejectedSpots(BodySolution& solution) {
    BodyEstimate& estimate = solution.estimate;
    // They were added one after the other: from the last on, those before keep their places.
    for (auto verdict = estimate.spots.rbegin(); verdict != estimate.spots.rend(); ++verdict) {
        if (!verdict->pixel)
            continue;
        // What has no pose is never judged.
        const Sentence why = !solution.solved.T_r_v[verdict->view]     ? Sentence::saying("its view has no pose")
                             : !solution.solved.T_r_u[verdict->module] ? Sentence::saying("its module has no pose")
                                                                       : estimate.rejectedReason[*verdict->pixel];
        if (why.empty() && !estimate.rejected[*verdict->pixel])
            continue;
        const std::size_t at = *verdict->pixel;
        const auto offset = static_cast<std::ptrdiff_t>(at);
        verdict->reason = Sentence::saying("a spot that blinks its word was taken and did not stand: {}", why);
        verdict->pixel.reset();
        solution.input.pixels.erase(solution.input.pixels.begin() + offset);
        estimate.rejected.erase(estimate.rejected.begin() + offset);
        estimate.rejectedReason.erase(estimate.rejectedReason.begin() + offset);
        estimate.setAside.erase(estimate.setAside.begin() + offset);
        for (SpotVerdict& other : estimate.spots) {
            if (other.pixel && *other.pixel > at)
                --*other.pixel;
        }
    }
}

void restoreSpots(BodySolution& solution) {
    std::vector<SpotVerdict> before = std::move(solution.estimate.spots);
    solution.estimate.spots.clear();
    for (const Case& open : openCases(solution)) {
        const auto was = std::find_if(before.begin(), before.end(), [&](const SpotVerdict& verdict) {
            return verdict.pixel && verdict.view == open.led.view && verdict.module == open.led.module;
        });
        if (was == before.end())
            continue;
        const auto& spots = open.undetected->spots;
        const auto spot = std::find_if(spots.begin(), spots.end(),
                                       [&](const SpotChoice& choice) { return choice.pixel == was->spot; });
        if (spot == spots.end())
            continue;
        SpotVerdict again = *was;
        again.pixel = solution.input.pixels.size();
        solution.estimate.spots.push_back(std::move(again));
        solution.input.pixels.push_back({open.led.view, open.led.module, spot->pixel, spot->sigma_px});
    }
}

}  // namespace skincal
