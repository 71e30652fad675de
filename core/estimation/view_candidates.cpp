#include "core/estimation/view_candidates.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

/// Something to look at: modules that face about the same way.
struct Facet {
    std::size_t patch = 0;
    std::vector<std::size_t> modules;
    Vector3d middle = Vector3d::Zero();
    Vector3d normal = Vector3d::UnitZ();
    Sentence name;
};

Facet facetOf(const AdviceBasis& basis, std::size_t patch, std::vector<std::size_t> modules) {
    Facet facet{patch, std::move(modules), Vector3d::Zero(), Vector3d::Zero(), {}};
    for (const std::size_t u : facet.modules) {
        facet.middle += basis.state.T_r_u[u]->translation() / static_cast<double>(facet.modules.size());
        facet.normal += basis.state.T_r_u[u]->linear().col(2) / static_cast<double>(facet.modules.size());
    }
    return facet;
}

Sentence nameOfModule(const BodySolution& solution, std::size_t u) {
    return Sentence::saying("module {} of patch {}", solution.measurements->skin.modules[u].id.value,
                            solution.layout.patches[solution.layout.patchOf[u]].id.value);
}

/// A patch that faces one way is one facet; else modules gather about those whose normals differ most.
std::vector<Facet> facetsOf(const BodySolution& solution, const AdviceBasis& basis, std::size_t k) {
    std::vector<std::size_t> modules;
    for (const std::size_t u : solution.layout.patches[k].modules) {
        if (basis.isPlaced(u))
            modules.push_back(u);
    }
    if (modules.empty())
        return {};
    Facet whole = facetOf(basis, k, modules);
    constexpr double kFacesOneWay = 0.6;
    if (whole.normal.norm() > kFacesOneWay) {
        whole.normal.normalize();
        whole.name = Sentence::saying("patch {}", solution.layout.patches[k].id.value);
        return {whole};
    }
    const auto normal = [&](std::size_t u) -> Vector3d { return basis.state.T_r_u[u]->linear().col(2); };
    std::vector<std::size_t> seeds{modules.front()};
    const auto nearest = [&](std::size_t u) {
        return *std::max_element(seeds.begin(), seeds.end(), [&](std::size_t a, std::size_t b) {
            return normal(a).dot(normal(u)) < normal(b).dot(normal(u));
        });
    };
    constexpr std::size_t kMost = 6;
    constexpr double kNearEnough = 0.7;
    while (seeds.size() < kMost) {
        const auto far = *std::min_element(modules.begin(), modules.end(), [&](std::size_t a, std::size_t b) {
            return normal(a).dot(normal(nearest(a))) < normal(b).dot(normal(nearest(b)));
        });
        if (normal(far).dot(normal(nearest(far))) > kNearEnough)
            break;
        seeds.push_back(far);
    }
    std::vector<Facet> facets;
    for (const std::size_t seed : seeds) {
        std::vector<std::size_t> own;
        std::copy_if(modules.begin(), modules.end(), std::back_inserter(own),
                     [&](std::size_t u) { return nearest(u) == seed; });
        Facet facet = facetOf(basis, k, std::move(own));
        facet.normal = normal(seed);
        facet.name = nameOfModule(solution, seed);
        facets.push_back(std::move(facet));
    }
    return facets;
}

Facet facetOfModule(const BodySolution& solution, const AdviceBasis& basis, std::size_t u) {
    Facet facet = facetOf(basis, solution.layout.patchOf[u], {u});
    facet.name = nameOfModule(solution, u);
    return facet;
}

double typicalDistance(const BodySolution& solution, const AdviceBasis& basis, double otherwise) {
    std::vector<double> distances;
    for (const PixelObservation& o : basis.used.pixels)
        distances.push_back(
            (basis.state.T_r_u[o.module]->translation() - basis.state.T_r_v[o.view]->translation()).norm());
    return distances.empty() || solution.gauge.views.empty() ? otherwise : median(std::move(distances));
}

/// Any direction across n, near to `hint` where that has a part across.
Vector3d across(const Vector3d& n, const Vector3d& hint) {
    const Vector3d part = hint - hint.dot(n) * n;
    return part.norm() > 1e-6 ? Vector3d(part.normalized()) : n.unitOrthogonal();
}

Isometry3d lookAt(const Vector3d& from, const Vector3d& to, const Vector3d& wide) {
    const Vector3d z = (to - from).normalized();
    const Vector3d x = across(z, wide);
    Matrix3d R;
    R << x, z.cross(x), z;
    return makeIsometry(R, from);
}

struct Maker {
    const BodySolution& solution;
    const AdviceBasis& basis;
    const ViewCandidateOptions& options;
    double distance = 0;
    std::vector<Facet> facets{};
    std::vector<ViewCandidate> made{};

    /// What lies that way of a target, in words: another patch, or else the module at the target's edge.
    [[nodiscard]] Sentence nameOfSide(const Facet& target, const std::vector<std::size_t>& own,
                                      const Vector3d& side) const {
        constexpr double kThatWay = 0.8;
        const Facet* nearest = nullptr;
        for (const Facet& facet : facets) {
            const Vector3d to = facet.middle - target.middle;
            if (std::find(own.begin(), own.end(), facet.patch) == own.end() && to.normalized().dot(side) > kThatWay &&
                (nearest == nullptr || to.norm() < (nearest->middle - target.middle).norm()))
                nearest = &facet;
        }
        if (nearest != nullptr)
            return nearest->name;
        const auto edge =
            *std::max_element(target.modules.begin(), target.modules.end(), [&](std::size_t a, std::size_t b) {
                return basis.state.T_r_u[a]->translation().dot(side) < basis.state.T_r_u[b]->translation().dot(side);
            });
        return Sentence::saying("its edge at module {}", solution.measurements->skin.modules[edge].id.value);
    }

    /// From where the picture holds all of it, seen straight.
    [[nodiscard]] double distanceFor(const Facet& target) const {
        const CameraModel& camera = solution.measurements->camera;
        double extent = 0;
        for (const std::size_t u : target.modules)
            extent = std::max(extent, (basis.state.T_r_u[u]->translation() - target.middle).norm());
        constexpr double kUsedShare = 0.85;
        return std::max(distance, extent * camera.fx / (kUsedShare * 0.5 * camera.width));
    }

    void add(const Facet& target, const std::vector<std::size_t>& own, const Vector3d& wide) {
        const double away = distanceFor(target);
        std::vector<PatchId> patches;
        for (const std::size_t k : own)
            patches.push_back(solution.layout.patches[k].id);
        const Vector3d x = across(target.normal, wide);
        const Vector3d y = target.normal.cross(x);
        const auto put = [&](const Vector3d& direction, const Sentence& tilted) {
            const Vector3d from = target.middle + away * direction;
            made.push_back({lookAt(from, target.middle, wide), patches,
                            Sentence::saying("{:.0f} cm in front of {}, {}", away * 100, target.name, tilted)});
        };
        put(target.normal, Sentence::saying("looking straight at it"));
        for (const Vector3d& side : {x, Vector3d(-x), y, Vector3d(-y)}) {
            const Vector3d direction = std::cos(options.tilt) * target.normal + std::sin(options.tilt) * side;
            put(direction, Sentence::saying("then {:.0f}° around it towards {}", options.tilt / kDegree,
                                            nameOfSide(target, own, side)));
        }
    }

    void addStraight(const Facet& target) {
        const Vector3d from = target.middle + distance * target.normal;
        made.push_back(
            {lookAt(from, target.middle, target.normal.unitOrthogonal()),
             {solution.layout.patches[target.patch].id},
             Sentence::saying("{:.0f} cm in front of {}, looking straight at it", distance * 100, target.name)});
    }

    /// The facets of other patches that can be looked at together with one, the nearest first.
    [[nodiscard]] std::vector<std::size_t> neighboursOf(std::size_t i) const {
        std::vector<std::size_t> others;
        for (std::size_t j = 0; j < facets.size(); ++j) {
            if (facets[j].patch != facets[i].patch &&
                facets[j].normal.dot(facets[i].normal) > std::cos(options.maxTurn))
                others.push_back(j);
        }
        std::stable_sort(others.begin(), others.end(), [&](std::size_t a, std::size_t b) {
            return (facets[a].middle - facets[i].middle).norm() < (facets[b].middle - facets[i].middle).norm();
        });
        return others;
    }

    void addAll() {
        constexpr std::size_t kNeighbours = 2;
        for (std::size_t i = 0; i < facets.size(); ++i) {
            const auto neighbours = neighboursOf(i);
            const Facet& facet = facets[i];
            add(facet, {facet.patch},
                neighbours.empty() ? Vector3d(facet.normal.unitOrthogonal())
                                   : Vector3d(facets[neighbours.front()].middle - facet.middle));
            for (std::size_t n = 0; n < std::min(kNeighbours, neighbours.size()); ++n) {
                const std::size_t j = neighbours[n];
                const auto back = neighboursOf(j);
                const auto end = back.begin() + static_cast<std::ptrdiff_t>(std::min(kNeighbours, back.size()));
                // A pair that is each other's neighbour is added once.
                if (j < i && std::find(back.begin(), end, i) != end)
                    continue;
                addBetween(facet, facets[j]);
            }
        }
    }

    void addBetween(const Facet& a, const Facet& b) {
        const Vector3d normal = a.normal + b.normal;
        if (normal.norm() < 0.1)
            return;
        Facet both{a.patch, a.modules, 0.5 * (a.middle + b.middle), normal.normalized(), {}};
        both.modules.insert(both.modules.end(), b.modules.begin(), b.modules.end());
        both.name = Sentence::saying("the middle between {} and {}", a.name, b.name);
        add(both, {a.patch, b.patch}, b.middle - a.middle);
    }
};

}  // namespace

std::vector<ViewCandidate> viewCandidates(const BodySolution& solution, const AdviceBasis& basis,
                                          const std::vector<std::size_t>& modules,
                                          const ViewCandidateOptions& options) {
    Maker maker{solution, basis, options, typicalDistance(solution, basis, options.distance)};
    for (std::size_t k = 0; k < solution.layout.patches.size(); ++k) {
        for (Facet& facet : facetsOf(solution, basis, k))
            maker.facets.push_back(std::move(facet));
    }
    maker.addAll();
    for (const std::size_t u : modules)
        maker.addStraight(facetOfModule(solution, basis, u));
    return std::move(maker.made);
}

}  // namespace skincal
