#include "core/estimation/shape_spots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

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
        // What was taken stays, and is not taken twice.
        const BodySolution again = *next;
        next = updateJointly(again, all, gravity);
        ASSERT_TRUE(next);
    }
}

struct OnePatch {
    World world = scenarioWorld("freeform", 1);
    Measurements measurements = measurementsOf(world);
    GravityTable gravity{measurements.skin, measurements.gravity};
    SkinLayout layout;
    std::vector<PatchShape> shapes;

    OnePatch() {
        const BodySolution solution = solveJointly(measurements, gravity).value();
        layout = solution.layout;
        shapes = solution.shapes.shapes;
        measurements.views.resize(1);
    }
    [[nodiscard]] std::vector<ChosenSpot> chosen(const std::vector<PixelObservation>& sure = {}) const {
        return chooseSpotsByShape(measurements, layout, shapes, sure);
    }
};

TEST(ShapeSpots, NoneIsTakenWhereFewAreThereOrAPatchHasSureOnes) {
    OnePatch one;
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
    view.undetected.resize(5);
    EXPECT_TRUE(one.chosen().empty());
}

TEST(ShapeSpots, WhereTwoSpotsLieAlikeTheBodyIsAsked) {
    OnePatch one;
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
