#pragma once

#include "core/geometry/se3.h"

namespace skincal {

/// An accelerometer's errors: raw = scale * (exp(misalignment) f) + bias, axis by axis, with the specific force f in
/// the module frame.
struct AccelerometerCalibration {
    Vector3d bias = Vector3d::Zero();          ///< m/s^2
    Vector3d scale = Vector3d::Ones();         ///< 1 is perfect
    Vector3d misalignment = Vector3d::Zero();  ///< rad, rotation vector: how the chip sits askew on its board

    [[nodiscard]] Vector3d specificForce(const Vector3d& raw) const {
        const Vector3d f = (raw - bias).cwiseQuotient(scale);
        return misalignment.isZero() ? f : Vector3d(so3Exp(-misalignment) * f);
    }
    [[nodiscard]] Vector3d reading(const Vector3d& force) const {
        return scale.cwiseProduct(misalignment.isZero() ? force : Vector3d(so3Exp(misalignment) * force)) + bias;
    }
};

}  // namespace skincal
