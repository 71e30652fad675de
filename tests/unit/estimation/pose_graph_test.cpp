#include "core/estimation/pose_graph.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"
#include "tests/unit/estimation/synthetic.h"

namespace skincal {
namespace {

struct World {
    std::vector<Isometry3d> T_r_n;
    std::vector<PoseEdge> edges;
};

PoseEdge measure(Random& random, const std::vector<Isometry3d>& T_r_n, std::size_t from, std::size_t to, double angle,
                 double distance) {
    PoseEdge edge;
    edge.from = from;
    edge.to = to;
    edge.T_from_to = T_r_n[from].inverse() * T_r_n[to];
    edge.T_from_to.linear() = edge.T_from_to.linear() * so3Exp(random.normal3() * angle);
    edge.T_from_to.translation() += random.normal3() * distance;
    // No two alike, so that the tree is unique.
    edge.sigmaRotation = std::max(angle, 1e-4) * random.uniform(0.9, 1.1);
    edge.sigmaTranslation = std::max(distance, 1e-5) * random.uniform(0.9, 1.1);
    return edge;
}

/// A random tree over all nodes and `loops` edges more. Node 0 has the pose identity.
World randomWorld(Random& random, std::size_t nodes, std::size_t loops, double angle = 0, double distance = 0) {
    World world;
    world.T_r_n.push_back(Isometry3d::Identity());
    for (std::size_t n = 1; n < nodes; ++n)
        world.T_r_n.push_back(makeIsometry(random.rotation(), random.normal3()));
    for (std::size_t n = 1; n < nodes; ++n) {
        const std::size_t other = random.index(n);
        const bool forward = random.uniform() < 0.5;
        world.edges.push_back(measure(random, world.T_r_n, forward ? other : n, forward ? n : other, angle, distance));
    }
    while (world.edges.size() < nodes - 1 + loops) {
        const std::size_t a = random.index(nodes);
        const std::size_t b = random.index(nodes);
        if (a != b)
            world.edges.push_back(measure(random, world.T_r_n, a, b, angle, distance));
    }
    return world;
}

double meanSquareAngle(const std::vector<std::optional<Isometry3d>>& found, const std::vector<Isometry3d>& truth) {
    double sum = 0;
    for (std::size_t n = 0; n < truth.size(); ++n)
        sum += std::pow(poseDifference(found[n].value(), truth[n]).angle, 2);
    return sum / static_cast<double>(truth.size());
}

double meanSquareDistance(const std::vector<std::optional<Isometry3d>>& found, const std::vector<Isometry3d>& truth) {
    double sum = 0;
    for (std::size_t n = 0; n < truth.size(); ++n)
        sum += std::pow(poseDifference(found[n].value(), truth[n]).distance, 2);
    return sum / static_cast<double>(truth.size());
}

TEST(SpanningTreePoses, ExactEdgesGiveExactPoses) {
    Random random(1, "tree");
    for (int i = 0; i < 100; ++i) {
        const World world = randomWorld(random, 2 + random.index(20), random.index(20));
        const auto poses = spanningTreePoses(world.T_r_n.size(), world.edges, 0);
        EXPECT_LT(largestDifference(poses, world.T_r_n).angle, 1e-7);
        EXPECT_LT(largestDifference(poses, world.T_r_n).distance, 1e-9);
    }
}

TEST(SpanningTreePoses, AnyRootMayBeTheFrame) {
    Random random(2, "root");
    const World world = randomWorld(random, 12, 6);
    for (std::size_t root = 0; root < 12; ++root) {
        const auto poses = spanningTreePoses(12, world.edges, root);
        for (std::size_t n = 0; n < 12; ++n) {
            const PoseDifference d = poseDifference(*poses[n], world.T_r_n[root].inverse() * world.T_r_n[n]);
            EXPECT_LT(d.angle + d.distance, 1e-7);
        }
    }
    EXPECT_THROW((void)spanningTreePoses(12, world.edges, 12), std::logic_error);
}

TEST(SpanningTreePoses, PrefersTheMostCertainEdges) {
    Random random(3, "certain");
    for (int i = 0; i < 50; ++i) {
        World world = randomWorld(random, 10, 0);
        // Ten wrong edges that admit it; the lever turns their rotation into metres.
        for (int k = 0; k < 10; ++k) {
            PoseEdge wrong = measure(random, world.T_r_n, random.index(5), 5 + random.index(5), 1, 1);
            wrong.sigmaRotation = 1;
            wrong.sigmaTranslation = 1e-6;
            world.edges.insert(world.edges.begin(), wrong);
        }
        EXPECT_LT(largestDifference(spanningTreePoses(10, world.edges, 0), world.T_r_n).angle, 1e-7);
    }
}

TEST(SpanningTreePoses, OrderOfEdgesMakesNoDifference) {
    Random random(4, "order");
    for (int i = 0; i < 50; ++i) {
        World world = randomWorld(random, 12, 12, 0.05, 0.01);
        const auto expected = spanningTreePoses(12, world.edges, 0);
        const auto averaged = averagePoses(world.edges, expected, 0);
        std::reverse(world.edges.begin(), world.edges.end());
        std::swap(world.edges[0], world.edges[random.index(world.edges.size())]);
        const auto poses = spanningTreePoses(12, world.edges, 0);
        const auto again = averagePoses(world.edges, poses, 0);
        for (std::size_t n = 0; n < 12; ++n) {
            EXPECT_EQ(poses[n]->matrix(), expected[n]->matrix());
            EXPECT_LT((again[n]->matrix() - averaged[n]->matrix()).norm(), 1e-7);
        }
    }
}

TEST(SpanningTreePoses, OtherPartsStayUnknown) {
    Random random(5, "parts");
    World world = randomWorld(random, 6, 0);
    std::erase_if(world.edges, [](const PoseEdge& e) { return e.from == 5 || e.to == 5; });
    world.edges.push_back(measure(random, world.T_r_n, 4, 4, 0, 0));
    const auto part = connectedParts(8, world.edges);
    auto poses = spanningTreePoses(8, world.edges, 0);
    for (std::size_t n = 0; n < 8; ++n)
        EXPECT_EQ(poses[n].has_value(), part[n] == part[0]);
    EXPECT_FALSE(poses[5] || poses[6] || poses[7]);
    const auto averaged = averagePoses(world.edges, poses, 0);
    for (std::size_t n = 0; n < 8; ++n)
        EXPECT_EQ(averaged[n].has_value(), poses[n].has_value());
}

TEST(ConnectedParts, AreNumberedByTheirSmallestNode) {
    PoseEdge edge;
    edge.from = 3;
    edge.to = 1;
    EXPECT_EQ(connectedParts(5, {edge}), (std::vector<std::size_t>{0, 1, 2, 1, 3}));
    EXPECT_TRUE(connectedParts(0, {}).empty());
}

TEST(AveragePoses, ExactPosesStayAndStartsNearbyReachThem) {
    Random random(6, "start");
    for (int i = 0; i < 50; ++i) {
        const World world = randomWorld(random, 10, 15);
        std::vector<std::optional<Isometry3d>> start(world.T_r_n.begin(), world.T_r_n.end());
        EXPECT_LT(largestDifference(averagePoses(world.edges, start, 0), world.T_r_n).angle, 1e-7);
        for (std::size_t n = 1; n < 10; ++n)
            start[n] = perturbed(random, *start[n], 0.1, 0.1);
        PoseAveragingOptions options;
        options.iterations = 200;
        options.loss = 1e4;
        const auto poses = averagePoses(world.edges, start, 0, options);
        EXPECT_LT(largestDifference(poses, world.T_r_n).angle, 1e-5);
        EXPECT_LT(largestDifference(poses, world.T_r_n).distance, 1e-5);
        EXPECT_EQ(poses[0]->matrix(), Isometry3d::Identity().matrix());
    }
}

TEST(AveragePoses, ClosesNoisyLoopsBetterThanATree) {
    Random random(7, "loops");
    double treeAngle = 0;
    double meanAngle = 0;
    double treeDistance = 0;
    double meanDistance = 0;
    for (int i = 0; i < 50; ++i) {
        const World world = randomWorld(random, 12, 40, 0.02, 0.005);
        const auto tree = spanningTreePoses(12, world.edges, 0);
        const auto mean = averagePoses(world.edges, tree, 0);
        treeAngle += meanSquareAngle(tree, world.T_r_n);
        meanAngle += meanSquareAngle(mean, world.T_r_n);
        treeDistance += meanSquareDistance(tree, world.T_r_n);
        meanDistance += meanSquareDistance(mean, world.T_r_n);
    }
    // Nine edges per node instead of two.
    EXPECT_LT(meanAngle, 0.4 * treeAngle);
    EXPECT_LT(meanDistance, 0.4 * treeDistance);
}

TEST(AveragePoses, OneWrongEdgeDoesNotBendALoop) {
    Random random(8, "wrong");
    for (int i = 0; i < 30; ++i) {
        World world = randomWorld(random, 8, 24, 0.002, 0.001);
        const auto start = std::vector<std::optional<Isometry3d>>(world.T_r_n.begin(), world.T_r_n.end());
        PoseEdge& wrong = world.edges.back();
        wrong.T_from_to = perturbed(random, wrong.T_from_to, 0.5, 0.3);
        const auto poses = averagePoses(world.edges, start, 0);
        EXPECT_LT(largestDifference(poses, world.T_r_n).angle, 0.02);
        EXPECT_LT(largestDifference(poses, world.T_r_n).distance, 0.05);
    }
}

TEST(AveragePoses, NothingToAverage) {
    const auto alone = averagePoses({}, {Isometry3d::Identity()}, 0);
    ASSERT_EQ(alone.size(), 1U);
    EXPECT_TRUE(alone[0]);
    for (const PoseAveragingOptions& options :
         {PoseAveragingOptions{0, 1e-7, 3}, PoseAveragingOptions{20, 0, 3}, PoseAveragingOptions{20, 1e-7, 0}})
        EXPECT_THROW((void)averagePoses({}, {Isometry3d::Identity()}, 0, options), std::logic_error);
}

}  // namespace
}  // namespace skincal
