#include "core/skin/skin.h"

namespace skincal {

std::unordered_map<ModuleId, std::size_t> Skin::indexById() const {
    std::unordered_map<ModuleId, std::size_t> index;
    index.reserve(modules.size());
    for (std::size_t i = 0; i < modules.size(); ++i)
        index.emplace(modules[i].id, i);
    return index;
}

}  // namespace skincal
