#include <gtest/gtest.h>

#include "core/mesh/mesh_surface.h"
#include "tests/unit/mesh/sample_meshes.h"

namespace skincal {
namespace {

TEST(SurfaceSamples, LieOnTheSurfaceApartFromEachOtherAndLeaveNoGaps) {
    Random random(1, "samples");
    const TriangleMesh mesh = test::bumpyBody(random);
    const MeshSurface surface(mesh);
    constexpr std::size_t kCount = 800;
    const auto points = sampleSurface(mesh, kCount, random);
    EXPECT_GT(points.size(), kCount * 6 / 10);
    EXPECT_LT(points.size(), 2 * kCount);
    const double spacing = 0.7 * std::sqrt(mesh.area() / kCount);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR(surface.nearest(points[i].position, points[i].normal, 1)->distance, 0, 1e-12);
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_GE((points[i].position - points[k].position).norm(), spacing);
    }
    const SampledSurface sampled(points);
    for (const OrientedPoint& other : sampleSurface(mesh, kCount, random))
        EXPECT_LT((sampled.nearest(other.position).position - other.position).norm(), 2.5 * spacing);
}

TEST(SurfaceSamples, AMeshWithoutAreaHasNone) {
    Random random(1, "samples");
    EXPECT_TRUE(sampleSurface({}, 100, random).empty());
    EXPECT_THROW((void)SampledSurface({}).nearest(Vector3d::Zero()), std::logic_error);
}

TEST(SurfaceSamples, FarFromTheOriginTheyAreTheSame) {
    Random random(1, "far");
    TriangleMesh mesh = test::bumpyBody(random);
    // Rounded so that nothing is lost far away, where the number of a cell is more than an int holds.
    const double step = 0x1p-22;
    for (Vector3d& vertex : mesh.vertices)
        vertex = (vertex / step).array().round() * step;
    const Vector3d shift(0x1p29, -0x1p29, 0x1p29);
    Random here(2, "draws");
    Random there(2, "draws");
    const auto near = sampleSurface(mesh, 6000, here);
    const auto far = sampleSurface(transformed(mesh, makeIsometry(Matrix3d::Identity(), shift)), 6000, there);
    ASSERT_EQ(near.size(), far.size());
    for (std::size_t i = 0; i < near.size(); ++i)
        EXPECT_LT((far[i].position - shift - near[i].position).norm(), 1e-6);
}

TEST(SurfaceSamples, BothSidesOfAThinWallHaveTheirOwn) {
    const TriangleMesh wall = tubeMesh(Vector3d::Zero(), Vector3d(0, 0, 0.001), 0.1, 40);
    Random random(1, "wall");
    int up = 0;
    int down = 0;
    for (const OrientedPoint& point : sampleSurface(wall, 300, random)) {
        up += point.normal.z() > 0.9 ? 1 : 0;
        down += point.normal.z() < -0.9 ? 1 : 0;
    }
    EXPECT_GT(up, 80);
    EXPECT_GT(down, 80);
}

TEST(SurfaceSamples, ThinnedTheyAreEvenlyFewer) {
    std::vector<OrientedPoint> points(10);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i].position.x() = static_cast<double>(i);
    const auto numbers = [&](std::size_t most) {
        std::vector<double> result;
        for (const OrientedPoint& point : thinned(points, most))
            result.push_back(point.position.x());
        return result;
    };
    EXPECT_EQ(numbers(3), (std::vector<double>{0, 3, 6}));
    EXPECT_EQ(numbers(0), std::vector<double>());
    EXPECT_EQ(numbers(10), numbers(99));
    EXPECT_EQ(numbers(99).size(), 10U);
    EXPECT_TRUE(thinned({}, 3).empty());
}

}  // namespace
}  // namespace skincal
