#include "core/vision/spot_fit.h"

#include <ceres/tiny_solver.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

using Parameters = Eigen::Matrix<double, 6, 1>;

std::vector<SpotPixel> usablePixels(const SpotWindow& window) {
    std::vector<SpotPixel> pixels;
    pixels.reserve(static_cast<std::size_t>(window.value.size()));
    for (Eigen::Index row = 0; row < window.value.rows(); ++row) {
        for (Eigen::Index col = 0; col < window.value.cols(); ++col) {
            if (window.state(row, col) == PixelState::Excluded)
                continue;
            pixels.push_back({static_cast<double>(window.x0 + col), static_cast<double>(window.y0 + row),
                              window.value(row, col), 1 / std::sqrt(window.variance(row, col)),
                              window.state(row, col) == PixelState::Saturated});
        }
    }
    return pixels;
}

double medianValue(const std::vector<SpotPixel>& pixels) {
    std::vector<double> values;
    values.reserve(pixels.size());
    for (const SpotPixel& pixel : pixels)
        values.push_back(pixel.value);
    return median(std::move(values));
}

// Centroid of what rises above half the peak: inside the basin of the fit even on a clipped plateau.
std::optional<Parameters> startOf(const std::vector<SpotPixel>& pixels, const SpotPrior& prior) {
    const double offset = medianValue(pixels);
    double peak = 0;
    for (const SpotPixel& pixel : pixels)
        peak = std::max(peak, pixel.value - offset);
    if (!(peak > 0))
        return std::nullopt;
    double sum = 0;
    double area = 0;
    Vector2d centre = Vector2d::Zero();
    for (const SpotPixel& pixel : pixels) {
        const double light = pixel.value - offset;
        if (light < 0.5 * peak)
            continue;
        centre += light * Vector2d(pixel.x, pixel.y);
        sum += light;
        area += 1;
    }
    centre /= sum;
    // A disc as large as what lies above half the peak; a Gaussian's half-maximum radius is 1.18 s.
    const double width = std::clamp(std::sqrt(area / std::numbers::pi) / 1.18, 0.6, 3.0);
    Parameters start;
    start << centre, std::log(peak), std::log(width), offset, prior.halo;
    return start;
}

double explainedShare(const std::vector<SpotPixel>& pixels, const Eigen::VectorXd& residuals) {
    double weights = 0;
    double mean = 0;
    for (const SpotPixel& pixel : pixels) {
        if (pixel.lowerBound)
            continue;
        weights += pixel.weight * pixel.weight;
        mean += pixel.weight * pixel.weight * pixel.value;
    }
    mean /= weights;
    double total = 0;
    double left = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (pixels[i].lowerBound)
            continue;
        total += std::pow(pixels[i].weight * (pixels[i].value - mean), 2);
        left += std::pow(residuals[static_cast<Eigen::Index>(i)], 2);
    }
    return total > 0 ? 1 - left / total : 0.0;
}

}  // namespace

std::string_view name(SpotFitError error) {
    switch (error) {
        case SpotFitError::TooFewPixels:
            return "too few of its pixels are not clipped";
        case SpotFitError::NoLight:
            return "its spot does not rise above the noise";
        case SpotFitError::WrongShape:
            return "its spot has not the shape of a light point";
        case SpotFitError::OutsideWindow:
            return "only stray light blinks its word";
    }
    throw std::logic_error("unknown SpotFitError");
}

bool SpotFitOptions::validate() const {
    return haloWidth > 1 && minWidth_px > 0 && maxWidth_px > minWidth_px && prior.logWidthSigma > 0 &&
           prior.haloSigma > 0 && minSignificance > 0 && minExplained > 0 && minExplained < 1 && maxReducedChi2 > 0 &&
           sigmaFloor_px >= 0 && minPixels >= 7;
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

    const std::vector<SpotPixel> pixels = usablePixels(window);
    const auto clipped = std::count_if(pixels.begin(), pixels.end(), [](const SpotPixel& p) { return p.lowerBound; });
    if (static_cast<int>(pixels.size() - static_cast<std::size_t>(clipped)) < options.minPixels)
        return tl::unexpected(SpotFitError::TooFewPixels);
    std::optional<Parameters> parameters = startOf(pixels, options.prior);
    if (!parameters)
        return tl::unexpected(SpotFitError::NoLight);

    const SpotResiduals model(pixels, options.prior, options.haloWidth);
    ceres::TinySolver<SpotResiduals> solver;
    solver.options.max_num_iterations = 60;
    solver.Solve(model, &*parameters);
    Eigen::VectorXd residuals(model.NumResiduals());
    Eigen::Matrix<double, Eigen::Dynamic, 6> J(model.NumResiduals(), 6);
    model(parameters->data(), residuals.data(), J.data());
    if (!parameters->allFinite() || !residuals.allFinite() || !J.allFinite())
        return tl::unexpected(SpotFitError::WrongShape);

    const Vector2d centre = parameters->head<2>();
    if (centre.x() < window.x0 || centre.y() < window.y0 ||
        centre.x() > window.x0 + static_cast<double>(window.value.cols() - 1) ||
        centre.y() > window.y0 + static_cast<double>(window.value.rows() - 1))
        return tl::unexpected(SpotFitError::OutsideWindow);

    const Matrix6d information = J.transpose() * J;
    const Eigen::LDLT<Matrix6d> factor(information);
    if (factor.info() != Eigen::Success || !factor.isPositive())
        return tl::unexpected(SpotFitError::WrongShape);
    const Matrix6d covariance = factor.solve(Matrix6d::Identity());
    const auto ofPixels = residuals.head(residuals.size() - 2);
    const auto informative = static_cast<double>((ofPixels.array() != 0.0).count());
    const double chi2 = ofPixels.squaredNorm() / std::max(1.0, informative - 6);
    // Of a clipped spot the amplitude is an extrapolation; that there is light needs no proof.
    if (clipped == 0 && !(covariance(2, 2) * std::max(1.0, chi2) <= std::pow(options.minSignificance, -2)))
        return tl::unexpected(SpotFitError::NoLight);
    const double width = std::exp((*parameters)[3]);
    if (!(width >= options.minWidth_px && width <= options.maxWidth_px) ||
        (chi2 > options.maxReducedChi2 && explainedShare(pixels, residuals) < options.minExplained))
        return tl::unexpected(SpotFitError::WrongShape);

    SpotFit fit;
    fit.centre = centre;
    fit.sigma_px = std::sqrt(std::max(1.0, chi2) * 0.5 * (covariance(0, 0) + covariance(1, 1)) +
                             options.sigmaFloor_px * options.sigmaFloor_px);
    fit.width_px = width;
    fit.amplitude = std::exp((*parameters)[2]);
    fit.chi2 = chi2;
    fit.clipped = clipped > 0;
    return fit;
}

}  // namespace skincal
