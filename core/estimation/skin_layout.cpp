#include "core/estimation/skin_layout.h"

#include <algorithm>
#include <stdexcept>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

/// Distance that the LEDs of two modules would have as neighbours, m. LEDs sit off centre, so it depends much on how
/// the modules are turned.
double neighbourDistance(const Skin& skin, const GraphLink& link, const std::optional<Matrix3d>& R_a_b) {
    const ModuleTemplate& a = skin.templateOf(link.a);
    const ModuleTemplate& b = skin.templateOf(link.b);
    const Vector3d& port_a = skin.port(link.a, link.a_port);
    const Vector3d& port_b = skin.port(link.b, link.b_port);
    const Matrix3d R = R_a_b.value_or(flatNeighbourRotation(port_a, port_b));
    return (port_a + R * (b.led - port_b) - a.led).norm();
}

/// What one view shows of links, in px per metre of the distance that neighbours have; nothing where it does not show
/// both ends.
struct ViewOfLinks {
    std::vector<std::optional<double>> scale;       ///< per link
    std::vector<std::vector<std::size_t>> linksOf;  ///< per module, the links that are shown
};

ViewOfLinks viewOfLinks(const std::vector<GraphLink>& links, const std::vector<double>& expected,
                        const std::vector<std::optional<Vector2d>>& pixels) {
    ViewOfLinks view{std::vector<std::optional<double>>(links.size()),
                     std::vector<std::vector<std::size_t>>(pixels.size())};
    for (std::size_t l = 0; l < links.size(); ++l) {
        if (!pixels[links[l].a] || !pixels[links[l].b] || expected[l] <= 0)
            continue;
        view.scale[l] = (*pixels[links[l].a] - *pixels[links[l].b]).norm() / expected[l];
        view.linksOf[links[l].a].push_back(l);
        view.linksOf[links[l].b].push_back(l);
    }
    return view;
}

/// A scale for each link from the links round about, but none of the two modules' own: a false detection spoils all
/// links of its module. Nothing where a view shows too little to compare with.
std::vector<double> scalesRoundAbout(const std::vector<GraphLink>& links, const ViewOfLinks& view) {
    std::vector<double> all;
    for (const auto& scale : view.scale) {
        if (scale)
            all.push_back(*scale);
    }
    if (all.size() < 3)
        return {};
    const double typical = median(all);
    std::vector<double> local(links.size(), typical);
    for (std::size_t l = 0; l < links.size(); ++l) {
        if (!view.scale[l])
            continue;
        std::vector<double> nearby;
        const auto own = [&](std::size_t module) { return module == links[l].a || module == links[l].b; };
        for (const std::size_t end : {links[l].a, links[l].b}) {
            for (const std::size_t next : view.linksOf[end]) {
                const std::size_t neighbour = links[next].a == end ? links[next].b : links[next].a;
                for (const std::size_t other : view.linksOf[neighbour]) {
                    if (!own(links[other].a) && !own(links[other].b))
                        nearby.push_back(*view.scale[other]);
                }
            }
        }
        if (nearby.size() >= 3)
            local[l] = median(nearby);
    }
    return local;
}

/// Separations seen in one view, added to those of each link that shows both its LEDs. Where most of a module's links
/// are long at once, its detection is false rather than all of them cables.
void addSeparationsOfView(const std::vector<GraphLink>& links, const ViewOfLinks& view, double tooLong,
                          std::vector<std::vector<double>>& separations) {
    const std::vector<double> local = scalesRoundAbout(links, view);
    if (local.empty())
        return;
    const auto isLong = [&](std::size_t l) { return *view.scale[l] > tooLong * local[l]; };
    std::vector<bool> isFalse(view.linksOf.size(), false);
    for (std::size_t u = 0; u < view.linksOf.size(); ++u) {
        const auto& own = view.linksOf[u];
        const auto longOnes = static_cast<std::size_t>(std::count_if(own.begin(), own.end(), isLong));
        isFalse[u] = longOnes >= 2 && 2 * longOnes > own.size();
    }
    for (std::size_t l = 0; l < links.size(); ++l) {
        if (view.scale[l] && local[l] > 0 && !isFalse[links[l].a] && !isFalse[links[l].b])
            separations[l].push_back(*view.scale[l] / local[l]);
    }
}

/// A joint moves a module against one neighbour and not against the others. Where it moved against all of them, its
/// accelerometer is broken, and what that says of the links proves nothing.
void forgetBrokenAccelerometers(const std::vector<GraphLink>& links, std::size_t modules, double limit,
                                CableEvidence& evidence) {
    std::vector<std::size_t> measured(modules, 0);
    std::vector<std::size_t> moving(modules, 0);
    for (std::size_t l = 0; l < links.size(); ++l) {
        for (const std::size_t end : {links[l].a, links[l].b}) {
            measured[end] += evidence.rotationResidual[l] ? 1 : 0;
            moving[end] += evidence.rotationResidual[l] && *evidence.rotationResidual[l] > limit ? 1 : 0;
        }
    }
    const auto broken = [&](std::size_t u) { return moving[u] >= 2 && moving[u] == measured[u]; };
    for (std::size_t l = 0; l < links.size(); ++l) {
        if (broken(links[l].a) || broken(links[l].b)) {
            evidence.R_a_b[l].reset();
            evidence.rotationResidual[l].reset();
        }
    }
}

}  // namespace

std::vector<std::optional<double>> linkSeparations(const Measurements& measurements, const SkinGraph& graph,
                                                   const std::vector<std::optional<Matrix3d>>& R_a_b, double tooLong,
                                                   int minViews) {
    const auto& links = graph.links();
    std::vector<double> expected;
    for (std::size_t l = 0; l < links.size(); ++l)
        expected.push_back(links[l].a == links[l].b ? 0 : neighbourDistance(measurements.skin, links[l], R_a_b[l]));
    const auto index = measurements.skin.indexById();
    std::vector<std::vector<double>> separations(links.size());
    for (const ViewDetections& view : measurements.views) {
        std::vector<std::optional<Vector2d>> pixels(measurements.skin.modules.size());
        for (const LedDetection& detection : view.found) {
            const auto found = index.find(detection.module);
            if (found != index.end())
                pixels[found->second] = detection.pixel;
        }
        addSeparationsOfView(links, viewOfLinks(links, expected, pixels), tooLong, separations);
    }
    std::vector<std::optional<double>> result(links.size());
    for (std::size_t l = 0; l < links.size(); ++l) {
        std::vector<double>& seen = separations[l];
        if (static_cast<int>(seen.size()) < minViews)
            continue;
        const auto quarter = seen.begin() + static_cast<std::ptrdiff_t>((seen.size() - 1) / 4);
        std::nth_element(seen.begin(), quarter, seen.end());
        result[l] = *quarter;
    }
    return result;
}

bool LayoutOptions::validate() const {
    return cables.validate() && rotation.validate() && minSeparationViews > 0;
}

SkinLayout layOutSkin(const Measurements& measurements, const GravityTable& gravity, const LayoutOptions& options,
                      const SolutionHistory& history) {
    if (!options.validate())
        throw std::logic_error("LayoutOptions out of range");
    SkinLayout layout{buildSkinGraph(measurements.skin), {}, {}, {}};
    const auto& links = layout.graph.links();
    CableEvidence evidence(links.size());
    if (!history.gaps.empty())
        evidence.gap = history.gaps;
    if (!history.refuted.empty())
        evidence.refuted = history.refuted;
    for (std::size_t l = 0; l < links.size(); ++l) {
        if (const auto rotation = relativeRotation(gravity, links[l].a, links[l].b, options.rotation)) {
            evidence.R_a_b[l] = rotation->R_c_n;
            evidence.rotationResidual[l] = rotation->residual_rms;
        }
    }
    forgetBrokenAccelerometers(links, measurements.skin.modules.size(), options.cables.maxRotationResidual, evidence);
    evidence.separation = linkSeparations(measurements, layout.graph, evidence.R_a_b, options.cables.maxSeparation,
                                          options.minSeparationViews);
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
