#include "core/estimation/observability.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "core/estimation/gravity_spread.h"
#include "core/geometry/random.h"
#include "tests/unit/estimation/solved_world.h"

namespace skincal {
namespace {

using testing::HasSubstr;
using Kind = Shortfall::Kind;

const Shortfall* find(const std::vector<Shortfall>& shortfalls, Kind kind) {
    const auto found =
        std::find_if(shortfalls.begin(), shortfalls.end(), [&](const Shortfall& s) { return s.kind == kind; });
    return found == shortfalls.end() ? nullptr : &*found;
}

std::string texts(const std::vector<Shortfall>& shortfalls) {
    std::string all;
    for (const Shortfall& s : shortfalls)
        all += std::string(name(s.kind)) + ": " + s.text.english() + "\n";
    return all;
}

/// The world's patch that a patch of the solution is.
int worldPatch(const SolvedWorld& solved, PatchId id) {
    return solved.world.patchOf[solved.solution.layout.patches[id.value].origin];
}

class GoodWorlds : public testing::TestWithParam<const char*> {};

TEST_P(GoodWorlds, LackNothing) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const SolvedWorld solved(scenarioWorld(GetParam(), seed));
        const auto shortfalls = findShortfalls(solved.solution);
        EXPECT_TRUE(shortfalls.empty()) << seed << "\n" << texts(shortfalls);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, GoodWorlds, testing::Values("plane", "freeform", "outliers", "misaligned"));

TEST(FindShortfalls, PosesAlikeAndTheDirectionThatHelps) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        World world = scenarioWorld("freeform", seed);
        Random random(seed, "poses alike");
        const Vector3d first = random.direction();
        world.gravity_r.clear();
        for (int p = 0; p < 8; ++p)
            world.gravity_r.emplace_back(kStandardGravity * (so3Exp(2 * kDegree * random.normal3()) * first));
        const SolvedWorld solved(world);
        const auto shortfalls = findShortfalls(solved.solution);
        const Shortfall* alike = find(shortfalls, Kind::PosesAlike);
        ASSERT_NE(alike, nullptr) << texts(shortfalls);
        EXPECT_EQ(alike->modules.size(), world.T_r_u.size());
        EXPECT_EQ(alike->unit, "deg");
        EXPECT_GT(alike->figure.value(), 1);
        ASSERT_TRUE(alike->up_r);
        // A turn about gravity shows where gravity lies across.
        EXPECT_LT(std::abs((solved.T_w_r().linear() * *alike->up_r).dot(first)), 0.8);
        EXPECT_THAT(alike->text, HasSubstr("such as one in which"));

        // An operator who does as told is soon done.
        int told = 0;
        std::optional<Vector3d> up_w = solved.T_w_r().linear() * *alike->up_r;
        for (; up_w && told < 4; ++told) {
            world.gravity_r.emplace_back(kStandardGravity * *up_w);
            const SolvedWorld next(world);
            const auto left = findShortfalls(next.solution);
            const Shortfall* still = find(left, Kind::PosesAlike);
            up_w =
                still != nullptr ? std::optional<Vector3d>(next.T_w_r().linear() * still->up_r.value()) : std::nullopt;
        }
        EXPECT_LE(told, 3) << seed;
    }
}

TEST(FindShortfalls, PosesThatAreTurnsAboutGravity) {
    World world = bareWorld({flatPatch(12)}, 1, 0.05);
    world.gravity_r.assign(6, world.gravity_r.front());
    world.T_r_v = {cameraBefore(world, 0.7, 20 * kDegree), cameraBefore(world, 0.7, -20 * kDegree)};
    const SolvedWorld solved(world);
    const auto shortfalls = findShortfalls(solved.solution);
    const Shortfall* alike = find(shortfalls, Kind::PosesAlike);
    ASSERT_NE(alike, nullptr) << texts(shortfalls);
    EXPECT_THAT(alike->text, HasSubstr("unknown about one axis"));
    EXPECT_THAT(alike->text, HasSubstr("6 poses, tilted by at most"));
    EXPECT_GT(alike->figure.value(), 40);
}

TEST(FindShortfalls, GravityMissing) {
    const World world = scenarioWorld("freeform", 2);
    Measurements few = measurementsOf(world);
    const ModuleId dumb = few.skin.modules[5].id;
    std::erase_if(few.gravity, [&](const GravityReading& r) { return r.module == dumb && r.pose > 0; });
    const SolvedWorld solved(world, few);
    const auto shortfalls = findShortfalls(solved.solution);
    const Shortfall* missing = find(shortfalls, Kind::GravityMissing);
    ASSERT_NE(missing, nullptr) << texts(shortfalls);
    EXPECT_EQ(missing->modules, std::vector{dumb});

    Measurements none = measurementsOf(world);
    none.gravity.clear();
    const SolvedWorld without(world, none);
    const auto all = findShortfalls(without.solution);
    ASSERT_NE(find(all, Kind::GravityMissing), nullptr) << texts(all);
    EXPECT_THAT(find(all, Kind::GravityMissing)->text, HasSubstr("no module has gravity readings"));
}

TEST(FindShortfalls, PatchesThatNoViewShowsOrNoneWithOthers) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const World world = scenarioWorld("outliers", seed);
        Measurements unseen = measurementsOf(world);
        dropDetections(unseen, [&](std::size_t, std::size_t u) { return world.patchOf[u] == 3; });
        const SolvedWorld solved(world, unseen);
        const auto shortfalls = findShortfalls(solved.solution);
        const Shortfall* patch = find(shortfalls, Kind::PatchUnseen);
        ASSERT_NE(patch, nullptr) << texts(shortfalls);
        ASSERT_EQ(patch->patches.size(), 1U);
        EXPECT_EQ(worldPatch(solved, patch->patches.front()), 3);
        EXPECT_THAT(patch->text, HasSubstr("it is wired to patch"));
        EXPECT_EQ(find(shortfalls, Kind::PatchNeverWithPlaced), nullptr);

        // Patch 3 has the last two views for itself and is in no other.
        Measurements apart = measurementsOf(world);
        const std::size_t views = apart.views.size();
        dropDetections(apart,
                       [&](std::size_t v, std::size_t u) { return (world.patchOf[u] == 3) != (v + 2 >= views); });
        const SolvedWorld alone(world, apart);
        const auto found = findShortfalls(alone.solution);
        const Shortfall* never = find(found, Kind::PatchNeverWithPlaced);
        ASSERT_NE(never, nullptr) << texts(found);
        EXPECT_EQ(worldPatch(alone, never->patches.at(0)), 3);
        EXPECT_EQ(never->views, (std::vector<std::string>{viewName(views - 2), viewName(views - 1)}));
    }
}

TEST(FindShortfalls, PatchesSeenTooLittle) {
    const World world = scenarioWorld("freeform", 3);
    Measurements measurements = measurementsOf(world);
    // One LED in one view: neither a pose nor a triangulation.
    const auto first = std::find(world.patchOf.begin(), world.patchOf.end(), 3) - world.patchOf.begin();
    bool any = false;
    dropDetections(measurements, [&](std::size_t, std::size_t u) {
        const bool keep = !any && u == static_cast<std::size_t>(first);
        any = any || keep;
        return world.patchOf[u] == 3 && !keep;
    });
    ASSERT_TRUE(any);
    const SolvedWorld solved(world, measurements);
    const auto shortfalls = findShortfalls(solved.solution);
    const Shortfall* little = find(shortfalls, Kind::PatchSeenTooLittle);
    ASSERT_NE(little, nullptr) << texts(shortfalls);
    EXPECT_THAT(little->text, HasSubstr("move the camera closer"));
}

TEST(FindShortfalls, ViewsOfOneFlatPatchAlone) {
    std::size_t undecided = 0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        World world = bareWorld({flatPatch(7)}, seed, 0.3);
        for (const double distance : {1.4, 1.5})
            world.T_r_v.push_back(cameraBefore(world, distance, 10 * kDegree));
        Measurements measurements = measurementsOf(world);
        const SolvedWorld solved(world, measurements);
        const auto shortfalls = findShortfalls(solved.solution);
        const Shortfall* views = find(shortfalls, Kind::UndecidedViews);
        undecided += views != nullptr ? 1 : 0;
        if (views != nullptr) {
            EXPECT_FALSE(views->views.empty());
            EXPECT_EQ(views->patches, std::vector{PatchId(0)});
            EXPECT_THAT(views->text, HasSubstr("could be in two places"));
        }
    }
    EXPECT_GT(undecided, 0U);
}

TEST(FindShortfalls, OneViewIsOneDirection) {
    World world = scenarioWorld("plane", 1);
    world.T_r_v.resize(1);
    const SolvedWorld solved(world);
    const auto shortfalls = findShortfalls(solved.solution);
    const Shortfall* few = find(shortfalls, Kind::FewViews);
    ASSERT_NE(few, nullptr) << texts(shortfalls);
    EXPECT_FALSE(few->patches.empty());
    EXPECT_EQ(few->figure.value(), 0);
}

TEST(FindShortfalls, ModulesThatNoPictureShows) {
    const World world = scenarioWorld("freeform", 1);
    Measurements measurements = measurementsOf(world);
    dropDetections(measurements, [](std::size_t, std::size_t u) { return u == 4 || u == 30; });
    const SolvedWorld solved(world, measurements);
    const auto shortfalls = findShortfalls(solved.solution);
    ASSERT_EQ(shortfalls.size(), 1U) << texts(shortfalls);
    EXPECT_EQ(shortfalls[0].kind, Kind::ModulesHidden);
    EXPECT_EQ(shortfalls[0].modules, (std::vector{world.skin.modules[4].id, world.skin.modules[30].id}));
    EXPECT_EQ(shortfalls[0].unit, "mm");
    EXPECT_GT(shortfalls[0].figure.value(), 0);
}

TEST(FindShortfalls, ModulesThatNoViewLooksAt) {
    // An arm has some round the corner.
    const SolvedWorld solved(scenarioWorld("arm", 1));
    const auto shortfalls = findShortfalls(solved.solution);
    const Shortfall* unseen = find(shortfalls, Kind::ModulesUnseen);
    ASSERT_NE(unseen, nullptr) << texts(shortfalls);
    for (std::size_t u = 0; u < solved.world.T_r_u.size(); ++u) {
        bool visible = false;
        for (std::size_t v = 0; v < solved.world.T_r_v.size(); ++v)
            visible = visible || visiblePixel(solved.world, v, u);
        const ModuleId id = solved.world.skin.modules[u].id;
        const bool named = std::find(unseen->modules.begin(), unseen->modules.end(), id) != unseen->modules.end();
        EXPECT_FALSE(named && visible) << id.value;
    }
}

TEST(FindShortfalls, SizeFromAFewLooseLinks) {
    Scenario scenario = *findScenario("freeform");
    scenario.patches.resize(2);
    for (PatchPlan& patch : scenario.patches)
        patch.modules = 5;
    scenario.play.position = 0.8e-3;
    const SolvedWorld solved(buildWorld(scenario, 2));
    const auto shortfalls = findShortfalls(solved.solution);
    const Shortfall* scale = find(shortfalls, Kind::ScaleFromLinksOnly);
    ASSERT_NE(scale, nullptr) << texts(shortfalls);
    EXPECT_GT(scale->figure.value(), 0.5);
    EXPECT_EQ(scale->unit, "%");
    EXPECT_EQ(scale->modules.size(), 2U);
    EXPECT_THAT(scale->text, HasSubstr("measure the distance"));
}

TEST(FindShortfalls, OptionsOutOfRangeAreABug) {
    const SolvedWorld solved(scenarioWorld("plane", 1));
    ShortfallOptions options;
    options.directions = 0;
    EXPECT_THROW((void)findShortfalls(solved.solution, options), std::logic_error);
}

TEST(GravityRotation, WhatASphereOfDirectionsTells) {
    const AdjustmentOptions weights;
    const auto even = evenDirections(20);
    for (const Vector3d& up : even)
        EXPECT_NEAR(up.norm(), 1, 1e-12);
    const Matrix3d C = gravityRotationCovariance(even, 0.03, weights);
    // Two of three axes are seen in each pose.
    const double expected = 0.03 / weights.gravity / std::sqrt(20 * 2 / 3.0);
    for (Eigen::Index i = 0; i < 3; ++i)
        EXPECT_NEAR(std::sqrt(C(i, i)), expected, 0.3 * expected);

    Random random(7, "noise alone");
    std::vector<Vector3d> alike;
    for (int p = 0; p < 12; ++p)
        alike.push_back((Vector3d::UnitX() + 0.03 / weights.gravity * random.normal3()).normalized());
    const Matrix3d none = gravityRotationCovariance(alike, 0.03, weights);
    EXPECT_GT(std::sqrt(none(0, 0)), 0.5) << "noise tells nothing";
    EXPECT_LT(largestTilt(alike), 2 * kDegree);
    EXPECT_NEAR(largestTilt(std::vector<Vector3d>{Vector3d::UnitX(), -Vector3d::UnitX()}), 0, 1e-9);
}

}  // namespace
}  // namespace skincal
