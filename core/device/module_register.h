#pragma once

#include <map>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "core/device/protocol/skin_listener.h"
#include "core/skin/skin.h"

namespace skincal {

/// Which cell is which module, for ever: a cell is known by its unique id, whatever number a network gives it today. A
/// cell that was never met gets the number it has in the network where that is free, else the lowest free one.
class ModuleRegister {
  public:
    /// Modules that have a unique id keep their module id; all others' ids are taken, too.
    void remember(const Skin& skin);
    ModuleId idOf(const NetworkCell& cell);

  private:
    std::map<std::string, ModuleId> ids_;
    std::map<ModuleId, std::string> taken_;
    std::uint32_t next_ = 1;
};

/// The skin that a network is: links that both ends report once, others as they were reported.
/// @param templates  of the types that cells say they are
/// The error is a cell's type that is none of those.
[[nodiscard]] tl::expected<Skin, std::string> skinOf(const SkinNetwork& network,
                                                     const std::vector<ModuleTemplate>& templates,
                                                     ModuleRegister& modules);

}  // namespace skincal
