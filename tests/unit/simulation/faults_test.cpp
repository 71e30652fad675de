#include "core/simulation/faults.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/simulation/faulty_worlds.h"

namespace skincal {
namespace {

constexpr std::uint64_t kSeeds = 8;

TEST(Faults, NoneLeaveWorldsAsTheyWere) {
    // Recorded before there were any faults.
    const World outliers = buildWorld(*findScenario("outliers"), 11);
    EXPECT_TRUE(outliers.faults.T_r_u_before.empty());
    const Vector3d read(-7.9578447564496058, -4.2097763287056349, 3.7259131864839845);
    EXPECT_LT((simulateGravity(outliers)[100].acceleration - read).norm(), 1e-9);
    const auto views = simulateDetections(outliers);
    ASSERT_EQ(views.back().found.size(), 76U);
    EXPECT_LT((views.back().found.back().pixel - Vector2d(744.2331338028838, 379.41153721310934)).norm(), 1e-6);
    const World arm = buildWorld(*findScenario("arm"), 11);
    EXPECT_EQ(arm.skin.modules[100 / arm.gravity_r.size()].id, ModuleId(546));
    const Vector3d armRead(4.0723230174035097, -6.5908551427443802, 5.9696555081509546);
    EXPECT_LT((simulateGravity(arm)[100].acceleration - armRead).norm(), 1e-9);
    EXPECT_LT(
        (simulateDetections(arm).back().found.back().pixel - Vector2d(636.08631660840331, 397.26651814299578)).norm(),
        1e-6);
}

TEST(Faults, MovedModulesAreElsewhereAtTheScan) {
    FaultOptions options;
    options.movedModules = 3;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const World before = faulty({}, seed);
        const World world = faulty(options, seed);
        const auto& moved = world.faults.movedModules;
        ASSERT_EQ(moved.size(), 3U);
        expectSamePoses(world.faults.T_r_u_before, before.T_r_u);
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            const PoseDifference step = poseDifference(world.T_r_u[u], before.T_r_u[u]);
            EXPECT_NEAR(step.distance, contains(moved, u) ? 4e-3 : 0, 1e-12);
            EXPECT_NEAR(step.angle, contains(moved, u) ? 6 * kDegree : 0, 1e-7);
            EXPECT_GE((before.T_r_u[u].inverse() * world.T_r_u[u].translation()).z(), -1e-12) << "not into the body";
        }
        expectSameGravity(world, before);
        expectSameDetections(world, before, [&](std::size_t, std::size_t u) { return contains(moved, u); });
        expectSamePoses(world.T_r_v, before.T_r_v);
        expectSameSkin(world, before);
    }
}

TEST(Faults, ShakenPosesReadMoreThanGravity) {
    FaultOptions options;
    options.shakenPoses = 2;
    Scenario scenario = hexagonsOnly();
    scenario.sensors.scale = 0;
    double common = 0;
    double own = 0;
    double poses = 0;
    double parts = 0;
    for (std::uint64_t seed = 1; seed <= 20 * kSeeds; ++seed) {
        const World world = faulty(options, seed, scenario);
        std::map<std::size_t, const ShakenPose*> shaken;
        for (const ShakenPose& pose : world.faults.shakenPoses)
            shaken[pose.pose] = &pose;
        ASSERT_EQ(shaken.size(), 2U);
        for (const auto& [p, pose] : shaken) {
            common += pose->acceleration_r.squaredNorm();
            ++poses;
            for (const Vector3d& a : pose->acceleration_u) {
                own += a.squaredNorm();
                parts += 3;
            }
        }
        if (seed > kSeeds)
            continue;
        const World still = faulty({}, seed, scenario);
        const auto isShaken = [&](std::size_t, std::size_t p) { return shaken.count(p) > 0; };
        expectSameGravity(world, still, isShaken);
        const auto readings = simulateGravity(world);
        const auto quiet = simulateGravity(still);
        for (std::size_t i = 0; i < readings.size(); ++i) {
            const auto found = shaken.find(static_cast<std::size_t>(readings[i].pose));
            if (found == shaken.end())
                continue;
            const std::size_t u = i / world.gravity_r.size();
            const Vector3d more =
                world.T_r_u[u].linear().transpose() * found->second->acceleration_r + found->second->acceleration_u[u];
            EXPECT_LT((readings[i].acceleration - quiet[i].acceleration - more).norm(), 1e-9);
        }
        expectSameDetections(world, still);
        expectSamePoses(world.T_r_u, still.T_r_u);
        expectSameSkin(world, still);
    }
    EXPECT_NEAR(std::sqrt(common / poses), 0.6, 0.06);
    EXPECT_NEAR(std::sqrt(own / parts), 0.4, 0.01);
}

TEST(Faults, BumpedViewsShowTheLaterHalfFromElsewhere) {
    FaultOptions options;
    options.bumpedViews = 2;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const World calm = faulty({}, seed);
        const World world = faulty(options, seed);
        std::map<std::size_t, Isometry3d> bumped;
        for (const BumpedView& bump : world.faults.bumpedViews)
            bumped[bump.view] = bump.T_r_v_after;
        ASSERT_EQ(bumped.size(), 2U);
        expectSamePoses(world.T_r_v, calm.T_r_v);
        const auto later = [&](std::size_t v, std::size_t u) { return bumped.count(v) > 0 && 2 * u >= 76; };
        expectSameDetections(world, calm, later);
        const auto pixels = pixelsOf(world);
        for (const auto& [v, T_r_v] : bumped) {
            const PoseDifference knock = poseDifference(world.T_r_v[v], T_r_v);
            EXPECT_NEAR(knock.distance, 8e-3, 1e-12);
            EXPECT_NEAR(knock.angle, 1 * kDegree, 1e-7);
            std::size_t seen = 0;
            for (std::size_t u = 38; u < 76; ++u) {
                const auto found = pixels.find({v, u});
                if (found == pixels.end())
                    continue;
                const auto ideal =
                    world.scenario.camera.project(T_r_v.inverse() * (world.T_r_u[u] * world.trueTemplate(u).led));
                EXPECT_LT((found->second - ideal.value()).norm(), 8 * world.scenario.views.pixelNoise);
                ++seen;
            }
            EXPECT_GE(seen, 4U);
        }
        expectSameGravity(world, calm);
        expectSamePoses(world.T_r_u, calm.T_r_u);
        expectSameSkin(world, calm);
    }
}

TEST(Faults, MovedPatchesTurnAsAWhole) {
    FaultOptions options;
    options.movedPatches = 2;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const World fixed = faulty({}, seed);
        const World world = faulty(options, seed);
        ASSERT_EQ(world.faults.movedPatches.size(), 2U);
        EXPECT_FALSE(contains(world.faults.movedPatches, 0));
        const auto moved = [&](std::size_t u, std::size_t) {
            return contains(world.faults.movedPatches, static_cast<std::size_t>(world.patchOf[u]));
        };
        expectSamePoses(world.T_r_u, fixed.T_r_u);
        std::map<int, Isometry3d> turns;
        std::map<int, Vector3d> steps;
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            const Isometry3d& T_r_before = world.faults.T_r_u_before[u];
            if (!moved(u, 0)) {
                EXPECT_EQ(T_r_before.matrix(), world.T_r_u[u].matrix());
                continue;
            }
            const Isometry3d turn = T_r_before * world.T_r_u[u].inverse();
            EXPECT_NEAR(rotationAngle(turn.linear()), 20 * kDegree, 1e-9);
            const Isometry3d& first = turns.emplace(world.patchOf[u], turn).first->second;
            EXPECT_TRUE(turn.isApprox(first, 1e-9)) << "the same for all modules of the patch";
            steps.emplace(world.patchOf[u], Vector3d::Zero());
            steps[world.patchOf[u]] += T_r_before.translation() - world.T_r_u[u].translation();
        }
        ASSERT_EQ(turns.size(), 2U);
        for (const auto& [k, step] : steps)
            EXPECT_LT(step.norm(), 1e-9) << "its middle stays";
        expectSameGravity(world, fixed, moved);
        expectSameDetections(world, fixed);
        expectSamePoses(world.T_r_v, fixed.T_r_v);
        expectSameSkin(world, fixed);
    }
}

TEST(Faults, GravityIsReadInThePoseBefore) {
    Scenario scenario = hexagonsOnly();
    scenario.sensors.bias = scenario.sensors.scale = scenario.sensors.noise = 0;
    FaultOptions options;
    options.movedModules = 5;
    options.movedPatches = 1;
    const World world = faulty(options, 1, scenario);
    const auto readings = simulateGravity(world);
    const std::size_t poses = world.gravity_r.size();
    for (std::size_t i = 0; i < readings.size(); ++i) {
        const Matrix3d R_r_before = world.faults.T_r_u_before[i / poses].linear();
        EXPECT_LT((R_r_before * readings[i].acceleration - world.gravity_r[i % poses]).norm(), 1e-9);
    }
}

}  // namespace
}  // namespace skincal
