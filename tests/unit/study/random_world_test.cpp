#include "core/study/random_world.h"

#include <gtest/gtest.h>

namespace skincal {
namespace {

TEST(RandomWorld, StaysWithinWhatItSays) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const World world = randomWorld(seed);
        const Scenario& s = world.scenario;
        EXPECT_GE(s.patches.size(), 2U);
        EXPECT_LE(s.patches.size(), 5U);
        std::size_t modules = 0;
        for (const PatchPlan& plan : s.patches) {
            EXPECT_GE(plan.modules, 6U);
            EXPECT_LE(plan.modules, 23U);
            modules += plan.modules;
        }
        EXPECT_EQ(world.T_r_u.size(), modules);
        EXPECT_GE(s.sensors.poses, 6);
        EXPECT_LE(s.sensors.poses, 17);
        EXPECT_GE(s.sensors.noise, 0.01);
        EXPECT_LE(s.sensors.noise, 0.1);
        EXPECT_GE(s.views.pixelNoise, 0.01);
        EXPECT_LE(s.views.pixelNoise, 0.3);
        EXPECT_LE(s.views.outliers, 0.2);
        EXPECT_EQ(static_cast<int>(world.T_r_v.size()), s.views.count);
    }
}

// Figures of different versions are compared seed by seed: these were written down when the study was made.
TEST(RandomWorld, AreTheSameForEver) {
    const std::vector<std::string> descriptions{"plane, 3 patches, 7 views at 0.60 m, 0.022 px, 0 % false",
                                                "cylinder, 2 patches, 12 views at 1.19 m, 0.076 px, 0 % false",
                                                "relief, 2 patches, 9 views at 1.13 m, 0.276 px, 0 % false",
                                                "arm, 2 patches, 7 views at 0.56 m, 0.228 px, 10 % false"};
    const std::vector<std::size_t> modules{51, 22, 28, 24};
    for (std::size_t i = 0; i < descriptions.size(); ++i) {
        const World world = randomWorld(4 + i);
        EXPECT_EQ(world.scenario.description, descriptions[i]);
        EXPECT_EQ(world.T_r_u.size(), modules[i]);
    }
}

}  // namespace
}  // namespace skincal
