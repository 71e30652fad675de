#include "core/simulation/body_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/random.h"
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

/// Modules as they truly are, in a frame of their own.
struct Seen {
    std::vector<PlacedModule> modules;
    Isometry3d T_a_r;
};

Seen seenElsewhere(const World& world, std::uint64_t seed) {
    Random random(seed, "frame");
    Seen seen{{}, makeIsometry(random.rotation(), random.normal3())};
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
        seen.modules.push_back({world.skin.modules[u].id, seen.T_a_r * world.T_r_u[u]});
    return seen;
}

TEST(BodySurface, APoseOnItThatIsNotDoubtedIsRight) {
    int undoubted = 0;
    for (const char* name : {"demo", "arm", "cylinder", "plane", "freeform", "shoe-sole", "mixed-shapes"}) {
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            const World world = buildWorld(*findScenario(name), seed);
            const Seen seen = seenElsewhere(world, seed);
            const auto comparison = compareWithMesh(seen.modules, bodySurface(world));
            ASSERT_TRUE(comparison) << name << ", seed " << seed;
            if (!comparison->doubts.empty())
                continue;
            ++undoubted;
            double squares = 0;
            for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
                squares += (comparison->T_mesh_body * seen.modules[u].T_body_module.translation() -
                            world.T_r_u[u].translation())
                               .squaredNorm();
            EXPECT_LT(std::sqrt(squares / static_cast<double>(world.T_r_u.size())), 5e-3) << name << ", seed " << seed;
        }
    }
    EXPECT_GE(undoubted, 6) << "an arm, at least, is told for certain";
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
