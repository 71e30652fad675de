#include "core/estimation/module_support.h"

#include <numeric>
#include <set>

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

/// Groups that hold each other but that nothing ties to anything measured: no gravity, and fewer than three LEDs that
/// two views see.
void dropAdrift(const AdjustmentInput& input, const std::vector<bool>& measured,
                const std::vector<std::set<std::size_t>>& viewsOf, std::vector<bool>& held) {
    std::vector<std::size_t> root(held.size());
    std::iota(root.begin(), root.end(), 0U);
    const auto find = [&](std::size_t u) {
        while (root[u] != u)
            u = root[u] = root[root[u]];
        return u;
    };
    for (const PortPair& link : input.links) {
        if (held[link.a] && held[link.b])
            root[find(link.a)] = find(link.b);
    }
    std::vector<std::size_t> anchors(held.size(), 0);
    constexpr std::size_t kEnough = 3;
    for (std::size_t u = 0; u < held.size(); ++u) {
        if (held[u])
            anchors[find(u)] += measured[u] ? kEnough : viewsOf[u].size() >= 2 ? 1 : 0;
    }
    for (std::size_t u = 0; u < held.size(); ++u)
        held[u] = held[u] && anchors[find(u)] >= kEnough;
}

}  // namespace

std::vector<bool> heldModules(const AdjustmentInput& input, const BodyState& state, const std::vector<bool>& measured) {
    const std::size_t modules = measured.size();
    std::vector<std::vector<std::size_t>> linksOf(modules);
    for (std::size_t l = 0; l < input.links.size(); ++l) {
        linksOf[input.links[l].a].push_back(l);
        linksOf[input.links[l].b].push_back(l);
    }
    std::vector<std::set<std::size_t>> viewsOf(modules);
    for (const PixelObservation& o : input.pixels) {
        if (state.T_r_v[o.view])
            viewsOf[o.module].insert(o.view);
    }
    std::vector<bool> held(modules);
    for (std::size_t u = 0; u < modules; ++u)
        held[u] = state.T_r_u[u].has_value();
    // From all to those that hold each other.
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t u = 0; u < modules; ++u) {
            if (!held[u] || measured[u])
                continue;
            std::vector<Vector3d> points;
            for (const std::size_t l : linksOf[u]) {
                const PortPair& link = input.links[l];
                if (held[link.a == u ? link.b : link.a])
                    points.push_back(link.a == u ? link.port_a : link.port_b);
            }
            if (viewsOf[u].size() >= 2)
                points.push_back(input.skin->templateOf(u).led);
            held[u] = spanATriangle(points);
            changed = changed || !held[u];
        }
    }
    dropAdrift(input, measured, viewsOf, held);
    return held;
}

}  // namespace skincal
