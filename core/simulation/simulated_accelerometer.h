#pragma once

#include <vector>

#include "core/geometry/random.h"
#include "core/geometry/se3.h"

namespace skincal {

struct World;

/// The accelerometer on one module's board, with the errors that it was made with:
///   a = S M f_u + b + noise,  S scale, M misalignment, b bias
struct SimulatedAccelerometer {
    Vector3d bias = Vector3d::Zero();              ///< m/s^2
    Vector3d scale = Vector3d::Ones();             ///< per axis, 1 is perfect
    Matrix3d misalignment = Matrix3d::Identity();  ///< of the chip on its board
    double noise = 0;                              ///< m/s^2 per axis and reading, standard deviation

    /// One reading, m/s^2.
    /// @param force_u  specific force in the module frame, m/s^2
    /// @param chance   where the noise comes from: three normal numbers a reading
    [[nodiscard]] Vector3d read(const Vector3d& force_u, Random& chance) const;
};

/// The accelerometers of a world's modules, in the order of Skin::modules. They follow from its scenario and seed:
/// those that simulateGravity reads.
[[nodiscard]] std::vector<SimulatedAccelerometer> accelerometersOf(const World& world);

}  // namespace skincal
