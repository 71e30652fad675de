#pragma once

#include "core/device/line_address.h"
#include "core/skin/module_template.h"
#include "ui/presenters/workbench.h"

namespace skincal {

/// A skin that speaks the protocol at an address. What can't be one is told where it is typed (parseLineAddress).
/// @param types  of all modules that may be there
[[nodiscard]] Offer<SkinDevice> offerOfAddress(const LineAddress& address, std::vector<ModuleTemplate> types);

}  // namespace skincal
