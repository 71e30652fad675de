#include "tests/unit/skin/synthetic_skin.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace skincal {
namespace {

/// The port at which a neighbour in the tiling meets `port`: opposite where the template has one, else the same.
std::size_t partnerOf(const ModuleTemplate& type, std::size_t port) {
    for (std::size_t q = 0; q < type.ports.size(); ++q) {
        if ((type.ports[q] + type.ports[port]).norm() < 1e-9)
            return q;
    }
    return port;
}

}  // namespace

std::vector<unsigned> randomIds(Random& random, std::size_t count) {
    std::set<unsigned> drawn;
    while (drawn.size() < count)
        drawn.insert(static_cast<unsigned>(1 + random.index(10 * count)));
    std::vector<unsigned> ids(drawn.begin(), drawn.end());
    shuffle(random, ids);
    return ids;
}

KnownSkin growFlatSkin(Random& random, const ModuleTemplate& type, std::size_t modules) {
    constexpr double touching = 1e-5;
    KnownSkin flat;
    flat.skin.templates = {type};
    const std::vector<unsigned> ids = randomIds(random, modules);
    const auto place = [&](const Isometry3d& T_r_u) {
        flat.skin.modules.push_back({ModuleId(ids[flat.T_s_u.size()]), 0});
        flat.T_s_u.push_back(T_r_u);
    };
    place(makeIsometry(random.rotation(), random.normal3()));
    while (flat.T_s_u.size() < modules) {
        const Isometry3d T_r_u = flat.T_s_u[random.index(flat.T_s_u.size())];
        const std::size_t port = random.index(type.ports.size());
        const Vector3d& p_u = type.ports[port];
        const Vector3d& p_n = type.ports[partnerOf(type, port)];
        const Matrix3d R_u_n = flatNeighbourRotation(p_u, p_n);
        const Isometry3d T_r_n = T_r_u * makeIsometry(R_u_n, p_u - R_u_n * p_n);
        const bool taken = std::any_of(flat.T_s_u.begin(), flat.T_s_u.end(), [&](const Isometry3d& T) {
            return (T.translation() - T_r_n.translation()).norm() < type.portRadius();
        });
        if (!taken)
            place(T_r_n);
    }
    for (std::size_t u = 0; u < modules; ++u) {
        for (std::size_t n = 0; n < u; ++n) {
            for (std::size_t p = 0; p < type.ports.size(); ++p) {
                for (std::size_t q = 0; q < type.ports.size(); ++q) {
                    if ((flat.T_s_u[u] * type.ports[p] - flat.T_s_u[n] * type.ports[q]).norm() < touching) {
                        flat.skin.links.push_back({flat.skin.modules[u].id, static_cast<int>(p),
                                                   flat.skin.modules[n].id, static_cast<int>(q)});
                    }
                }
            }
        }
    }
    return flat;
}

Skin wire(const std::vector<unsigned>& ids, const std::vector<std::pair<std::size_t, std::size_t>>& edges) {
    Skin skin;
    ModuleTemplate star;
    star.name = "star";
    for (const unsigned id : ids)
        skin.modules.push_back({ModuleId(id), 0});
    std::vector<int> used(ids.size(), 0);
    for (const auto& [a, b] : edges) {
        const int a_port = used[a]++;
        const int b_port = used[b]++;
        skin.links.push_back({ModuleId(ids[a]), a_port, ModuleId(ids[b]), b_port});
    }
    const int ports = used.empty() ? 0 : *std::max_element(used.begin(), used.end());
    for (int p = 0; p < ports; ++p)
        star.ports.push_back(so3Exp({0, 0, 0.1 * p}) * Vector3d(0.01, 0, 0));
    skin.templates = {star};
    return skin;
}

Skin retold(Random& random, const Skin& skin) {
    Skin other = skin;
    shuffle(random, other.modules);
    const std::size_t links = other.links.size();
    for (std::size_t l = 0; l < links; ++l) {
        const Link link = other.links[l];
        const Link swapped{link.b, link.b_port, link.a, link.a_port, link.decided};
        if (random.uniform() < 0.5)
            other.links[l] = swapped;
        if (random.uniform() < 0.5)
            other.links.push_back(swapped);
    }
    shuffle(random, other.links);
    shuffle(random, other.hostLinks);
    return other;
}

CableEvidence noEvidence(const SkinGraph& graph) {
    CableEvidence evidence(graph.links().size());
    return evidence;
}

CableEvidence rotationEvidence(const SkinGraph& graph, const std::vector<Isometry3d>& T_r_u, Random& random,
                               double error) {
    CableEvidence evidence = noEvidence(graph);
    for (std::size_t l = 0; l < graph.links().size(); ++l) {
        const GraphLink& link = graph.links()[l];
        const Matrix3d R_a_b = T_r_u[link.a].linear().transpose() * T_r_u[link.b].linear();
        evidence.R_a_b[l] = R_a_b * so3Exp(random.direction() * random.uniform(0, error));
    }
    return evidence;
}

std::vector<std::vector<int>> allDistances(std::size_t size,
                                           const std::vector<std::pair<std::size_t, std::size_t>>& edges) {
    std::vector<std::vector<int>> d(size, std::vector<int>(size, 1'000'000));
    for (std::size_t i = 0; i < size; ++i)
        d[i][i] = 0;
    for (const auto& [a, b] : edges)
        d[a][b] = d[b][a] = std::min(d[a][b], 1);
    for (std::size_t k = 0; k < size; ++k) {
        for (std::size_t i = 0; i < size; ++i) {
            for (std::size_t j = 0; j < size; ++j)
                d[i][j] = std::min(d[i][j], d[i][k] + d[k][j]);
        }
    }
    return d;
}

std::vector<Patch> patchesOf(const Skin& skin) {
    const SkinGraph graph = buildSkinGraph(skin);
    return findPatches(skin, graph, detectCables(skin, graph, noEvidence(graph)));
}

}  // namespace skincal
