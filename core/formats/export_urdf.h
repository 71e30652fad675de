#pragma once

#include <string>

#include "core/estimation/body_model.h"

namespace skincal {

/// URDF: link "skin_base" is the body frame; each placed patch is a link "patch_ID" fixed to it, each placed module a
/// link "module_ID" fixed to its patch, with a thin box of its template's size as its visual. Metres and radians.
[[nodiscard]] std::string exportUrdf(const BodyModel& body, const std::string& robotName = "skin");

}  // namespace skincal
