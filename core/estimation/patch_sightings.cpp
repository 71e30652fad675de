#include "core/estimation/patch_sightings.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace skincal {

std::vector<PatchSighting> collectSightings(const Skin& skin, const SkinLayout& layout,
                                            const std::vector<PatchShape>& shapes,
                                            const std::vector<PixelObservation>& pixels) {
    std::vector<std::optional<Isometry3d>> T_o_u(skin.modules.size());
    for (std::size_t k = 0; k < layout.patches.size(); ++k) {
        for (std::size_t i = 0; i < layout.patches[k].modules.size(); ++i)
            T_o_u[layout.patches[k].modules[i]] = shapes[k].T_o_u[i];
    }
    std::vector<std::size_t> byModule(pixels.size());
    std::iota(byModule.begin(), byModule.end(), std::size_t{0});
    std::stable_sort(byModule.begin(), byModule.end(),
                     [&](std::size_t a, std::size_t b) { return pixels[a].module < pixels[b].module; });
    std::map<std::pair<std::size_t, std::size_t>, PatchSighting> sightings;
    for (const std::size_t i : byModule) {
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

}  // namespace skincal
