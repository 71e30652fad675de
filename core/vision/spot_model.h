#pragma once

#include <Eigen/Core>

#include "core/geometry/se3.h"
#include "core/vision/spot_fit.h"

namespace skincal {

/// A spot's parameters: centre x, y (px), log A, log s (px), offset b, halo h.
using SpotParameters = Vector6d;

/// A round spot with a faint halo and what a window says of it:
///   model = b + A (exp(-r^2 / 2s^2) + h exp(-r^2 / 2(qs)^2)),   cost = sum ((model - value) / sigma)^2 + priors
/// over the pixels that are not excluded; a lower bound that is met costs nothing. Exponentials of a round spot are
/// products of one per column and one per row, which makes this cheap. The window must outlive it.
class SpotModel {
  public:
    /// What Gauss-Newton's step takes: cost(p + d) ~ cost + 2 g^T d + d^T N d.
    struct Normals {
        Matrix6d N = Matrix6d::Zero();
        Vector6d g = Vector6d::Zero();
        double cost = 0;
        double misfit = 0;    ///< the part of the cost that is of pixels
        int informative = 0;  ///< pixels that are no met bounds
    };

    SpotModel(const SpotWindow& window, const SpotPrior& prior, double haloWidth);

    [[nodiscard]] Normals at(const SpotParameters& p) const;
    /// What of the light's variation, clipped pixels left out, the model explains.
    struct Explained {
        double gain = 0;   ///< by how much the misfit is less than that of light on a slope, over the noise squared
        double share = 0;  ///< of the variation
    };
    [[nodiscard]] Explained explained(const SpotParameters& p) const;
    /// Least cost by Levenberg-Marquardt, until a step moves nothing by a hundredth of its standard deviation.
    [[nodiscard]] Normals minimise(SpotParameters& p) const;

  private:
    const SpotWindow& window_;
    SpotPrior prior_;
    double haloWidth_;
    // As many rows as the window or one more, of no weight, so that they make pairs.
    Eigen::ArrayXXd weight_;  ///< 1 / sigma^2; 0 where the pixel is excluded
    Eigen::ArrayXXd value_;
    Eigen::ArrayXXd bound_;  ///< residuals from here on don't count: 0 where the pixel is clipped, else infinite
};

}  // namespace skincal
