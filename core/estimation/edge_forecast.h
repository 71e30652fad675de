#pragma once

#include <optional>
#include <span>

#include "core/geometry/se3.h"

namespace skincal {

/// What accelerometers are like before anybody has calibrated them, standard deviations.
struct AccelerometerPrior {
    double noise = 0.03;  ///< m/s^2 per axis, of a reading that is kept
    double bias = 0.3;    ///< m/s^2 per axis
    double scale = 0.01;  ///< per axis

    [[nodiscard]] bool validate() const { return noise > 0 && bias >= 0 && scale >= 0; }
};

/// How well the relative rotation of two neighbours will come out from gravity in so many poses: the standard deviation
/// about the axis that is known worst, rad. Linear in the rotation w, and in how bias b and scale s differ between the
/// two:
///   r_p = -[g_p]x w + b + diag(g_p) s + noise,  b ~ sqrt2 bias, s ~ sqrt2 scale, noise ~ sqrt2 noise
/// A first bound only: other patches and pictures know more.
/// @param gravity  what one of the two reads in each pose, m/s^2
/// Nothing where the poses leave an axis free: below two, or all alike. Throws std::logic_error on an invalid prior.
[[nodiscard]] std::optional<double> expectedEdgeSigma(std::span<const Vector3d> gravity,
                                                      const AccelerometerPrior& prior = {});

}  // namespace skincal
