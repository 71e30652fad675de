#include "core/estimation/skin_layout.h"

#include <algorithm>

namespace skincal {
namespace {

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Separations seen in one view, one entry per link that shows both its LEDs.
void addSeparationsOfView(const std::vector<GraphLink>& links, const std::vector<std::optional<Vector2d>>& pixels,
                          std::vector<std::vector<double>>& separations) {
    std::vector<double> distance(links.size(), -1);
    std::vector<std::vector<std::size_t>> linksOf(pixels.size());
    std::vector<double> all;
    for (std::size_t l = 0; l < links.size(); ++l) {
        if (!pixels[links[l].a] || !pixels[links[l].b] || links[l].a == links[l].b)
            continue;
        distance[l] = (*pixels[links[l].a] - *pixels[links[l].b]).norm();
        linksOf[links[l].a].push_back(l);
        linksOf[links[l].b].push_back(l);
        all.push_back(distance[l]);
    }
    if (all.size() < 3)
        return;
    const double typical = median(all);
    for (std::size_t l = 0; l < links.size(); ++l) {
        if (distance[l] < 0)
            continue;
        std::vector<double> nearby;
        for (const std::size_t end : {links[l].a, links[l].b}) {
            for (const std::size_t other : linksOf[end]) {
                if (other != l)
                    nearby.push_back(distance[other]);
            }
        }
        const double pitch = nearby.size() >= 2 ? median(nearby) : typical;
        if (pitch > 0)
            separations[l].push_back(distance[l] / pitch);
    }
}

}  // namespace

std::vector<std::optional<double>> linkSeparations(const Measurements& measurements, const SkinGraph& graph,
                                                   int minViews) {
    const auto& links = graph.links();
    const auto index = measurements.skin.indexById();
    std::vector<std::vector<double>> separations(links.size());
    for (const ViewDetections& view : measurements.views) {
        std::vector<std::optional<Vector2d>> pixels(measurements.skin.modules.size());
        for (const LedDetection& detection : view.found) {
            const auto found = index.find(detection.module);
            if (found != index.end())
                pixels[found->second] = detection.pixel;
        }
        addSeparationsOfView(links, pixels, separations);
    }
    std::vector<std::optional<double>> result(links.size());
    for (std::size_t l = 0; l < links.size(); ++l) {
        if (static_cast<int>(separations[l].size()) >= minViews)
            result[l] = median(separations[l]);
    }
    return result;
}

SkinLayout layOutSkin(const Measurements& measurements, const GravityTable& gravity, const LayoutOptions& options) {
    SkinLayout layout{buildSkinGraph(measurements.skin), {}, {}, {}};
    const auto& links = layout.graph.links();
    CableEvidence evidence;
    evidence.R_a_b.resize(links.size());
    for (std::size_t l = 0; l < links.size(); ++l) {
        if (const auto rotation = gravity.relativeRotation(links[l].a, links[l].b, options.rotation))
            evidence.R_a_b[l] = rotation->R_c_n;
    }
    evidence.separation_pitches = linkSeparations(measurements, layout.graph, options.minSeparationViews);
    layout.verdicts = detectCables(measurements.skin, layout.graph, evidence, options.cables);
    layout.patches = findPatches(measurements.skin, layout.graph, layout.verdicts);
    layout.patchOf.resize(measurements.skin.modules.size());
    for (std::size_t k = 0; k < layout.patches.size(); ++k) {
        for (const std::size_t u : layout.patches[k].modules)
            layout.patchOf[u] = k;
    }
    return layout;
}

}  // namespace skincal
