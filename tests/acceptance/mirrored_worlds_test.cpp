// Bodies above a table that mirrors their LEDs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/simulation/renderer.h"
#include "core/workflow/simulated_recording.h"
#include "tests/acceptance/compared_bodies.h"

namespace skincal {
namespace {

// A table that returns much of the light shows every LED above it twice: from the pictures alone the decoder can't tell
// which is which, the body can.
TEST(MirroredWorlds, TheBodyTellsLedsFromTheirReflections) {
    std::size_t chosen = 0;
    std::size_t doubtful = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const World world = buildWorld(*findScenario("mirror"), seed);
        const Recording recording = recordingOf(world);
        const auto measurements = measure(recording, framesOf(world, recording));
        ASSERT_TRUE(measurements);
        Measurements without = *measurements;
        for (ViewDetections& view : without.views) {
            for (Undetected& undetected : view.undetected)
                undetected.spots.clear();
        }
        const auto body = calibrateJoint(*measurements);
        const auto bodyWithout = calibrateJoint(without);
        ASSERT_TRUE(body) << body.error().message();
        ASSERT_TRUE(bodyWithout);
        const auto index = world.skin.indexById();
        std::size_t here = 0;
        for (std::size_t v = 0; v < body->views.size(); ++v) {
            for (const Undetected& undetected : measurements->views[v].undetected)
                doubtful += undetected.spots.empty() ? 0 : 1;
            for (const BodyObservation& o : body->views[v].observations) {
                if (o.verdict != ObservationVerdict::Used || o.reason.empty())
                    continue;
                ++here;
                const std::size_t u = index.at(o.module);
                const auto real = world.scenario.camera.project(world.T_r_v[v].inverse() *
                                                                (world.T_r_u[u] * world.skin.templateOf(u).led));
                ASSERT_TRUE(real);
                EXPECT_LT((*o.pixel - *real).norm(), 1) << "seed " << seed << ", module " << o.module.value;
            }
        }
        chosen += here;
        EXPECT_EQ(used(*body), used(*bodyWithout) + here);
        EXPECT_GE(seen(*body), seen(*bodyWithout));
        EXPECT_GE(body->quality.modulesPlaced, bodyWithout->quality.modulesPlaced);
        const auto error = errorOf(world, *body);
        const auto errorWithout = errorOf(world, *bodyWithout);
        ASSERT_TRUE(error);
        EXPECT_LT(error->positionRms, 1.5e-3) << "seed " << seed;
        EXPECT_LT(error->rotationRms, 1.5 * kDegree) << "seed " << seed;
        if (errorWithout && errorWithout->compared == error->compared) {
            EXPECT_LT(error->positionRms, 1.1 * errorWithout->positionRms + 0.05e-3) << "seed " << seed;
        }
    }
    EXPECT_GT(doubtful, 20U);
    EXPECT_GT(chosen * 10, doubtful * 7) << chosen << " of " << doubtful;
}

/// A body before which something stands, or that has a far side, above a table in which LEDs show that are out of the
/// camera's sight.
World aboveATable(const char* scenario, double reflection, std::uint64_t seed) {
    Scenario what = *findScenario(scenario);
    what.views.scan = ScanKind::Coded;
    what.disturbances.reflection = reflection;
    what.disturbances.occluder = true;
    return buildWorld(what, seed);
}

/// How many detections are none of the LED's: it is somewhere else in the picture, or out of sight.
std::size_t countAstray(const World& world, const Measurements& measurements) {
    const auto index = world.skin.indexById();
    std::size_t astray = 0;
    for (std::size_t v = 0; v < measurements.views.size(); ++v) {
        for (const LedDetection& found : measurements.views[v].found) {
            const auto real = visiblePixel(world, v, index.at(found.module), visibilityOfLight());
            astray += real && (found.pixel - *real).norm() < 1 ? 0U : 1U;
        }
    }
    return astray;
}

void expectNobodyAstray(const World& world, const BodyModel& body) {
    const auto index = world.skin.indexById();
    for (std::size_t v = 0; v < body.views.size(); ++v) {
        for (const BodyObservation& o : body.views[v].observations) {
            if (o.verdict != ObservationVerdict::Used)
                continue;
            const auto real = visiblePixel(world, v, index.at(o.module), visibilityOfLight());
            ASSERT_TRUE(real) << "module " << o.module.value << " is out of sight";
            EXPECT_LT((*o.pixel - *real).norm(), 1) << "module " << o.module.value << ": " << o.reason;
        }
    }
    // In a bright mirror nearly all is doubt, and there may be no body.
    if (const auto error = errorOf(world, body)) {
        EXPECT_LT(error->positionRms, 1.5e-3);
        EXPECT_LT(error->rotationRms, 1.5 * kDegree);
    }
}

class AboveATable : public testing::TestWithParam<std::tuple<const char*, double>> {};

// The only spot of a module may be its reflection. Where the picture shows others twice the decoder hands it on as a
// doubt, which the body settles …
TEST_P(AboveATable, WhatTheMirrorAloneShowsIsPutNowhereElse) {
    std::size_t doubts = 0;
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const World world = aboveATable(std::get<0>(GetParam()), std::get<1>(GetParam()), seed);
        const Recording recording = recordingOf(world);
        auto measurements = measure(recording, framesOf(world, recording));
        ASSERT_TRUE(measurements);
        EXPECT_EQ(countAstray(world, *measurements), 0U) << "seed " << seed;
        const auto body = calibrateJoint(*measurements);
        ASSERT_TRUE(body) << body.error().message();
        expectNobodyAstray(world, *body);
        const bool isDull = std::get<1>(GetParam()) < 0.35;
        EXPECT_TRUE(!isDull || errorOf(world, *body));
        if (!isDull)
            continue;
        // … and where it can't know of the mirror, the body rejects what it takes for the LED.
        for (ViewDetections& view : measurements->views) {
            for (const Undetected& undetected : view.undetected) {
                if (undetected.spots.size() != 1)
                    continue;
                ++doubts;
                view.found.push_back(
                    {undetected.module, undetected.spots.front().pixel, undetected.spots.front().sigma_px});
            }
            std::erase_if(view.undetected, [](const Undetected& one) { return one.spots.size() == 1; });
        }
        const auto deceived = calibrateJoint(*measurements);
        ASSERT_TRUE(deceived) << deceived.error().message();
        expectNobodyAstray(world, *deceived);
    }
    EXPECT_TRUE(doubts > 5 || std::get<1>(GetParam()) >= 0.35);
}

INSTANTIATE_TEST_SUITE_P(Bodies, AboveATable,
                         testing::Values(std::tuple("mirror", 0.3), std::tuple("mirror", 0.4),
                                         std::tuple("cylinder", 0.3), std::tuple("cylinder", 0.8)),
                         [](const auto& what) {
                             return std::string(std::get<0>(what.param)) +
                                    (std::get<1>(what.param) < 0.35 ? "Dull" : "Bright");
                         });

class BrightTable : public testing::TestWithParam<std::tuple<const char*, double>> {};

// A table that returns half of the light or more leaves hardly an LED that is sure: here the shape of the patches tells
// which way round the body is.
TEST_P(BrightTable, ThereIsABodyBesideItsMirrorImage) {
    const World world = aboveATable(std::get<0>(GetParam()), std::get<1>(GetParam()), 1);
    const Recording recording = recordingOf(world);
    const auto measurements = measure(recording, framesOf(world, recording));
    ASSERT_TRUE(measurements);
    EXPECT_EQ(countAstray(world, *measurements), 0U);
    const auto body = calibrateJoint(*measurements);
    ASSERT_TRUE(body) << body.error().message();
    expectNobodyAstray(world, *body);
    EXPECT_TRUE(errorOf(world, *body));
    std::size_t visible = 0;
    for (std::size_t v = 0; v < measurements->views.size(); ++v) {
        EXPECT_EQ(body->views[v].status, "placed");
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
            visible += visiblePixel(world, v, u, visibilityOfLight()) ? 1 : 0;
    }
    EXPECT_GE(used(*body) * 10, visible * 9) << used(*body) << " of " << visible;
}

INSTANTIATE_TEST_SUITE_P(Bodies, BrightTable,
                         testing::Combine(testing::Values("mirror", "plane", "freeform"), testing::Values(0.5, 0.9)),
                         [](const auto& what) {
                             return std::string(std::get<0>(what.param)) +
                                    std::to_string(std::lround(100 * std::get<1>(what.param)));
                         });

TEST(MirroredWorlds, TheOperatorsRejectionLeavesNoSpotToChoose) {
    Scenario scenario = *findScenario("mirror");
    scenario.views.count = 1;
    const World world = buildWorld(scenario, 1);
    Recording recording = recordingOf(world);
    const auto rejected = [&](const Undetected& u) { return u.module == recording.decisions.front().module; };
    const auto before = measure(recording, framesOf(world, recording));
    ASSERT_TRUE(before);
    const auto several = std::find_if(before->views[0].undetected.begin(), before->views[0].undetected.end(),
                                      [](const Undetected& u) { return !u.spots.empty(); });
    ASSERT_NE(several, before->views[0].undetected.end());
    recording.decisions.push_back({"view0", several->module, "rejected", "a table"});
    const auto after = measure(recording, framesOf(world, recording));
    ASSERT_TRUE(after);
    ASSERT_EQ(after->views[0].undetected.size(), before->views[0].undetected.size());
    const auto now = std::find_if(after->views[0].undetected.begin(), after->views[0].undetected.end(), rejected);
    ASSERT_NE(now, after->views[0].undetected.end());
    EXPECT_TRUE(now->spots.empty());
    EXPECT_EQ(now->reason, "rejected by the operator: a table");
}

}  // namespace
}  // namespace skincal
