#include "core/estimation/edge_rotation.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/adjustment/gravity_table.h"
#include "core/geometry/random.h"

namespace skincal {
namespace {

struct Edge {
    Matrix3d R_c_n;
    std::vector<Vector3d> g_c;
    std::vector<Vector3d> g_n;
};

Edge randomEdge(Random& random, std::size_t poses, double noise = 0) {
    Edge edge{random.rotation(), {}, {}};
    for (std::size_t p = 0; p < poses; ++p) {
        edge.g_n.push_back(random.direction() * kStandardGravity);
        edge.g_c.push_back(edge.R_c_n * edge.g_n.back() + random.normal3() * noise);
        edge.g_n.back() += random.normal3() * noise;
    }
    return edge;
}

ErrorCode codeOf(const std::vector<Vector3d>& c, const std::vector<Vector3d>& n) {
    const auto result = estimateRelativeRotation(c, n);
    if (result)
        throw std::logic_error("expected a failure");
    return result.error().code;
}

TEST(EdgeRotation, ExactReadingsGiveTheExactRotation) {
    Random random(1, "exact");
    for (int i = 0; i < 500; ++i) {
        const Edge edge = randomEdge(random, 3 + random.index(10));
        const auto found = estimateRelativeRotation(edge.g_c, edge.g_n);
        ASSERT_TRUE(found) << found.error().message();
        EXPECT_LT(rotationAngle(found->R_c_n.transpose() * edge.R_c_n), 1e-7);
        EXPECT_LT(found->residual_rms, 1e-7);
    }
}

TEST(EdgeRotation, TwoPosesAreEnough) {
    const Matrix3d R = so3Exp({0.3, -1, 0.2});
    const std::vector<Vector3d> g_n{{9.8, 0, 0}, {0, 9.8, 0}};
    const auto found = estimateRelativeRotation(std::vector<Vector3d>{R * g_n[0], R * g_n[1]}, g_n);
    ASSERT_TRUE(found);
    EXPECT_LT((found->R_c_n - R).norm(), 1e-9);
    EXPECT_NEAR(found->spread_rad, 90 * kDegree, 1e-9);
}

TEST(EdgeRotation, ErrorShrinksWithTheNoiseAndTheNumberOfPoses) {
    const auto rmsError = [](std::size_t poses, double noise) {
        Random random(poses, "noise");
        double squares = 0;
        constexpr int kRounds = 400;
        for (int i = 0; i < kRounds; ++i) {
            const Edge edge = randomEdge(random, poses, noise);
            const auto found = estimateRelativeRotation(edge.g_c, edge.g_n);
            squares += std::pow(rotationAngle(found.value().R_c_n.transpose() * edge.R_c_n), 2) / kRounds;
        }
        return std::sqrt(squares);
    };
    // Linearised: both ends are noisy, so each vector's direction is off by sqrt(2) sigma / g per axis; P poses of
    // mixed directions leave 3 * 2 (sigma / g)^2 / (2 P / 3) as the mean square of the angle.
    const double expected = std::sqrt(9.0 / 24) * 0.03 / kStandardGravity;
    EXPECT_NEAR(rmsError(24, 0.03), expected, 0.15 * expected);
    EXPECT_NEAR(rmsError(24, 0.3), 10 * expected, 1.5 * expected);
    EXPECT_NEAR(rmsError(96, 0.03), expected / 2, 0.1 * expected);
}

TEST(EdgeRotation, TurnsWithBothEnds) {
    Random random(3, "equivariant");
    for (int i = 0; i < 200; ++i) {
        Edge edge = randomEdge(random, 8, 0.2);
        const Matrix3d found = estimateRelativeRotation(edge.g_c, edge.g_n).value().R_c_n;
        const Matrix3d back = estimateRelativeRotation(edge.g_n, edge.g_c).value().R_c_n;
        EXPECT_LT((back - found.transpose()).norm(), 1e-9);
        const Matrix3d A = random.rotation();
        const Matrix3d B = random.rotation();
        for (Vector3d& g : edge.g_c)
            g = A * g;
        for (Vector3d& g : edge.g_n)
            g = B * g;
        EXPECT_LT((estimateRelativeRotation(edge.g_c, edge.g_n).value().R_c_n - A * found * B.transpose()).norm(),
                  1e-9);
    }
}

TEST(EdgeRotation, IsARotationEvenOfMirroredReadings) {
    // A sensor with one axis the wrong way round: no rotation fits, the answer must be one all the same.
    Random random(4, "mirror");
    for (int i = 0; i < 100; ++i) {
        Edge edge = randomEdge(random, 10);
        for (Vector3d& g : edge.g_n)
            g.x() = -g.x();
        const auto found = estimateRelativeRotation(edge.g_c, edge.g_n).value();
        EXPECT_NEAR(found.R_c_n.determinant(), 1, 1e-9);
        EXPECT_GT(found.residual_rms, 1);
    }
}

TEST(EdgeRotation, ParallelAndOppositeGravityIsRefused) {
    const Vector3d g(0, 0, 9.8);
    EXPECT_EQ(codeOf({g, g, g}, {g, g, g}), ErrorCode::ParallelGravity);
    EXPECT_EQ(codeOf({g, -g}, {g, -g}), ErrorCode::ParallelGravity);
    EXPECT_EQ(codeOf({g, 2 * g, -g}, {g, 2 * g, -g}), ErrorCode::ParallelGravity);
    EXPECT_EQ(codeOf({Vector3d::Zero(), Vector3d::Zero()}, {g, g}), ErrorCode::ParallelGravity);
    // One end is enough to spoil it, and the numbers say by how much.
    const Vector3d aside(9.8, 0, 0);
    const auto refused = estimateRelativeRotation(std::vector<Vector3d>{g, aside}, std::vector<Vector3d>{g, g});
    ASSERT_FALSE(refused);
    EXPECT_NEAR(refused.error().numbers.at("spread_deg"), 0, 1e-5);
    EXPECT_DOUBLE_EQ(refused.error().numbers.at("needed_deg"), 5);
}

TEST(EdgeRotation, SpreadIsTheAngleBetweenPoses) {
    EXPECT_EQ(gravitySpread({}), 0);
    // Two unit vectors an angle a apart: the singular values' ratio is tan(a/2).
    for (const double a : {0.05, 0.3, 1.0, 1.5}) {
        const std::vector<Vector3d> g{{0, 0, 5}, {7 * std::sin(a), 0, 7 * std::cos(a)}};
        EXPECT_NEAR(gravitySpread(g), a, 1e-9) << a;
    }
    RelativeRotationOptions strict;
    strict.minSpread_rad = 60 * kDegree;
    const std::vector<Vector3d> g{{0, 0, 9.8}, {0, 5, 8}};
    EXPECT_TRUE(estimateRelativeRotation(g, g));
    EXPECT_FALSE(estimateRelativeRotation(g, g, strict));
}

TEST(EdgeRotation, RefusesBadInput) {
    const Vector3d g(0, 0, 9.8);
    const Vector3d h(0, 9.8, 0);
    EXPECT_EQ(codeOf({g, h, g}, {g, h}), ErrorCode::SizeMismatch);
    EXPECT_EQ(codeOf({g}, {g}), ErrorCode::TooFewPoses);
    EXPECT_EQ(codeOf({}, {}), ErrorCode::TooFewPoses);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        EXPECT_EQ(codeOf({g, {0, bad, 0}}, {g, h}), ErrorCode::NotFinite);
        EXPECT_EQ(codeOf({g, h}, {{bad, 0, 0}, h}), ErrorCode::NotFinite);
    }
    for (const double spread : {0.0, -1.0, 1.6}) {
        EXPECT_THROW((void)estimateRelativeRotation(std::vector{g, h}, std::vector{g, h}, {spread}), std::logic_error);
    }
}

Skin twoModules() {
    Skin skin;
    skin.templates = {paperHexagon()};
    skin.modules = {{ModuleId(7), 0}, {ModuleId(3), 0}};
    return skin;
}

TEST(GravityTable, SortsReadingsByModuleAndPose) {
    const Vector3d x(1, 0, 0);
    const std::vector<GravityReading> readings{
        {20, ModuleId(3), 4 * x}, {-5, ModuleId(3), 2 * x}, {20, ModuleId(7), 3 * x, 0.1}, {6, ModuleId(99), x}};
    const GravityTable table(twoModules(), readings);
    ASSERT_EQ(table.poseCount(), 3U);
    EXPECT_EQ(table.poseNumber(0), -5);
    EXPECT_EQ(table.poseNumber(2), 20);
    ASSERT_EQ(table.of(0).size(), 1U);
    EXPECT_EQ(table.of(0)[0].pose, 2U);
    EXPECT_EQ(table.of(0)[0].sigma, 0.1);
    ASSERT_EQ(table.of(1).size(), 2U);
    EXPECT_EQ(table.of(1)[0].acceleration, 2 * x);
    EXPECT_EQ(table.of(1)[1].acceleration, 4 * x);
    EXPECT_FALSE(table.of(1)[1].sigma);
}

TEST(GravityTable, UsesThePosesThatBothModulesHave) {
    Random random(5, "common");
    const Edge edge = randomEdge(random, 6);
    std::vector<GravityReading> readings;
    for (int p = 0; p < 6; ++p) {
        const auto i = static_cast<std::size_t>(p);
        if (p != 1)
            readings.push_back({p, ModuleId(7), edge.g_c[i]});
        if (p != 4)
            readings.push_back({p, ModuleId(3), edge.g_n[i]});
    }
    const GravityTable table(twoModules(), readings);
    const auto found = relativeRotation(table, 0, 1);
    ASSERT_TRUE(found);
    EXPECT_LT((found->R_c_n - edge.R_c_n).norm(), 1e-9);
    EXPECT_LT((relativeRotation(table, 1, 0).value().R_c_n - edge.R_c_n.transpose()).norm(), 1e-9);
    EXPECT_EQ(relativeRotation(GravityTable(twoModules(), {}), 0, 1).error().code, ErrorCode::TooFewPoses);
}

}  // namespace
}  // namespace skincal
