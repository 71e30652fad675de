#pragma once

#include <ceres/loss_function.h>

#include <cmath>

namespace skincal {

/// Cauchy's loss that begins at b standard deviations: least squares up to there, so that data without outliers lose
/// nothing, and beyond influence that fades:
///   rho(s) = s                                  for s <= b^2
///            b^2 + a^2 log(1 + (s - b^2) / a^2)  beyond
/// Its first derivative is continuous. b = 0 is Cauchy's own.
class LateCauchyLoss final : public ceres::LossFunction {
  public:
    LateCauchyLoss(double scale, double begins) : a2_(scale * scale), b2_(begins * begins) {}

    /// rho'(s): what is left of the weight of a residual.
    [[nodiscard]] double weight(double s) const { return s <= b2_ ? 1 : 1 / (1 + (s - b2_) / a2_); }

    void Evaluate(double s, double rho[3]) const override {
        if (s <= b2_) {
            rho[0] = s;
            rho[1] = 1;
            rho[2] = 0;
            return;
        }
        rho[0] = b2_ + a2_ * std::log1p((s - b2_) / a2_);
        rho[1] = weight(s);
        rho[2] = -rho[1] * rho[1] / a2_;
    }

  private:
    double a2_;
    double b2_;
};

}  // namespace skincal
