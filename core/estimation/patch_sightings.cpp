#include "core/estimation/patch_sightings.h"

#include <fmt/format.h>

#include <map>

namespace skincal {

std::vector<PatchSighting> collectSightings(const Skin& skin, const SkinLayout& layout,
                                            const std::vector<PatchShape>& shapes,
                                            const std::vector<PixelObservation>& pixels) {
    std::vector<std::optional<Isometry3d>> T_o_u(skin.modules.size());
    for (std::size_t k = 0; k < layout.patches.size(); ++k) {
        for (std::size_t i = 0; i < layout.patches[k].modules.size(); ++i)
            T_o_u[layout.patches[k].modules[i]] = shapes[k].T_o_u[i];
    }
    std::map<std::pair<std::size_t, std::size_t>, PatchSighting> sightings;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const PixelObservation& o = pixels[i];
        if (!T_o_u[o.module])
            continue;
        const std::size_t patch = layout.patchOf[o.module];
        PatchSighting& sighting = sightings[{o.view, patch}];
        sighting.view = o.view;
        sighting.patch = patch;
        sighting.observations.push_back(i);
        sighting.leds.push_back({*T_o_u[o.module] * skin.templateOf(o.module).led,
                                 T_o_u[o.module]->linear() * Vector3d::UnitZ(), o.pixel, o.sigma_px});
    }
    std::vector<PatchSighting> result;
    for (auto& [key, sighting] : sightings)
        result.push_back(std::move(sighting));
    return result;
}

std::string notSeenWithPlaced(const Skin& skin, const Patch& patch, std::size_t mostLeds, int needed) {
    const auto origin = skin.modules[patch.origin].id.value;
    if (mostLeds == 0)
        return fmt::format("patch {} (origin {}) was seen in no view: add one that shows it beside a placed patch",
                           patch.id.value, origin);
    if (mostLeds < static_cast<std::size_t>(needed))
        return fmt::format(
            "patch {} (origin {}) showed at most {} LEDs in a view, {} are needed: move the camera "
            "closer or more in front of it",
            patch.id.value, origin, mostLeds, needed);
    return fmt::format("patch {} (origin {}) was never seen with a placed patch: add a view that shows both",
                       patch.id.value, origin);
}

}  // namespace skincal
