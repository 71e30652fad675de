#include "core/estimation/skin_layout.h"

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

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

/// What one view shows of links, in px per metre of the distance that neighbours have. Made once for all views: a view
/// costs what it shows, not what there is.
class ViewOfLinks {
  public:
    ViewOfLinks(const std::vector<GraphLink>& links, std::vector<double> expected, std::size_t modules)
        : links_(links),
          expected_(std::move(expected)),
          pixels_(modules),
          linksAt_(modules),
          linksOf_(modules),
          scale_(links.size()) {
        for (std::size_t l = 0; l < links.size(); ++l)
            linksAt_[links[l].a].push_back(l);
    }

    void show(const std::vector<std::pair<std::size_t, Vector2d>>& detections) {
        for (const std::size_t u : seen_) {
            pixels_[u].reset();
            linksOf_[u].clear();
        }
        seen_.clear();
        shown_.clear();
        for (const auto& [u, pixel] : detections) {
            if (!pixels_[u])
                seen_.push_back(u);
            pixels_[u] = pixel;
        }
        for (const std::size_t u : seen_) {
            for (const std::size_t l : linksAt_[u]) {
                if (pixels_[links_[l].b] && expected_[l] > 0)
                    shown_.push_back(l);
            }
        }
        std::sort(shown_.begin(), shown_.end());
        for (const std::size_t l : shown_) {
            scale_[l] = (*pixels_[links_[l].a] - *pixels_[links_[l].b]).norm() / expected_[l];
            linksOf_[links_[l].a].push_back(l);
            linksOf_[links_[l].b].push_back(l);
        }
    }

    [[nodiscard]] const std::vector<std::size_t>& shown() const { return shown_; }  ///< links with both ends
    [[nodiscard]] const std::vector<std::size_t>& linksOf(std::size_t module) const { return linksOf_[module]; }
    [[nodiscard]] double scale(std::size_t link) const { return scale_[link]; }  ///< of one that is shown

  private:
    const std::vector<GraphLink>& links_;
    std::vector<double> expected_;
    std::vector<std::optional<Vector2d>> pixels_;
    std::vector<std::vector<std::size_t>> linksAt_;  ///< per module, those of which it is end a
    std::vector<std::vector<std::size_t>> linksOf_;
    std::vector<double> scale_;
    std::vector<std::size_t> seen_;
    std::vector<std::size_t> shown_;
};

/// A scale for each link that a view shows from the links round about, but none of the two modules' own: a false
/// detection spoils all links of its module. Nothing where a view shows too little to compare with.
std::vector<double> scalesRoundAbout(const std::vector<GraphLink>& links, const ViewOfLinks& view) {
    std::vector<double> all;
    for (const std::size_t l : view.shown())
        all.push_back(view.scale(l));
    if (all.size() < 3)
        return {};
    std::vector<double> local(all.size(), median(all));
    for (std::size_t i = 0; i < local.size(); ++i) {
        const GraphLink& link = links[view.shown()[i]];
        std::vector<double> nearby;
        const auto own = [&](std::size_t module) { return module == link.a || module == link.b; };
        for (const std::size_t end : {link.a, link.b}) {
            for (const std::size_t next : view.linksOf(end)) {
                const std::size_t neighbour = links[next].a == end ? links[next].b : links[next].a;
                for (const std::size_t other : view.linksOf(neighbour)) {
                    if (!own(links[other].a) && !own(links[other].b))
                        nearby.push_back(view.scale(other));
                }
            }
        }
        if (nearby.size() >= 3)
            local[i] = median(nearby);
    }
    return local;
}

/// What the views tell of a link.
struct Separations {
    std::vector<double> seen;  ///< one per view that shows both LEDs
    bool proven = false;       ///< in one view at least neither LED can be a false detection
};

/// Separations seen in one view, added to those of each link that shows both its LEDs. Where most of a module's links
/// are long at once, its detection is false rather than all of them cables; where at least two are as long as they
/// should be, or all but one, it is right: a false one hardly ever lies beside a neighbour, let alone beside two.
void addSeparationsOfView(const std::vector<GraphLink>& links, const ViewOfLinks& view, double tooLong,
                          std::vector<Separations>& separations) {
    const std::vector<double> local = scalesRoundAbout(links, view);
    if (local.empty())
        return;
    struct Count {
        std::size_t all = 0, tooLong = 0;
        [[nodiscard]] bool isRight() const { return all - tooLong >= 2 || (all == 2 && tooLong == 1); }
        [[nodiscard]] bool isFalse() const { return tooLong >= 2 && 2 * tooLong > all; }
    };
    std::unordered_map<std::size_t, Count> counts;  // per module
    for (std::size_t i = 0; i < local.size(); ++i) {
        const std::size_t l = view.shown()[i];
        for (const std::size_t end : {links[l].a, links[l].b}) {
            ++counts[end].all;
            counts[end].tooLong += view.scale(l) > tooLong * local[i] ? 1 : 0;
        }
    }
    for (std::size_t i = 0; i < local.size(); ++i) {
        const std::size_t l = view.shown()[i];
        const Count& a = counts[links[l].a];
        const Count& b = counts[links[l].b];
        if (local[i] <= 0 || a.isFalse() || b.isFalse())
            continue;
        separations[l].seen.push_back(view.scale(l) / local[i]);
        separations[l].proven = separations[l].proven || (a.isRight() && b.isRight());
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
    std::vector<Separations> separations(links.size());
    ViewOfLinks shown(links, std::move(expected), measurements.skin.modules.size());
    for (const ViewDetections& view : measurements.views) {
        std::vector<std::pair<std::size_t, Vector2d>> detections;
        for (const LedDetection& detection : view.found) {
            const auto found = index.find(detection.module);
            if (found != index.end())
                detections.emplace_back(found->second, detection.pixel);
        }
        shown.show(detections);
        addSeparationsOfView(links, shown, tooLong, separations);
    }
    std::vector<std::optional<double>> result(links.size());
    for (std::size_t l = 0; l < links.size(); ++l) {
        std::vector<double>& seen = separations[l].seen;
        if (static_cast<int>(seen.size()) + (separations[l].proven ? 1 : 0) < minViews)
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
