#include "core/device/module_register.h"

#include <algorithm>
#include <set>

namespace skincal {

void ModuleRegister::remember(const Skin& skin) {
    for (const SkinModule& module : skin.modules) {
        taken_.emplace(module.id, module.uniqueId);
        if (!module.uniqueId.empty())
            ids_.emplace(module.uniqueId, module.id);
    }
}

ModuleId ModuleRegister::idOf(const NetworkCell& cell) {
    const auto known = ids_.find(cell.uniqueId);
    if (known != ids_.end())
        return known->second;
    ModuleId id(cell.number);
    while (taken_.contains(id))
        id = ModuleId(next_++);
    taken_.emplace(id, cell.uniqueId);
    ids_.emplace(cell.uniqueId, id);
    return id;
}

tl::expected<Skin, std::string> skinOf(const SkinNetwork& network, const std::vector<ModuleTemplate>& templates,
                                       ModuleRegister& modules) {
    Skin skin;
    std::map<CellNumber, ModuleId> ids;
    std::map<std::string, std::size_t> types;
    for (const NetworkCell& cell : network.cells) {
        const auto type = std::find_if(templates.begin(), templates.end(),
                                       [&](const ModuleTemplate& t) { return t.name == cell.type; });
        if (type == templates.end())
            return tl::unexpected(cell.type);
        const auto place = types.emplace(cell.type, skin.templates.size());
        if (place.second)
            skin.templates.push_back(*type);
        ids[cell.number] = modules.idOf(cell);
        skin.modules.push_back({ids[cell.number], place.first->second, cell.uniqueId});
    }
    std::sort(skin.modules.begin(), skin.modules.end(),
              [](const SkinModule& a, const SkinModule& b) { return a.id < b.id; });

    using End = std::pair<ModuleId, int>;
    std::set<std::pair<End, End>> reported;
    for (const NetworkCell& cell : network.cells)
        for (const NetworkCell::Heard& heard : cell.heard) {
            const End here{ids[cell.number], heard.port};
            if (heard.cell == 0) {
                skin.hostLinks.push_back({here.first, here.second});
            } else if (ids.contains(heard.cell)) {
                const End there{ids[heard.cell], heard.port_there};
                reported.insert(std::minmax(here, there));
            }
        }
    for (const auto& [a, b] : reported)
        skin.links.push_back({a.first, a.second, b.first, b.second, std::nullopt});
    return skin;
}

}  // namespace skincal
