#include "core/vision/spot_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "core/geometry/statistics.h"
#include "core/vision/spot_model.h"

namespace skincal {
namespace {

bool isGood(const SpotWindow& window, Eigen::Index i) {
    return window.state(i) != PixelState::Excluded;
}

/// Of every other good pixel: only a start.
double medianValue(const SpotWindow& window) {
    std::vector<double> values;
    values.reserve(static_cast<std::size_t>(window.value.size() / 2) + 1);
    bool isOther = false;
    for (Eigen::Index i = 0; i < window.value.size(); ++i) {
        if (isGood(window, i) && (isOther = !isOther))
            values.push_back(window.value(i));
    }
    return median(std::move(values));
}

// Centroid of what rises above half the peak: inside the basin of the fit even on a clipped plateau.
std::optional<SpotParameters> startOf(const SpotWindow& window, const SpotPrior& prior) {
    const double offset = medianValue(window);
    double peak = 0;
    for (Eigen::Index i = 0; i < window.value.size(); ++i) {
        if (isGood(window, i))
            peak = std::max(peak, window.value(i) - offset);
    }
    if (!(peak > 0))
        return std::nullopt;
    double sum = 0;
    double area = 0;
    Vector2d centre = Vector2d::Zero();
    for (Eigen::Index i = 0; i < window.value.size(); ++i) {
        const double light = window.value(i) - offset;
        if (!isGood(window, i) || light < 0.5 * peak)
            continue;
        centre += light * Vector2d(window.x0 + static_cast<double>(i / window.value.rows()),
                                   window.y0 + static_cast<double>(i % window.value.rows()));
        sum += light;
        area += 1;
    }
    centre /= sum;
    // A disc as large as what lies above half the peak; a Gaussian's half-maximum radius is 1.18 s.
    const double width = std::clamp(std::sqrt(area / std::numbers::pi) / 1.18, 0.6, 3.0);
    SpotParameters start;
    start << centre, std::log(peak), std::log(width), offset, prior.halo;
    return start;
}

/// Where the middle is clipped, a narrow core with a strong halo may look much like a wide core without: a fit that
/// ends up at an unusual width is tried from the usual one, too.
SpotModel::Normals minimised(const SpotModel& model, const SpotPrior& prior, bool isWhole, SpotParameters& parameters) {
    constexpr double kSigmas = 0.5;
    SpotParameters usual = parameters;
    SpotModel::Normals least = model.minimise(parameters);
    if (isWhole || std::abs(parameters[3] - prior.logWidth) <= kSigmas * prior.logWidthSigma)
        return least;
    usual[3] = prior.logWidth;
    const SpotModel::Normals other = model.minimise(usual);
    if (other.cost < least.cost) {
        parameters = usual;
        least = other;
    }
    return least;
}

}  // namespace

double blindShare(const SpotWindow& window, const Vector2d& centre, double radius_px) {
    std::size_t pixels = 0;
    std::size_t blind = 0;
    for (Eigen::Index row = 0; row < window.state.rows(); ++row) {
        for (Eigen::Index col = 0; col < window.state.cols(); ++col) {
            const Vector2d pixel(static_cast<double>(window.x0 + col), static_cast<double>(window.y0 + row));
            if ((pixel - centre).norm() > radius_px)
                continue;
            ++pixels;
            blind += window.state(row, col) == PixelState::Excluded ? 1 : 0;
        }
    }
    return pixels > 0 ? static_cast<double>(blind) / static_cast<double>(pixels) : 0;
}

Sentence sentenceOf(SpotFitError error) {
    switch (error) {
        case SpotFitError::TooFewPixels:
            return Sentence::saying("too few of its pixels are not clipped");
        case SpotFitError::NoLight:
            return Sentence::saying("its spot does not rise above the noise");
        case SpotFitError::WrongShape:
            return Sentence::saying("its spot has not the shape of a light point");
        case SpotFitError::OutsideWindow:
            return Sentence::saying("only stray light blinks its word");
    }
    throw std::logic_error("unknown SpotFitError");
}

bool SpotFitOptions::validate() const {
    return haloWidth > 1 && minWidth_px > 0 && maxWidth_px > minWidth_px && prior.logWidthSigma > 0 &&
           prior.haloSigma > 0 && minSignificance > 0 && minExplained > 0 && minExplained <= minExplainedNarrow &&
           minExplainedNarrow < 1 && maxReducedChi2 > 0 && sigmaFloor_px >= 0 && minPixels >= 7;
}

double SpotFit::flux() const {
    return 2 * std::numbers::pi * amplitude * width_px * width_px;
}

tl::expected<SpotFit, SpotFitError> fitSpot(const SpotWindow& window, const SpotFitOptions& options) {
    const auto sameSize = [&](const auto& array) {
        return array.rows() == window.value.rows() && array.cols() == window.value.cols();
    };
    if (!options.validate() || !sameSize(window.variance) || !sameSize(window.state))
        throw std::logic_error("fitSpot: options or window out of order");

    const auto clipped = (window.state == PixelState::Saturated).count();
    if ((window.state == PixelState::Good).count() < options.minPixels)
        return tl::unexpected(SpotFitError::TooFewPixels);
    std::optional<SpotParameters> parameters = startOf(window, options.prior);
    if (!parameters)
        return tl::unexpected(SpotFitError::NoLight);

    const SpotModel model(window, options.prior, options.haloWidth);
    const SpotModel::Normals normals =
        minimised(model, options.prior, (window.state == PixelState::Good).all(), *parameters);
    if (!parameters->allFinite() || !normals.N.allFinite() || !std::isfinite(normals.cost))
        return tl::unexpected(SpotFitError::WrongShape);

    const Vector2d centre = parameters->head<2>();
    if (centre.x() < window.x0 || centre.y() < window.y0 ||
        centre.x() > window.x0 + static_cast<double>(window.value.cols() - 1) ||
        centre.y() > window.y0 + static_cast<double>(window.value.rows() - 1))
        return tl::unexpected(SpotFitError::OutsideWindow);

    const Eigen::LDLT<Matrix6d> factor(normals.N);
    if (factor.info() != Eigen::Success || !factor.isPositive())
        return tl::unexpected(SpotFitError::WrongShape);
    const Matrix6d covariance = factor.solve(Matrix6d::Identity());
    const double chi2 = normals.misfit / std::max(1.0, normals.informative - 6.0);
    // Of a clipped spot, and one whose middle is blind, the amplitude is an extrapolation. That there is light in the
    // one needs no proof; in the other the rim has to show it.
    constexpr double kMiddle_px = 1.5;
    const double blind = blindShare(window, centre, kMiddle_px);
    const auto squaredSignificance = [&] {
        return (blind > 0 ? model.explained(*parameters).gain : 1 / covariance(2, 2)) / std::max(1.0, chi2);
    };
    if (clipped == 0 && !(squaredSignificance() >= std::pow(options.minSignificance, 2)))
        return tl::unexpected(SpotFitError::NoLight);
    const double width = std::exp((*parameters)[3]);
    const double least = width <= options.narrow_px ? options.minExplainedNarrow : options.minExplained;
    if (!(width >= options.minWidth_px && width <= options.maxWidth_px) ||
        (chi2 > options.maxReducedChi2 && model.explained(*parameters).share < least))
        return tl::unexpected(SpotFitError::WrongShape);

    SpotFit fit;
    fit.centre = centre;
    fit.sigma_px = std::sqrt(std::max(1.0, chi2) * 0.5 * (covariance(0, 0) + covariance(1, 1)) +
                             options.sigmaFloor_px * options.sigmaFloor_px);
    fit.width_px = width;
    fit.logWidthSigma = std::sqrt(std::max(1.0, chi2) * covariance(3, 3));
    fit.amplitude = std::exp((*parameters)[2]);
    fit.chi2 = chi2;
    fit.clipped = clipped > 0;
    fit.blind = blind > 0.5;
    return fit;
}

}  // namespace skincal
