#include <gtest/gtest.h>

#include <cmath>

#include "core/mesh/mesh_surface.h"
#include "tests/unit/mesh/sample_meshes.h"

namespace skincal {
namespace {

/// A cube from -1 to 1, outside out.
TriangleMesh cube() {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.vertices.emplace_back(i % 2 ? 1 : -1, i / 2 % 2 ? 1 : -1, i / 4 ? 1 : -1);
    for (const auto& [a, b, c, d] : std::vector<std::array<std::uint32_t, 4>>{
             {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    }
    return mesh;
}

/// Signed distance to the cube.
double distanceToCube(const Vector3d& p) {
    const Vector3d beyond = p.cwiseAbs() - Vector3d::Ones();
    return beyond.cwiseMax(0).norm() + std::min(0.0, beyond.maxCoeff());
}

TEST(MeshSurface, HasTheSignedDistanceOfACubeEverywhere) {
    const MeshSurface surface(cube());
    Random random(1, "cube");
    for (int i = 0; i < 2000; ++i) {
        const Vector3d p = random.uniform(0.2, 2.5) * random.direction();
        // Towards the side that is nearest: no face is left out that could be.
        const Vector3d size = p.cwiseAbs();
        Eigen::Index axis = 0;
        size.maxCoeff(&axis);
        const Vector3d facing = p;
        const auto found = surface.nearest(p, facing, 10);
        ASSERT_TRUE(found);
        EXPECT_NEAR(found->distance, distanceToCube(p), 1e-12) << p.transpose();
    }
}

TEST(MeshSurface, ItsGradientIsThatOfTheDistance) {
    Random random(2, "gradient");
    const MeshSurface surface(test::bumpyBody(random));
    constexpr double kStep = 1e-6;
    int checked = 0;
    for (int i = 0; i < 300; ++i) {
        const Vector3d p = 0.25 * random.direction();
        const Vector3d facing = p;
        const auto found = surface.nearest(p, facing, 1);
        ASSERT_TRUE(found);
        Vector3d gradient;
        for (int axis = 0; axis < 3; ++axis) {
            const Vector3d d = kStep * Vector3d::Unit(axis);
            gradient[axis] =
                (surface.nearest(p + d, facing, 1)->distance - surface.nearest(p - d, facing, 1)->distance) /
                (2 * kStep);
        }
        // Where two places are equally near the distance has a kink.
        if (std::abs(gradient.norm() - 1) > 1e-4)
            continue;
        ++checked;
        EXPECT_LT((gradient - found->gradient).norm(), 1e-3);
    }
    EXPECT_GT(checked, 280);
}

TEST(MeshSurface, TheFarSideOfAThinWallIsNotTheNearOne) {
    TriangleMesh wall = cube();
    for (Vector3d& vertex : wall.vertices)
        vertex.z() *= 0.001;
    const MeshSurface surface(wall);
    // Under the upper face, and nearer to the lower one.
    const auto up = surface.nearest({0.1, 0.2, -0.0009}, Vector3d::UnitZ(), 1);
    ASSERT_TRUE(up);
    EXPECT_NEAR(up->distance, -0.0019, 1e-12);
    const auto down = surface.nearest({0.1, 0.2, -0.0009}, -Vector3d::UnitZ(), 1);
    ASSERT_TRUE(down);
    EXPECT_NEAR(down->distance, -0.0001, 1e-12);
}

TEST(MeshSurface, FindsNothingBeyondItsReach) {
    const MeshSurface surface(cube());
    EXPECT_FALSE(surface.nearest({0, 0, 3}, Vector3d::UnitZ(), 1.9));
    EXPECT_TRUE(surface.nearest({0, 0, 3}, Vector3d::UnitZ(), 2.1));
}

TEST(TriangleMesh, WeldingJoinsCornersAndDropsWhatHasNoArea) {
    const TriangleMesh whole = cube();
    TriangleMesh soup;
    for (const auto& corners : whole.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        for (const std::uint32_t corner : corners)
            soup.vertices.push_back(whole.vertices[corner]);
        soup.triangles.push_back({first, first + 1, first + 2});
        soup.triangles.push_back({first, first + 1, first + 1});
    }
    const TriangleMesh mesh = welded(soup);
    EXPECT_EQ(mesh.vertices.size(), 8U);
    EXPECT_EQ(mesh.triangles.size(), 12U);
    EXPECT_NEAR(mesh.area(), 24, 1e-12);
    EXPECT_NEAR(enclosedVolume(mesh).value(), 8, 1e-12);
}

TEST(TriangleMesh, OneThatIsInsideOutIsTurnedAndOneWithAHoleIsLeftAlone) {
    TriangleMesh mesh = cube();
    for (auto& corners : mesh.triangles)
        std::swap(corners[0], corners[1]);
    EXPECT_NEAR(enclosedVolume(mesh).value(), -8, 1e-12);
    EXPECT_NEAR(enclosedVolume(turnedOutwards(mesh)).value(), 8, 1e-12);
    mesh.triangles.pop_back();
    EXPECT_FALSE(enclosedVolume(mesh));
    EXPECT_EQ(turnedOutwards(mesh).triangles, mesh.triangles);
}

TEST(TriangleMesh, FarFromTheOriginItIsTurnedAsWell) {
    const TriangleMesh mesh = transformed(cube(), makeIsometry(Matrix3d::Identity(), Vector3d(3e8, -7e8, 1e9)));
    EXPECT_NEAR(enclosedVolume(mesh).value(), 8, 1e-12);
    TriangleMesh insideOut = mesh;
    for (auto& corners : insideOut.triangles)
        std::swap(corners[1], corners[2]);
    EXPECT_NEAR(enclosedVolume(insideOut).value(), -8, 1e-12);
    EXPECT_EQ(turnedOutwards(insideOut).triangles, mesh.triangles);
    EXPECT_EQ(turnedOutwards(mesh).triangles, mesh.triangles);
}

TEST(TriangleMesh, ATubeIsClosedAndOutsideOut) {
    Random random(3, "tube");
    for (int i = 0; i < 20; ++i) {
        const double radius = random.uniform(0.01, 0.1);
        const Vector3d from = random.normal3();
        const Vector3d to = from + random.uniform(0.1, 1) * random.direction();
        const TriangleMesh tube = tubeMesh(from, to, radius, 200);
        const double volume = 180 * kDegree * radius * radius * (to - from).norm();
        EXPECT_NEAR(enclosedVolume(tube).value() / volume, 1, 1e-3);
    }
    EXPECT_THROW((void)tubeMesh(Vector3d::Zero(), Vector3d::Zero(), 1, 12), std::logic_error);
    EXPECT_THROW((void)tubeMesh(Vector3d::Zero(), Vector3d::UnitX(), 1, 2), std::logic_error);
}

}  // namespace
}  // namespace skincal
