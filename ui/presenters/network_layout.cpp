#include "ui/presenters/network_layout.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

#include "core/skin/cable_detection.h"

namespace skincal {
namespace {

constexpr double kGap = 14e-3;  // m between patches

struct Neighbour {
    std::size_t module = 0;
    int ownPort = 0;
    int otherPort = 0;
};

using Neighbours = std::vector<std::vector<Neighbour>>;

/// Where nothing else lies yet. Before cables are known, patches that one joins fold onto each other.
bool isFree(const std::map<std::size_t, Isometry3d>& placed, const Vector3d& centre, double reach) {
    return std::none_of(placed.begin(), placed.end(),
                        [&](const auto& other) { return (other.second.translation() - centre).norm() < reach; });
}

/// Places of one patch's modules, the first at the origin, breadth first; ports of neighbours coincide where the skin
/// closes no loop that a table could not. Modules that would lie on others are left for a drawing of their own.
std::map<std::size_t, Isometry3d> layPatch(const Skin& skin, const Neighbours& neighbours, std::size_t first,
                                           const std::vector<bool>& done) {
    std::map<std::size_t, Isometry3d> placed{{first, Isometry3d::Identity()}};
    std::deque<std::size_t> queue{first};
    while (!queue.empty()) {
        const std::size_t a = queue.front();
        queue.pop_front();
        for (const Neighbour& to : neighbours[a]) {
            if (placed.contains(to.module) || done[to.module])
                continue;
            const Vector3d& port_a = skin.port(a, to.ownPort);
            const Vector3d& port_b = skin.port(to.module, to.otherPort);
            const Matrix3d R_a_b = flatNeighbourRotation(port_a, port_b);
            const Isometry3d T = placed[a] * makeIsometry(R_a_b, port_a - R_a_b * port_b);
            if (!isFree(placed, T.translation(), skin.templateOf(to.module).portRadius()))
                continue;
            placed[to.module] = T;
            queue.push_back(to.module);
        }
    }
    return placed;
}

QPointF onScreen(const Vector3d& p) {
    return {1e3 * p.x(), -1e3 * p.y()};
}

FlatModule flatModule(const Skin& skin, std::size_t u, unsigned patch, const Isometry3d& T) {
    const ModuleTemplate& type = skin.templateOf(u);
    FlatModule flat{skin.modules[u].id, patch, onScreen(T.translation()), {}, {}};
    for (const Vector2d& corner : type.outline)
        flat.outline << onScreen(T * Vector3d(corner.x(), corner.y(), 0));
    for (const Vector3d& port : type.ports)
        flat.ports.push_back(onScreen(T * port));
    return flat;
}

QRectF boundsOf(const std::vector<FlatModule>& modules) {
    QRectF bounds;
    for (const FlatModule& module : modules)
        bounds |= module.outline.boundingRect();
    return bounds;
}

void shift(FlatModule& module, const QPointF& by) {
    module.centre += by;
    module.outline.translate(by);
    for (QPointF& port : module.ports)
        port += by;
}

/// Patches in rows about as wide as the whole is high, times the aspect of a page.
void arrange(std::vector<std::vector<FlatModule>>& patches) {
    double area = 0;
    for (const auto& patch : patches) {
        const QRectF bounds = boundsOf(patch);
        area += (bounds.width() + 1e3 * kGap) * (bounds.height() + 1e3 * kGap);
    }
    const double width = std::sqrt(1.8 * area);
    QPointF corner;
    double rowHeight = 0;
    for (auto& patch : patches) {
        const QRectF bounds = boundsOf(patch);
        if (corner.x() > 0 && corner.x() + bounds.width() > width) {
            corner = QPointF(0, corner.y() + rowHeight + 1e3 * kGap);
            rowHeight = 0;
        }
        for (FlatModule& module : patch)
            shift(module, corner - bounds.topLeft());
        corner.rx() += bounds.width() + 1e3 * kGap;
        rowHeight = std::max(rowHeight, bounds.height());
    }
}

}  // namespace

FlatNetwork layOutFlat(const Skin& skin, const std::vector<JudgedLink>& links) {
    const auto index = skin.indexById();
    Neighbours neighbours(skin.modules.size());
    for (const JudgedLink& judged : links) {
        const auto a = index.find(judged.link.a);
        const auto b = index.find(judged.link.b);
        if (judged.kind != LinkKind::Adjacent || a == index.end() || b == index.end() || a == b)
            continue;
        neighbours[a->second].push_back({b->second, judged.link.a_port, judged.link.b_port});
        neighbours[b->second].push_back({a->second, judged.link.b_port, judged.link.a_port});
    }
    std::vector<std::size_t> order(skin.modules.size());
    for (std::size_t u = 0; u < order.size(); ++u)
        order[u] = u;
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return skin.modules[a].id < skin.modules[b].id; });
    std::vector<std::vector<FlatModule>> patches;
    std::vector<bool> done(skin.modules.size(), false);
    for (const std::size_t first : order) {
        if (done[first])
            continue;
        const auto number = static_cast<unsigned>(patches.size());
        auto& patch = patches.emplace_back();
        for (const auto& [u, T] : layPatch(skin, neighbours, first, done)) {
            done[u] = true;
            patch.push_back(flatModule(skin, u, number, T));
        }
    }
    arrange(patches);
    FlatNetwork network;
    std::map<ModuleId, const FlatModule*> flat;
    for (auto& patch : patches)
        network.modules.insert(network.modules.end(), patch.begin(), patch.end());
    for (const FlatModule& module : network.modules)
        flat[module.module] = &module;
    for (std::size_t row = 0; row < links.size(); ++row) {
        const Link& link = links[row].link;
        const auto a = flat.find(link.a);
        const auto b = flat.find(link.b);
        if (a == flat.end() || b == flat.end())
            continue;
        network.links.push_back({links[row].kind, a->second->ports.at(static_cast<std::size_t>(link.a_port)),
                                 b->second->ports.at(static_cast<std::size_t>(link.b_port)), static_cast<int>(row)});
    }
    network.bounds = boundsOf(network.modules);
    return network;
}

}  // namespace skincal
