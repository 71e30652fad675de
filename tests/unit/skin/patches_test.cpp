#include "core/skin/patches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <numeric>
#include <set>

#include "tests/unit/skin/grids.h"

namespace skincal {
namespace {

using test::link;
using testing::ElementsAre;

std::size_t bruteForceCentre(const std::vector<std::vector<int>>& distances) {
    std::size_t best = 0;
    int bestSum = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const int sum = std::accumulate(distances[i].begin(), distances[i].end(), 0);
        if (sum < bestSum) {
            bestSum = sum;
            best = i;
        }
    }
    return best;
}

AdjacencyLists listsOf(std::size_t size, const std::set<std::pair<std::size_t, std::size_t>>& edges) {
    AdjacencyLists lists;
    lists.first.push_back(0);
    for (std::size_t n = 0; n < size; ++n) {
        for (const auto& [a, b] : edges) {
            if (a == n || b == n)
                lists.neighbour.push_back(a == n ? b : a);
        }
        lists.first.push_back(lists.neighbour.size());
    }
    return lists;
}

TEST(MostCentralNode, EqualsBruteForceOnRandomConnectedGraphs) {
    Random random(1, "central");
    for (int round = 0; round < 400; ++round) {
        const std::size_t size = 1 + random.index(60);
        std::set<std::pair<std::size_t, std::size_t>> edges;
        // A random tree, from a chain to a star, and some edges more.
        const double bushiness = random.uniform();
        for (std::size_t n = 1; n < size; ++n)
            edges.emplace(random.uniform() < bushiness ? random.index(n) : n - 1, n);
        for (std::size_t extra = random.index(size); size > 2 && extra > 0; --extra) {
            const std::size_t a = random.index(size);
            const std::size_t b = random.index(size);
            if (a != b)
                edges.insert(std::minmax(a, b));
        }
        EXPECT_EQ(mostCentralNode(listsOf(size, edges)),
                  bruteForceCentre(allDistances(size, {edges.begin(), edges.end()})))
            << round;
    }
}

TEST(MostCentralNode, TheFirstOfEquals) {
    for (std::size_t size : {2U, 3U, 8U, 31U}) {
        std::set<std::pair<std::size_t, std::size_t>> ring;
        for (std::size_t n = 0; n < size; ++n)
            ring.insert(std::minmax(n, (n + 1) % size));
        EXPECT_EQ(mostCentralNode(listsOf(size, ring)), 0U) << size;
    }
    // The two in the middle of a chain of four are equals.
    EXPECT_EQ(mostCentralNode(listsOf(4, {{0, 2}, {2, 1}, {1, 3}})), 1U);
}

TEST(MostCentralNode, AnEmptyGraphHasNone) {
    EXPECT_THROW((void)mostCentralNode({}), std::logic_error);
    EXPECT_THROW((void)mostCentralNode({{0}, {}}), std::logic_error);
}

TEST(FindPatches, EveryPlanarGridIsOnePatchWithAShortestPathTree) {
    for (const KnownSkin& grid : {test::hexagonGrid(5, 5), test::rectangleGrid(7, 3), test::triangleGrid(4, 4)}) {
        const SkinGraph graph = buildSkinGraph(grid.skin);
        std::set<std::pair<std::size_t, std::size_t>> edges;
        for (const GraphLink& l : graph.links())
            edges.insert(std::minmax(l.a, l.b));
        const auto distances = allDistances(grid.skin.modules.size(), {edges.begin(), edges.end()});

        const auto patches = patchesOf(grid.skin);
        ASSERT_EQ(patches.size(), 1U);
        const Patch& patch = patches[0];
        EXPECT_EQ(patch.id, PatchId(0));
        EXPECT_EQ(patch.modules.size(), grid.skin.modules.size());
        EXPECT_EQ(patch.origin, bruteForceCentre(distances));
        ASSERT_EQ(patch.tree.size(), grid.skin.modules.size() - 1);
        // Walking down the tree with flat neighbours arrives where the grid has each module, over a shortest path.
        std::vector<std::optional<Isometry3d>> T_s_u(grid.skin.modules.size());
        T_s_u[patch.origin] = grid.T_s_u[patch.origin];
        std::vector<int> depth(grid.skin.modules.size(), 0);
        for (const TreeEdge& edge : patch.tree) {
            ASSERT_TRUE(T_s_u[edge.parent]);
            ASSERT_FALSE(T_s_u[edge.child]);
            const GraphLink& l = graph.links()[edge.link];
            ASSERT_EQ(std::minmax(l.a, l.b), std::minmax(edge.parent, edge.child));
            const bool forward = l.a == edge.parent;
            const Vector3d p = test::portOf(grid.skin, edge.parent, forward ? l.a_port : l.b_port);
            const Vector3d c = test::portOf(grid.skin, edge.child, forward ? l.b_port : l.a_port);
            const Matrix3d R = flatNeighbourRotation(p, c);
            T_s_u[edge.child] = *T_s_u[edge.parent] * makeIsometry(R, p - R * c);
            depth[edge.child] = depth[edge.parent] + 1;
        }
        for (std::size_t m = 0; m < grid.skin.modules.size(); ++m) {
            EXPECT_EQ(depth[m], distances[patch.origin][m]);
            EXPECT_LT(poseDifference(*T_s_u[m], grid.T_s_u[m]).angle, 1e-9);
            EXPECT_LT(poseDifference(*T_s_u[m], grid.T_s_u[m]).distance, 1e-9);
        }
    }
}

TEST(FindPatches, ALoneModuleIsAPatch) {
    const auto patches = patchesOf(test::looseModules(paperHexagon(), 1));
    ASSERT_EQ(patches.size(), 1U);
    EXPECT_THAT(patches[0].modules, ElementsAre(0));
    EXPECT_TRUE(patches[0].tree.empty());
    EXPECT_TRUE(patchesOf(Skin{}).empty());
}

TEST(FindPatches, TwoModulesWithOneLink) {
    Skin skin = test::looseModules(paperHexagon(), 2);
    for (const auto& links : {std::vector{link(2, 3, 1, 0)}, std::vector{link(2, 3, 1, 0), link(1, 0, 2, 3)}}) {
        skin.links = links;
        const auto patches = patchesOf(skin);
        ASSERT_EQ(patches.size(), 1U);
        EXPECT_EQ(patches[0].origin, 0U);
        ASSERT_EQ(patches[0].tree.size(), 1U);
        EXPECT_EQ(patches[0].tree[0].child, 1U);
    }
}

TEST(FindPatches, ARingIsOnePatchThatOpensOppositeItsOrigin) {
    Skin skin = test::looseModules(paperHexagon(), 8);
    for (unsigned i = 0; i < 8; ++i)
        skin.links.push_back(link(i + 1, 0, (i + 1) % 8 + 1, 3));
    const auto patches = patchesOf(skin);
    ASSERT_EQ(patches.size(), 1U);
    EXPECT_EQ(patches[0].origin, 0U);
    // The farthest module is reached from the smaller of its two neighbours.
    const TreeEdge& last = patches[0].tree.back();
    EXPECT_EQ(last.child, 4U);
    EXPECT_EQ(last.parent, 3U);
}

TEST(FindPatches, CablesSeparateAndPatchesAreNumberedByTheirSmallestId) {
    Skin skin = test::looseModules(paperHexagon(), 6);
    for (std::size_t i = 0; i < 6; ++i)
        skin.modules[i].id = ModuleId(static_cast<std::uint32_t>(60 - 10 * i));
    skin.links = {link(60, 0, 50, 3), link(50, 0, 40, 3, LinkKind::Cable), link(40, 0, 20, 3), link(30, 0, 10, 3)};
    const auto patches = patchesOf(skin);
    ASSERT_EQ(patches.size(), 3U);
    EXPECT_THAT(patches[0].modules, ElementsAre(5, 3));
    EXPECT_THAT(patches[1].modules, ElementsAre(4, 2));
    EXPECT_THAT(patches[2].modules, ElementsAre(1, 0));
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(patches[k].id.value, k);
}

/// A patch in words that do not depend on positions.
struct Told {
    ModuleId origin;
    std::vector<ModuleId> modules;
    std::vector<std::array<ModuleId, 2>> tree;
    std::vector<std::array<int, 2>> ports;  ///< of each step, parent's first

    friend bool operator==(const Told&, const Told&) = default;
};

std::vector<Told> tell(const Skin& skin) {
    const SkinGraph graph = buildSkinGraph(skin);
    std::vector<Told> result;
    for (const Patch& patch : patchesOf(skin)) {
        Told told{skin.modules[patch.origin].id, {}, {}, {}};
        for (const std::size_t m : patch.modules)
            told.modules.push_back(skin.modules[m].id);
        for (const TreeEdge& e : patch.tree) {
            told.tree.push_back({skin.modules[e.parent].id, skin.modules[e.child].id});
            const GraphLink& l = graph.links()[e.link];
            told.ports.push_back(l.a == e.parent ? std::array{l.a_port, l.b_port} : std::array{l.b_port, l.a_port});
        }
        result.push_back(std::move(told));
    }
    return result;
}

TEST(FindPatches, OrderOfModulesAndLinksMakesNoDifference) {
    Random random(2, "order");
    for (int round = 0; round < 30; ++round) {
        Skin skin = test::hexagonGrid(6, 5).skin;
        // Ids with gaps that say nothing about places, some links cut, and two links between the same two modules.
        shuffle(random, skin.modules);
        std::erase_if(skin.links, [&](const Link&) { return random.uniform() < 0.2; });
        skin.modules.push_back({ModuleId(1000), 0});
        skin.modules.push_back({ModuleId(1001), 0});
        skin.links.push_back(link(1000, 0, 1001, 3));
        skin.links.push_back(link(1000, 1, 1001, 2));
        const auto expected = tell(skin);
        for (int k = 0; k < 5; ++k)
            EXPECT_EQ(tell(retold(random, skin)), expected);
    }
}

TEST(FindPatches, TenThousandModules) {
    const Skin skin = test::hexagonGrid(100, 100).skin;
    const auto patches = patchesOf(skin);
    ASSERT_EQ(patches.size(), 1U);
    // Row and column 49 (from 0) are the first of the two in the middle.
    EXPECT_EQ(patches[0].origin, 49U * 100 + 49);
    EXPECT_EQ(patches[0].tree.size(), 9999U);
}

TEST(FindPatches, VerdictsOfAnotherGraphThrow) {
    const Skin skin = test::hexagonGrid(2, 2).skin;
    EXPECT_THROW((void)findPatches(skin, buildSkinGraph(skin), {}), std::logic_error);
}

}  // namespace
}  // namespace skincal
