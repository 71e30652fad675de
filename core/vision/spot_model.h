#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace skincal {

/// One pixel of a spot as the fit sees it.
struct SpotPixel {
    double x = 0;
    double y = 0;
    double value = 0;
    double weight = 1;        ///< 1 / standard deviation
    bool lowerBound = false;  ///< clipped: the light is at least `value`
};

/// Weak beliefs about a spot's shape. They settle what a clipped spot leaves open and hardly touch its centre.
struct SpotPrior {
    double logWidth = 0.18;
    double logWidthSigma = 0.7;
    double halo = 0.03;
    double haloSigma = 0.05;
};

/// Residuals of a round spot with a faint halo, in the form that ceres::TinySolver takes:
///   model = b + A (exp(-r^2 / 2s^2) + h exp(-r^2 / 2(qs)^2)),  parameters (x, y, log A, log s, b, h)
/// One row per pixel, (model - value) * weight, zero where a lower bound is met; then the two priors.
class SpotResiduals {
  public:
    using Scalar = double;
    enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = 6 };

    SpotResiduals(const std::vector<SpotPixel>& pixels, const SpotPrior& prior, double haloWidth)
        : pixels_(pixels), prior_(prior), haloWidth_(haloWidth) {}

    // NOLINTNEXTLINE(readability-identifier-naming): Ceres' name
    [[nodiscard]] int NumResiduals() const { return static_cast<int>(pixels_.size()) + 2; }

    bool operator()(const double* parameters, double* residuals, double* jacobian) const {
        const double amplitude = std::exp(parameters[2]);
        const double inverse = std::exp(-2 * parameters[3]);
        const double haloInverse = inverse / (haloWidth_ * haloWidth_);
        const double halo = parameters[5];
        const int rows = NumResiduals();
        Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 6>> J(jacobian, jacobian != nullptr ? rows : 0, 6);
        if (jacobian != nullptr)
            J.setZero();
        for (int i = 0; i < rows - 2; ++i) {
            const SpotPixel& pixel = pixels_[static_cast<std::size_t>(i)];
            const double dx = pixel.x - parameters[0];
            const double dy = pixel.y - parameters[1];
            const double r2 = dx * dx + dy * dy;
            const double core = amplitude * std::exp(-0.5 * r2 * inverse);
            const double skirt = amplitude * std::exp(-0.5 * r2 * haloInverse);
            const double model = parameters[4] + core + halo * skirt;
            residuals[i] = (model - pixel.value) * pixel.weight;
            if (pixel.lowerBound && residuals[i] >= 0) {
                residuals[i] = 0;
                continue;
            }
            if (jacobian == nullptr)
                continue;
            const double slope = core * inverse + halo * skirt * haloInverse;
            J(i, 0) = pixel.weight * slope * dx;
            J(i, 1) = pixel.weight * slope * dy;
            J(i, 2) = pixel.weight * (core + halo * skirt);
            J(i, 3) = pixel.weight * slope * r2;
            J(i, 4) = pixel.weight;
            J(i, 5) = pixel.weight * skirt;
        }
        residuals[rows - 2] = (parameters[3] - prior_.logWidth) / prior_.logWidthSigma;
        residuals[rows - 1] = (halo - prior_.halo) / prior_.haloSigma;
        if (jacobian != nullptr) {
            J(rows - 2, 3) = 1 / prior_.logWidthSigma;
            J(rows - 1, 5) = 1 / prior_.haloSigma;
        }
        return true;
    }

  private:
    const std::vector<SpotPixel>& pixels_;
    SpotPrior prior_;
    double haloWidth_;
};

}  // namespace skincal
