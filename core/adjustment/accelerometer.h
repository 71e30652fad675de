#pragma once

#include "core/geometry/se3.h"

namespace skincal {

/// Raw reading to specific force: a = (raw - bias) / scale, axis by axis.
struct AccelerometerCalibration {
    Vector3d bias = Vector3d::Zero();   ///< m/s^2
    Vector3d scale = Vector3d::Ones();  ///< 1 is perfect
};

}  // namespace skincal
