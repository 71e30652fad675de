#include "core/estimation/shape_spots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "core/estimation/spot_settlement.h"
#include "core/geometry/random.h"
#include "tests/unit/estimation/solved_world.h"

namespace skincal {
namespace {

/// Where a table below what the camera sees shows an LED; nothing where it does not.
std::optional<Vector2d> reflectionOf(const World& world, std::size_t view, std::size_t module) {
    const Vector3d up_v(0, -std::cos(0.15), -std::sin(0.15));
    constexpr double kBelow = 0.12;  // m
    const Isometry3d T_v_r = world.T_r_v[view].inverse();
    const Vector3d led_v = T_v_r * (world.T_r_u[module] * world.skin.templateOf(module).led);
    const Vector3d normal_v = (T_v_r * world.T_r_u[module]).linear().col(2);
    const auto mirrored = [&](const Vector3d& v) -> Vector3d { return v - 2 * up_v.dot(v) * up_v; };
    const Vector3d image_v = mirrored(led_v) - 2 * kBelow * up_v;
    if (image_v.z() < 0.05 || mirrored(normal_v).dot(-image_v.normalized()) < 0.2)
        return std::nullopt;
    return world.scenario.camera.project(image_v);
}

/// Every LED of a view becomes a choice between it and its reflection, and what the camera does not see shows in the
/// table alone.
void doubtAll(const World& world, Measurements& measurements, std::size_t view, Random& random) {
    ViewDetections& detections = measurements.views[view];
    const auto index = measurements.skin.indexById();
    const auto hand = [&](ModuleId module, std::vector<SpotChoice> spots) {
        if (spots.size() > 1 && random.uniform() < 0.5)
            std::swap(spots[0], spots[1]);
        Undetected undetected{module, DetectionVerdict::Ambiguous, Sentence::verbatim("spots blink its word")};
        undetected.spots = std::move(spots);
        detections.undetected.push_back(std::move(undetected));
    };
    std::vector<bool> isSeen(world.T_r_u.size(), false);
    for (const LedDetection& found : detections.found) {
        const std::size_t u = index.at(found.module);
        isSeen[u] = true;
        std::vector<SpotChoice> spots{{found.pixel, found.sigma_px, 1}};
        if (const auto reflection = reflectionOf(world, view, u))
            spots.push_back({*reflection, found.sigma_px, 0.9});
        hand(found.module, std::move(spots));
    }
    detections.found.clear();
    for (std::size_t u = 0; u < isSeen.size(); ++u) {
        if (const auto reflection = reflectionOf(world, view, u); !isSeen[u] && reflection)
            hand(world.skin.modules[u].id, {{*reflection, 0.05, 1}});
    }
}

bool isLed(const World& world, std::size_t view, std::size_t module, const Vector2d& pixel) {
    const Vector3d led_r = world.T_r_u[module] * world.skin.templateOf(module).led;
    const auto real = world.scenario.camera.project(world.T_r_v[view].inverse() * led_r);
    return real && (*real - pixel).norm() < 1;
}

class DoubtfulWorlds : public ::testing::TestWithParam<const char*> {};

TEST_P(DoubtfulWorlds, HaveABodyBesideTheirMirrorImage) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const World world = scenarioWorld(GetParam(), seed);
        Random random(seed, "table");
        Measurements measurements = measurementsOf(world);
        std::size_t leds = 0;
        std::size_t twice = 0;
        for (std::size_t v = 0; v < measurements.views.size(); ++v) {
            leds += measurements.views[v].found.size();
            doubtAll(world, measurements, v, random);
            for (const Undetected& one : measurements.views[v].undetected)
                twice += one.spots.size() > 1 ? 1 : 0;
        }
        ASSERT_GT(twice * 3, leds) << "a table that shows nothing proves nothing";
        const SolvedWorld solved(world, measurements);
        std::size_t taken = 0;
        for (std::size_t i = 0; i < solved.solution.input.pixels.size(); ++i) {
            const PixelObservation& o = solved.solution.input.pixels[i];
            if (solved.solution.estimate.rejected[i])
                continue;
            ++taken;
            EXPECT_TRUE(isLed(world, o.view, o.module, o.pixel)) << "seed " << seed << ", view " << o.view;
        }
        EXPECT_GE(taken * 10, leds * 8) << "seed " << seed << ": " << taken << " of " << leds;
        const auto& T_r_v = solved.solution.solved.T_r_v;
        EXPECT_GE(std::count_if(T_r_v.begin(), T_r_v.end(), [](const auto& T) { return T.has_value(); }) + 1,
                  std::ssize(T_r_v))
            << "seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, DoubtfulWorlds, ::testing::Values("plane", "cylinder", "freeform"),
                         [](const auto& parameter) { return std::string(parameter.param); });

TEST(ShapeSpots, AViewThatIsAllDoubtIsAddedToABody) {
    const World world = scenarioWorld("freeform", 2);
    Random random(2, "table");
    Measurements all = measurementsOf(world);
    const std::size_t last = all.views.size() - 1;
    const std::size_t leds = all.views[last].found.size();
    doubtAll(world, all, last, random);
    Measurements first = all;
    first.views.pop_back();
    const SolvedWorld before(world, first);
    const GravityTable gravity(all.skin, all.gravity);
    auto next = updateJointly(before.solution, all, gravity);
    ASSERT_TRUE(next);
    for (int update = 0; update < 2; ++update) {
        ASSERT_TRUE(next->solved.T_r_v[last]);
        EXPECT_EQ(next->input.pixels.size(), next->estimate.rejected.size());
        std::size_t taken = 0;
        for (const SpotVerdict& verdict : next->estimate.spots) {
            if (!verdict.pixel)
                continue;
            ++taken;
            EXPECT_TRUE(isLed(world, verdict.view, verdict.module, next->input.pixels[*verdict.pixel].pixel));
        }
        EXPECT_GE(taken * 10, leds * 9) << taken << " of " << leds;
        std::set<std::pair<std::size_t, std::size_t>> pixels;
        for (const PixelObservation& o : next->input.pixels)
            EXPECT_TRUE(pixels.insert({o.view, o.module}).second) << "update " << update;
        const BodySolution again = *next;
        next = updateJointly(again, all, gravity);
        ASSERT_TRUE(next);
    }
}

/// The first view of a world whose patches have the shapes that a solution gave them.
struct OneView {
    World world;
    Measurements measurements = measurementsOf(world);
    GravityTable gravity{measurements.skin, measurements.gravity};
    SkinLayout layout;
    std::vector<PatchShape> shapes;

    explicit OneView(World w = scenarioWorld("freeform", 1)) : world(std::move(w)) {
        const BodySolution solution = solveJointly(measurements, gravity).value();
        layout = solution.layout;
        shapes = solution.shapes.shapes;
        measurements.views.resize(1);
    }
    /// Expects that each is an LED, and none is chosen twice.
    [[nodiscard]] std::vector<ChosenSpot> chosen(const std::vector<PixelObservation>& sure = {}) const {
        auto all = chooseSpotsByShape(measurements, layout, shapes, sure);
        std::set<std::size_t> modules;
        for (const ChosenSpot& one : all) {
            EXPECT_TRUE(isLed(world, one.view, one.module, one.spot.pixel)) << "module " << one.module;
            EXPECT_TRUE(modules.insert(one.module).second) << "module " << one.module;
        }
        return all;
    }
};

TEST(ShapeSpots, NoneIsTakenWhereFewAreThereOrAPatchHasSureOnes) {
    OneView one;
    const auto index = one.measurements.skin.indexById();
    const std::size_t patch = one.layout.patchOf[index.at(one.measurements.views[0].found[0].module)];
    std::vector<PixelObservation> sure;
    ViewDetections& view = one.measurements.views[0];
    std::erase_if(view.found, [&](const LedDetection& d) { return one.layout.patchOf[index.at(d.module)] != patch; });
    for (const LedDetection& found : view.found)
        sure.push_back({0, index.at(found.module), found.pixel, found.sigma_px});
    ASSERT_GE(sure.size(), 10U);
    EXPECT_TRUE(one.chosen(sure).empty()) << "there is nothing to choose";
    Random random(1, "table");
    doubtAll(one.world, one.measurements, 0, random);
    std::erase_if(view.undetected,
                  [&](const Undetected& u) { return one.layout.patchOf[index.at(u.module)] != patch; });
    EXPECT_GE(one.chosen().size() * 10, sure.size() * 8);
    EXPECT_THAT(one.chosen().front().reason.english(), ::testing::HasSubstr("where the shape of its patch has it"));
    EXPECT_TRUE(one.chosen({sure.begin(), sure.begin() + 4}).empty()) << "the body can tell";
    // Four in one place are no pose.
    std::vector<PixelObservation> chaos(sure.begin(), sure.begin() + 4);
    for (PixelObservation& o : chaos)
        o.pixel = chaos.front().pixel;
    EXPECT_GT(one.chosen(chaos).size(), 6U);
    view.undetected.resize(5);
    EXPECT_TRUE(one.chosen().empty());
}

TEST(ShapeSpots, OfAPatchThatOnlyTheMirrorShowsNoneIsTaken) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        OneView one(scenarioWorld("freeform", seed));
        Random random(seed, "table");
        doubtAll(one.world, one.measurements, 0, random);
        std::size_t left = 0;
        for (Undetected& undetected : one.measurements.views[0].undetected) {
            const std::size_t u = one.measurements.skin.indexById().at(undetected.module);
            std::erase_if(undetected.spots, [&](const SpotChoice& spot) { return isLed(one.world, 0, u, spot.pixel); });
            left += undetected.spots.size();
        }
        ASSERT_GT(left, 10U);
        EXPECT_TRUE(one.chosen().empty()) << "seed " << seed;
    }
}

// A single row round an arm lies in a plane, and so does its mirror image, which a turn brings there.
TEST(ShapeSpots, OfASingleRowNoneIsTaken) {
    PatchPlan row = bentPatch(16, 0.12);
    row.strip = true;
    World world = bareWorld({row, flatPatch(19)}, 1, 0.05);
    const Isometry3d middle = world.T_r_u[8];
    for (const double tilt : {-20.0, 0.0, 20.0}) {
        const Isometry3d T_u_v =
            makeIsometry(Eigen::AngleAxisd(180 * kDegree + tilt * kDegree, Vector3d::UnitX()).toRotationMatrix(),
                         Vector3d::Zero()) *
            makeIsometry(Matrix3d::Identity(), {0, 0, -0.6});
        world.T_r_v.push_back(middle * T_u_v);
    }
    OneView one(world);
    ASSERT_GE(one.measurements.views[0].found.size(), 8U);
    Random random(1, "table");
    doubtAll(one.world, one.measurements, 0, random);
    // A card hides it, and the table shows it.
    std::size_t left = 0;
    for (Undetected& undetected : one.measurements.views[0].undetected) {
        const std::size_t u = one.measurements.skin.indexById().at(undetected.module);
        std::erase_if(undetected.spots, [&](const SpotChoice& spot) {
            return one.layout.patchOf[u] != one.layout.patchOf[8] || isLed(one.world, 0, u, spot.pixel);
        });
        left += undetected.spots.size();
    }
    ASSERT_GE(left, 6U);
    EXPECT_TRUE(one.chosen().empty());
}

// Where the body has the LED elsewhere, what was taken is open again, and the reason is told.
TEST(ShapeSpots, WhatDoesNotStandIsOpenAgain) {
    const World world = scenarioWorld("freeform", 2);
    Random random(2, "table");
    Measurements all = measurementsOf(world);
    const SolvedWorld sure(world, all);
    doubtAll(world, all, 0, random);
    SolvedWorld solved(world, all);
    BodySolution& solution = solved.solution;
    const auto taken = [&] {
        return std::count_if(solution.estimate.spots.begin(), solution.estimate.spots.end(),
                             [](const SpotVerdict& verdict) { return verdict.pixel.has_value(); });
    };
    const auto before = taken();
    ASSERT_GT(before, 6);
    const std::size_t pixels = solution.input.pixels.size();
    const auto first = std::find_if(solution.estimate.spots.begin(), solution.estimate.spots.end(),
                                    [](const SpotVerdict& verdict) { return verdict.pixel.has_value(); });
    solution.solved.T_r_u[first->module].reset();
    const std::size_t module = first->module;
    dropRejectedSpots(solution);
    EXPECT_LT(taken(), before);
    EXPECT_EQ(static_cast<std::size_t>(before - taken()), pixels - solution.input.pixels.size());
    EXPECT_EQ(solution.estimate.rejected.size(), solution.input.pixels.size());
    for (const SpotVerdict& verdict : solution.estimate.spots) {
        if (verdict.module == module) {
            EXPECT_THAT(verdict.reason.english(), ::testing::HasSubstr("module has no pose"));
        } else if (verdict.pixel) {
            EXPECT_EQ(solution.input.pixels[*verdict.pixel].module, verdict.module);
        }
    }
    solution.solved.T_r_v[0].reset();
    dropRejectedSpots(solution);
    EXPECT_EQ(taken(), 0);
}

TEST(ShapeSpots, WhereTwoSpotsLieAlikeTheBodyIsAsked) {
    OneView one;
    Random random(1, "table");
    doubtAll(one.world, one.measurements, 0, random);
    const std::size_t before = one.chosen().size();
    ASSERT_GT(before, 6U);
    const ModuleId module = one.measurements.skin.modules[one.chosen().front().module].id;
    for (Undetected& undetected : one.measurements.views[0].undetected) {
        if (undetected.module == module)
            undetected.spots.push_back({one.chosen().front().spot.pixel + Vector2d(3, 2), 0.05, 0.5});
    }
    const auto now = one.chosen();
    EXPECT_EQ(now.size(), before - 1);
    EXPECT_TRUE(std::none_of(now.begin(), now.end(), [&](const ChosenSpot& chosen) {
        return one.measurements.skin.modules[chosen.module].id == module;
    }));
}

}  // namespace
}  // namespace skincal
