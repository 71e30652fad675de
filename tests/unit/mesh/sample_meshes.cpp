#include "tests/unit/mesh/sample_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace skincal::test {

TriangleMesh bumpyBody(Random& random) {
    constexpr std::uint32_t kRings = 60;
    constexpr std::uint32_t kSides = 90;
    struct Bump {
        Vector3d direction;
        double height, width;
    };
    std::array<Bump, 6> bumps;
    for (Bump& bump : bumps)
        bump = {random.direction(), random.uniform(0.1, 0.35), random.uniform(0.3, 0.6)};
    const Vector3d radii(0.06, random.uniform(0.08, 0.09), random.uniform(0.12, 0.15));
    const auto at = [&](double polar, double azimuth) -> Vector3d {
        const Vector3d out(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
        double scale = 1;
        for (const Bump& bump : bumps)
            scale += bump.height * std::exp(-(out - bump.direction).squaredNorm() / (2 * bump.width * bump.width));
        return scale * radii.cwiseProduct(out);
    };
    TriangleMesh mesh{{at(0, 0), at(180 * kDegree, 0)}, {}};
    const auto index = [&](std::uint32_t ring, std::uint32_t side) { return 2 + (ring - 1) * kSides + side % kSides; };
    for (std::uint32_t ring = 1; ring < kRings; ++ring) {
        for (std::uint32_t side = 0; side < kSides; ++side)
            mesh.vertices.push_back(at(180 * kDegree * ring / kRings, 360 * kDegree * side / kSides));
    }
    for (std::uint32_t side = 0; side < kSides; ++side) {
        mesh.triangles.push_back({0, index(1, side), index(1, side + 1)});
        mesh.triangles.push_back({1, index(kRings - 1, side + 1), index(kRings - 1, side)});
        for (std::uint32_t ring = 1; ring + 1 < kRings; ++ring) {
            mesh.triangles.push_back({index(ring, side), index(ring + 1, side), index(ring + 1, side + 1)});
            mesh.triangles.push_back({index(ring, side), index(ring + 1, side + 1), index(ring, side + 1)});
        }
    }
    return mesh;
}

Isometry3d randomPose(Random& random, double shift) {
    return makeIsometry(random.rotation(), shift * random.normal3());
}

std::vector<PlacedModule> modulesOn(const TriangleMesh& mesh, std::size_t count, double offset, Random& random,
                                    const std::function<bool(const Vector3d&)>& isCovered) {
    std::vector<PlacedModule> modules;
    // More than are kept where only part of the mesh is covered.
    for (const OrientedPoint& point : sampleSurface(mesh, isCovered ? 6 * count : count + count / 2, random)) {
        if (modules.size() == count)
            break;
        if (isCovered && !isCovered(point.position))
            continue;
        const Matrix3d R = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), point.normal).toRotationMatrix() *
                           Eigen::AngleAxisd(random.uniform(0, 6.28), Vector3d::UnitZ()).toRotationMatrix();
        modules.push_back({ModuleId(static_cast<std::uint32_t>(3 * modules.size() + 5)),
                           makeIsometry(R, point.position + offset * point.normal)});
    }
    return modules;
}

std::vector<PlacedModule> movedBy(const Isometry3d& T_b_a, std::vector<PlacedModule> modules) {
    for (PlacedModule& module : modules)
        module.T_body_module = T_b_a * module.T_body_module;
    return modules;
}

bool hasDoubt(const MeshComparison& comparison, AlignmentDoubt::Kind kind) {
    return std::any_of(comparison.doubts.begin(), comparison.doubts.end(),
                       [&](const AlignmentDoubt& doubt) { return doubt.kind == kind; });
}

}  // namespace skincal::test
