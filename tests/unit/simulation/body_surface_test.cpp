#include "core/simulation/body_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/mesh/mesh_comparison.h"
#include "core/mesh/mesh_surface.h"

namespace skincal {
namespace {

TEST(BodySurface, LiesUnderEveryBoard) {
    for (const char* name : {"demo", "arm", "cylinder", "plane", "freeform", "shoe-sole", "mixed-shapes"}) {
        const World world = buildWorld(*findScenario(name), 1);
        const MeshSurface surface(bodySurface(world));
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            const auto& plan = world.scenario.patches[static_cast<std::size_t>(world.patchOf[u])];
            const double above = plan.surface == SurfaceKind::Cylinder ? 0.05 * plan.radius : 0;
            const auto found = surface.nearest(world.T_r_u[u].translation(), world.T_r_u[u].linear().col(2), 0.05);
            ASSERT_TRUE(found) << name;
            // Play is three tenths of a millimetre; closing gaps shifts the outer boards of a patch by more.
            EXPECT_NEAR(found->distance, above, 4e-3) << name << ", module " << u;
        }
    }
}

TEST(BodySurface, OfTheDemosArmIsFoundAgainWhereItIs) {
    const World world = buildWorld(*findScenario("demo"), 1);
    std::vector<PlacedModule> modules;
    const Isometry3d T_a_r = makeIsometry(so3Exp({0.4, -1, 2}), {0.3, 0.1, -0.7});
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
        modules.push_back({world.skin.modules[u].id, T_a_r * world.T_r_u[u]});
    const auto comparison = compareWithMesh(modules, bodySurface(world));
    ASSERT_TRUE(comparison);
    const PoseDifference error = poseDifference(comparison->T_mesh_body * T_a_r, Isometry3d::Identity());
    EXPECT_LT(error.angle, 1 * kDegree);
    EXPECT_LT(error.distance, 5e-3);
    EXPECT_LT(comparison->rms, 1e-3);
    EXPECT_NEAR(comparison->offset, 2.5e-3, 1e-3);
    for (const AlignmentDoubt& doubt : comparison->doubts)
        ADD_FAILURE() << static_cast<int>(doubt.kind) << ' ' << doubt.value << ' ' << doubt.other;
}

}  // namespace
}  // namespace skincal
