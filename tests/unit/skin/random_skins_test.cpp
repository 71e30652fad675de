// What must hold for every skin, on random pieces of the three tilings and on random graphs.

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "core/skin/cable_detection.h"
#include "core/skin/patches.h"
#include "tests/unit/skin/synthetic_skin.h"

namespace skincal {
namespace {

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

/// A random tree over `size` nodes, long or bushy, and `extra` edges more: loops, parallel links, links to oneself.
Edges randomConnected(Random& random, std::size_t size, std::size_t extra) {
    Edges edges;
    const std::size_t reach = 1 + random.index(size);
    for (std::size_t i = 1; i < size; ++i)
        edges.emplace_back(i - 1 - random.index(std::min(i, reach)), i);
    for (std::size_t k = 0; k < extra; ++k)
        edges.emplace_back(random.index(size), random.index(size));
    return edges;
}

TEST(RandomSkins, FlatOnesAreAllNeighboursWhateverTheShape) {
    Random random(1, "tilings");
    const double error = 4 * kDegree;
    for (const auto& type : {paperHexagon(), triangleTemplate(), rectangleTemplate()}) {
        for (int i = 0; i < 10; ++i) {
            const KnownSkin flat = growFlatSkin(random, type, 5 + random.index(40));
            const SkinGraph graph = buildSkinGraph(flat.skin);
            const auto verdicts = detectCables(flat.skin, graph, rotationEvidence(graph, flat.T_s_u, random, error));
            for (const LinkVerdict& verdict : verdicts) {
                EXPECT_EQ(verdict.kind, LinkKind::Adjacent) << verdict.explanation;
                EXPECT_EQ(verdict.reason, LinkReason::Neighbours);
                ASSERT_TRUE(verdict.bend && verdict.twist);
                EXPECT_LE(*verdict.bend, error + 1e-6);
                EXPECT_LE(*verdict.twist, error + 1e-6);
            }
            EXPECT_EQ(findPatches(flat.skin, graph, verdicts).size(), 1U);
        }
    }
}

TEST(RandomSkins, BendsAndTwistsAreCutAtTheLimits) {
    Random random(2, "limits");
    const CableOptions options;
    KnownSkin flat = growFlatSkin(random, paperHexagon(), 2);
    const SkinGraph graph = buildSkinGraph(flat.skin);
    ASSERT_EQ(graph.links().size(), 1U);
    CableEvidence evidence = rotationEvidence(graph, flat.T_s_u, random);
    const Matrix3d R_flat = *evidence.R_a_b[0];
    int cables = 0;
    for (int i = 0; i < 1000; ++i) {
        const double bend = random.uniform(0, 160 * kDegree);
        const double twist = random.uniform(-160 * kDegree, 160 * kDegree);
        const double azimuth = random.uniform(-3.2, 3.2);
        evidence.R_a_b[0] = so3Exp(Vector3d(std::cos(azimuth), std::sin(azimuth), 0) * bend) *
                            so3Exp(Vector3d::UnitZ() * twist) * R_flat;
        const LinkVerdict verdict = detectCables(flat.skin, graph, evidence).at(0);
        const LinkReason expected = bend > options.maxBend               ? LinkReason::Bend
                                    : std::abs(twist) > options.maxTwist ? LinkReason::Twist
                                                                         : LinkReason::Neighbours;
        EXPECT_EQ(verdict.reason, expected) << bend / kDegree << " " << twist / kDegree;
        EXPECT_EQ(verdict.kind, expected == LinkReason::Neighbours ? LinkKind::Adjacent : LinkKind::Cable);
        cables += verdict.kind == LinkKind::Cable ? 1 : 0;
    }
    EXPECT_GT(cables, 500);
    EXPECT_LT(cables, 980);
}

TEST(RandomSkins, TreesAreShortestPathsFromTheMostCentralModule) {
    Random random(3, "trees");
    for (int i = 0; i < 200; ++i) {
        const std::size_t size = 1 + random.index(40);
        const Edges edges = randomConnected(random, size, random.index(size + 1));
        const std::vector<unsigned> ids = randomIds(random, size);
        const Skin skin = wire(ids, edges);
        const SkinGraph graph = buildSkinGraph(skin);
        const auto patches = patchesOf(skin);
        ASSERT_EQ(patches.size(), 1U);
        const Patch& patch = patches[0];
        const auto d = allDistances(size, edges);

        const auto cost = [&](std::size_t u) {
            return std::pair(std::accumulate(d[u].begin(), d[u].end(), 0), ids[u]);
        };
        for (std::size_t u = 0; u < size; ++u)
            EXPECT_LE(cost(patch.origin), cost(u));

        ASSERT_EQ(patch.tree.size(), size - 1);
        std::set<std::size_t> reached{patch.origin};
        int depth = 0;
        for (const TreeEdge& edge : patch.tree) {
            EXPECT_EQ(reached.count(edge.parent), 1U);
            EXPECT_TRUE(reached.insert(edge.child).second);
            EXPECT_EQ(d[patch.origin][edge.child], d[patch.origin][edge.parent] + 1);
            EXPECT_GE(d[patch.origin][edge.child], depth) << "breadth first";
            depth = d[patch.origin][edge.child];
            const GraphLink& link = graph.links().at(edge.link);
            EXPECT_EQ(std::minmax(link.a, link.b), std::minmax(edge.parent, edge.child));
            for (std::size_t u = 0; u < size; ++u) {
                if (d[u][edge.child] == 1 && d[patch.origin][u] == depth - 1) {
                    EXPECT_LE(ids[edge.parent], ids[u]);
                }
            }
        }
    }
}

TEST(RandomSkins, PatchesDependOnIdsAndLinksAloneNotOnTheirOrder) {
    Random random(4, "order");
    for (int i = 0; i < 100; ++i) {
        const std::size_t size = 2 + random.index(40);
        Edges edges;
        for (std::size_t k = 0; k < size + random.index(size); ++k)
            edges.emplace_back(random.index(size), random.index(size));
        const Skin skin = wire(randomIds(random, size), edges);
        // Origin, modules, and steps with their ports, all in ids.
        const auto told = [](const Skin& s) {
            const SkinGraph graph = buildSkinGraph(s);
            std::vector<std::vector<long>> result;
            const auto id = [&](std::size_t module) { return static_cast<long>(s.modules[module].id.value); };
            for (const Patch& patch : patchesOf(s)) {
                std::vector<long> numbers{static_cast<long>(patch.id.value), id(patch.origin)};
                for (const std::size_t u : patch.modules)
                    numbers.push_back(id(u));
                for (const TreeEdge& edge : patch.tree) {
                    const GraphLink& link = graph.links()[edge.link];
                    const bool forward = link.a == edge.parent;
                    for (const long n :
                         {id(edge.parent), id(edge.child), static_cast<long>(forward ? link.a_port : link.b_port),
                          static_cast<long>(forward ? link.b_port : link.a_port)})
                        numbers.push_back(n);
                }
                result.push_back(numbers);
            }
            return result;
        };
        const auto expected = told(skin);
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(told(retold(random, skin)), expected);
    }
}

TEST(RandomSkins, AStripOfTenThousandHasItsOriginInTheMiddle) {
    Edges line;
    for (std::size_t i = 1; i < 10'001; ++i)
        line.emplace_back(i - 1, i);
    std::vector<unsigned> ids(10'001);
    std::iota(ids.begin(), ids.end(), 1U);
    const auto patches = patchesOf(wire(ids, line));
    ASSERT_EQ(patches.size(), 1U);
    EXPECT_EQ(patches[0].origin, 5000U);
    EXPECT_EQ(patches[0].tree.size(), 10'000U);
}

}  // namespace
}  // namespace skincal
