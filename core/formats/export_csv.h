#pragma once

#include <string>

#include "core/estimation/body_model.h"

namespace skincal {

/// One row per module: id,type,patch,status,x,y,z,qx,qy,qz,qw; pose in the body frame, m and unit quaternion, empty
/// where the module is not placed.
[[nodiscard]] std::string exportCsv(const BodyModel& body);

}  // namespace skincal
