#pragma once

#include <string>

#include "core/estimation/body_model.h"

namespace skincal {

/// ASCII PLY: each placed module's outline as one face in the body frame (m), vertices with normal and a colour per
/// patch.
[[nodiscard]] std::string exportPly(const BodyModel& body);

}  // namespace skincal
