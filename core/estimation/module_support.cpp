#include "core/estimation/module_support.h"

namespace skincal {
namespace {

/// Twice the area of a triangle, m^2, below which its corners lie on a line: 4 by 10 mm.
constexpr double kOnALine = 4e-5;

bool spanATriangle(const std::vector<Vector3d>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t j = i + 1; j < points.size(); ++j) {
            for (std::size_t k = j + 1; k < points.size(); ++k) {
                if ((points[j] - points[i]).cross(points[k] - points[i]).norm() > kOnALine)
                    return true;
            }
        }
    }
    return false;
}

}  // namespace

std::vector<bool> heldModules(const AdjustmentInput& input, const BodyState& state, std::vector<bool> measured) {
    std::vector<bool> held = std::move(measured);
    const std::size_t modules = held.size();
    std::vector<std::vector<std::size_t>> linksOf(modules);
    for (std::size_t l = 0; l < input.links.size(); ++l) {
        linksOf[input.links[l].a].push_back(l);
        linksOf[input.links[l].b].push_back(l);
    }
    std::vector<bool> seen(modules, false);
    for (const PixelObservation& o : input.pixels) {
        if (state.T_r_v[o.view])
            seen[o.module] = true;
    }
    std::vector<std::size_t> open;
    for (std::size_t u = 0; u < modules; ++u) {
        held[u] = held[u] && state.T_r_u[u];
        if (!held[u] && state.T_r_u[u])
            open.push_back(u);
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (const std::size_t u : open) {
            if (held[u])
                continue;
            std::vector<Vector3d> points;
            for (const std::size_t l : linksOf[u]) {
                const PortPair& link = input.links[l];
                if (held[link.a == u ? link.b : link.a])
                    points.push_back(link.a == u ? link.port_a : link.port_b);
            }
            if (seen[u])
                points.push_back(input.skin->templateOf(u).led);
            held[u] = spanATriangle(points);
            changed = changed || held[u];
        }
    }
    return held;
}

}  // namespace skincal
