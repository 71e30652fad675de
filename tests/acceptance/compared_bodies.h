#pragma once

#include <algorithm>
#include <optional>

#include "core/estimation/body_model.h"
#include "core/estimation/compare.h"
#include "core/simulation/world.h"

namespace skincal {

/// Of the modules that have a pose; nothing where they are too few to tell.
inline std::optional<BodyComparison> errorOf(const World& world, const BodyModel& body) {
    std::vector<NamedPose> found;
    std::vector<NamedPose> real;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        real.push_back({world.skin.modules[u].id, world.T_r_u[u]});
        if (body.modules[u].T_body_module)
            found.push_back({body.modules[u].id, *body.modules[u].T_body_module});
    }
    const auto difference = compareBodies(found, real);
    return difference ? std::optional(*difference) : std::nullopt;
}

/// Detections that count.
inline std::size_t used(const BodyModel& body) {
    std::size_t count = 0;
    for (const BodyView& view : body.views)
        count += static_cast<std::size_t>(
            std::count_if(view.observations.begin(), view.observations.end(),
                          [](const BodyObservation& o) { return o.verdict == ObservationVerdict::Used; }));
    return count;
}

/// Modules that pictures show.
inline std::size_t seen(const BodyModel& body) {
    return static_cast<std::size_t>(
        std::count_if(body.modules.begin(), body.modules.end(), [](const BodyModule& m) { return m.seen; }));
}

}  // namespace skincal
