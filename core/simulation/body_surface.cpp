#include "core/simulation/body_surface.h"

#include <cmath>

#include "core/simulation/patch_layout.h"

namespace skincal {
namespace {

constexpr int kSides = 96;        // of a tube
constexpr double kReach = 0.034;  // m, beyond the boards' middles
constexpr double kGrid = 0.008;   // m

bool isOneSurface(const PatchPlan& a, const PatchPlan& b) {
    return a.surface == b.surface && a.radius == b.radius && a.T_r_s.isApprox(b.T_r_s);
}

/// The heights of a plan's surface over a rectangle of its plane.
TriangleMesh sheetOf(const World& world, const PatchPlan& plan, const Eigen::AlignedBox2d& box) {
    const ModuleTemplate& type = world.scenario.templates.at(plan.type);
    const Eigen::Vector2i steps = (box.sizes() / kGrid).array().ceil().cast<int>().max(1);
    TriangleMesh mesh;
    std::vector<Vector2d> places;
    for (int y = 0; y <= steps.y(); ++y) {
        for (int x = 0; x <= steps.x(); ++x)
            places.emplace_back(box.min() +
                                Vector2d(x, y).cwiseQuotient(steps.cast<double>()).cwiseProduct(box.sizes()));
    }
    for (const Vector3d& point : surfacePoints(plan, type, world.seed, places))
        mesh.vertices.push_back(plan.T_r_s * point);
    const auto width = static_cast<std::uint32_t>(steps.x() + 1);
    for (std::uint32_t y = 0; y + 1 < static_cast<std::uint32_t>(steps.y() + 1); ++y) {
        for (std::uint32_t x = 0; x + 1 < width; ++x) {
            const std::uint32_t at = y * width + x;
            mesh.triangles.push_back({at, at + 1, at + width + 1});
            mesh.triangles.push_back({at, at + width + 1, at + width});
        }
    }
    return mesh;
}

}  // namespace

TriangleMesh bodySurface(const World& world) {
    TriangleMesh mesh;
    for (const Tube& tube : world.tubes)
        append(mesh, tubeMesh(tube.from, tube.to, tube.radius, kSides));
    const auto& plans = world.scenario.patches;
    std::vector<bool> isDone(plans.size(), false);
    for (std::size_t k = 0; k < plans.size(); ++k) {
        if (isDone[k] || plans[k].surface == SurfaceKind::Cylinder)
            continue;
        Eigen::AlignedBox2d box;
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            const auto other = static_cast<std::size_t>(world.patchOf[u]);
            if (!isOneSurface(plans[k], plans[other]))
                continue;
            isDone[other] = true;
            const Vector2d p = (plans[k].T_r_s.inverse() * world.T_r_u[u].translation()).head<2>();
            box.extend(Vector2d(p - Vector2d::Constant(kReach)));
            box.extend(Vector2d(p + Vector2d::Constant(kReach)));
        }
        if (!box.isEmpty())
            append(mesh, sheetOf(world, plans[k], box));
    }
    return mesh;
}

}  // namespace skincal
