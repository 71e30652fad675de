#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/estimation/compare.h"
#include "core/simulation/renderer.h"
#include "core/study/paper_experiments.h"
#include "core/workflow/simulated_recording.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

std::optional<BodyComparison> errorOf(const World& world, const BodyModel& body) {
    std::vector<NamedPose> found;
    std::vector<NamedPose> real;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        real.push_back({world.skin.modules[u].id, world.T_r_u[u]});
        if (body.modules[u].T_body_module)
            found.push_back({body.modules[u].id, *body.modules[u].T_body_module});
    }
    const auto difference = compareBodies(found, real);
    return difference ? std::optional(*difference) : std::nullopt;
}

std::size_t used(const BodyModel& body) {
    std::size_t count = 0;
    for (const BodyView& view : body.views)
        count += static_cast<std::size_t>(
            std::count_if(view.observations.begin(), view.observations.end(),
                          [](const BodyObservation& o) { return o.verdict == ObservationVerdict::Used; }));
    return count;
}

std::size_t seen(const BodyModel& body) {
    return static_cast<std::size_t>(
        std::count_if(body.modules.begin(), body.modules.end(), [](const BodyModule& m) { return m.seen; }));
}

class SimulatedWorldsTable : public testing::TestWithParam<std::string> {};

TEST_P(SimulatedWorldsTable, AreCalibrated) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const World world = buildWorld(*findScenario(GetParam()), seed);
        const Recording recording = recordingOf(world);
        const auto body = calibrate(recording, framesOf(world, recording));
        ASSERT_TRUE(body) << body.error().message;
        const auto error = errorOf(world, *body);
        ASSERT_TRUE(error);
        EXPECT_GE(error->compared * 10, world.T_r_u.size() * 9);
        EXPECT_LT(error->positionRms, 1.5e-3) << "seed " << seed;
        EXPECT_LT(error->rotationRms, 1.5 * kDegree) << "seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenarios, SimulatedWorldsTable,
                         testing::Values("arm", "cylinder", "plane", "freeform", "shoe-sole", "mixed-shapes",
                                         "outliers", "demo", "one-at-a-time", "coded", "reflection", "flicker",
                                         "coloured", "person", "occluder", "misaligned"),
                         [](const auto& parameter) {
                             std::string name = parameter.param;
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

TEST(SimulatedWorlds, ThePapersDetectorCalibratesPicturesOfOneAtATime) {
    const World world = buildWorld(*findScenario("one-at-a-time"), 1);
    const Recording recording = recordingOf(world);
    CalibrateOptions options;
    options.method = Method::Paper;
    const auto body = calibrate(recording, framesOf(world, recording), options);
    ASSERT_TRUE(body);
    EXPECT_EQ(body->generator.method, "paper");
    EXPECT_GT(body->quality.modulesPlaced, 0U);
}

TEST(SimulatedWorlds, ThePapersColoursAreALitSetLikeAnyOther) {
    const World world = buildWorld(*findScenario("coloured"), 1);
    const Recording recording = recordingOf(world);
    CalibrateOptions options;
    options.method = Method::Paper;
    const auto measurements = measure(recording, framesOf(world, recording), options);
    ASSERT_TRUE(measurements);
    std::size_t found = 0;
    for (const ViewDetections& view : measurements->views)
        found += view.found.size();
    EXPECT_GT(found, 10U);
}

TEST(SimulatedWorlds, TheOperatorsRejectionsCount) {
    const World world = buildWorld(*findScenario("plane"), 1);
    Recording recording = recordingOf(world);
    const ModuleId id = recording.views[0].detections[0].module;
    recording.decisions.push_back({"view0", id, "rejected", "a lamp"});
    const auto measurements = measure(recording, framesOf(world, recording));
    ASSERT_TRUE(measurements);
    EXPECT_EQ(measurements->views[0].found.size() + 1, recording.views[0].detections.size());
    EXPECT_THAT(measurements->views[0].undetected.back().reason, testing::HasSubstr("a lamp"));
}

// A table that returns much of the light shows every LED above it twice: from the pictures alone the decoder can't tell
// which is which, the body can.
TEST(SimulatedWorlds, TheBodyTellsLedsFromTheirReflections) {
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

TEST(SimulatedWorlds, TheOperatorsRejectionLeavesNoSpotToChoose) {
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

// Somebody who walks through may hide LEDs; what is found all the same is where it is.
TEST(SimulatedWorlds, AMovingPersonNeverBecomesAModule) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const World world = buildWorld(*findScenario("person"), seed);
        const Recording recording = recordingOf(world);
        const auto measurements = measure(recording, framesOf(world, recording));
        ASSERT_TRUE(measurements);
        const auto index = world.skin.indexById();
        for (std::size_t v = 0; v < measurements->views.size(); ++v) {
            for (const LedDetection& d : measurements->views[v].found) {
                const std::size_t u = index.at(d.module);
                const auto real = world.scenario.camera.project(world.T_r_v[v].inverse() *
                                                                (world.T_r_u[u] * world.skin.templateOf(u).led));
                ASSERT_TRUE(real);
                EXPECT_LT((d.pixel - *real).norm(), 1);
            }
        }
    }
}

// A view that was knocked half-way has no one place where the camera stood: what it says must not bend the body.
TEST(SimulatedWorlds, AKnockedCameraDoesNotMakeTheBodyWrong) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const World world = buildWorld(*findScenario("bumped-camera"), seed);
        const Recording recording = recordingOf(world);
        const auto body = calibrate(recording, framesOf(world, recording));
        ASSERT_TRUE(body) << body.error().message;
        const auto error = errorOf(world, *body);
        ASSERT_TRUE(error);
        EXPECT_LT(error->positionRms, 1.5e-3) << "seed " << seed;
        EXPECT_LT(error->rotationRms, 1.5 * kDegree) << "seed " << seed;
    }
}

// Turns about gravity tell nothing of how boards are turned against each other: no made-up shape, but the reason.
TEST(SimulatedWorlds, ParallelPosesAreNotEnoughAndItIsSaid) {
    const World world = buildWorld(*findScenario("parallel-poses"), 1);
    const Recording recording = recordingOf(world);
    const auto body = calibrate(recording, framesOf(world, recording));
    ASSERT_TRUE(body) << body.error().message;
    // What the pictures alone hold is placed, but nobody is told to rely on it.
    EXPECT_LT(body->quality.modulesPlaced, body->quality.modulesTotal);
    EXPECT_EQ(body->quality.trust, Trust::NotToBeTrusted);
    EXPECT_THAT(body->quality.missing, testing::Contains(testing::HasSubstr("tilt")));
}

TEST(SimulatedWorlds, AThousandModulesAreCalibrated) {
    const World world = buildWorld(*findScenario("thousand"), 1);
    const Recording recording = recordingOf(world);
    const auto body = calibrate(recording, framesOf(world, recording));
    ASSERT_TRUE(body) << body.error().message;
    const auto error = errorOf(world, *body);
    ASSERT_TRUE(error);
    EXPECT_GE(error->compared * 10, world.T_r_u.size() * 9);
    EXPECT_LT(error->positionRms, 1.5e-3);
    EXPECT_LT(error->rotationRms, 1.5 * kDegree);
}

class WritingSimulations : public testing::Test {
  protected:
    static World worldOf(const char* name) {
        Scenario scenario = *findScenario(name);
        scenario.views.count = std::min(scenario.views.count, 2);
        return buildWorld(scenario, 1);
    }
    std::vector<std::string> filesIn(const std::filesystem::path& directory) const {
        std::vector<std::string> files;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
            if (!entry.is_directory())
                files.push_back(entry.path().lexically_relative(directory).string());
        }
        return files;
    }
    test::TemporaryDirectory directory_;
};

TEST_F(WritingSimulations, CancelledHalfWayLeavesNoRecording) {
    RunContext context;
    int frames = 0;
    context.isCancelled = [&] { return ++frames > 15; };
    const auto written = writeSimulation(worldOf("coded"), directory_ / "w", false, context);
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().message(), testing::HasSubstr("cancelled"));
    EXPECT_FALSE(readRecording(directory_ / "w"));
    EXPECT_FALSE(std::filesystem::exists(directory_ / "w")) << "and nothing else";
}

TEST_F(WritingSimulations, ThereIsNoRecordingBeforeItsLastPicture) {
    bool early = false;
    RunContext context;
    context.report = [&](const Sentence&, double) {
        early = early || std::filesystem::exists(directory_ / "w" / "recording.json");
    };
    ASSERT_TRUE(writeSimulation(worldOf("coded"), directory_ / "w", false, context));
    EXPECT_FALSE(early);
    EXPECT_TRUE(readRecording(directory_ / "w"));
}

TEST_F(WritingSimulations, AFailureLeavesNoRecording) {
    // A file where the second view's folder should be.
    std::filesystem::create_directories(directory_ / "w" / "views");
    test::writeText(directory_ / "w" / "views" / "001", "in the way");
    EXPECT_FALSE(writeSimulation(worldOf("coded"), directory_ / "w", false));
    EXPECT_THAT(filesIn(directory_ / "w"), testing::ElementsAre("views/001"));
}

TEST_F(WritingSimulations, OverwritingReplacesARecordingAndNothingElse) {
    const auto directory = directory_ / "w";
    ASSERT_TRUE(writeSimulation(worldOf("one-at-a-time"), directory, false));
    ASSERT_TRUE(writeSimulation(worldOf("coded"), directory, true));
    const auto recording = readRecording(directory);
    ASSERT_TRUE(recording);
    EXPECT_EQ(filesIn(directory).size(), 2 * recording->views[0].frames.size() + 2) << "no picture of the longer scan";

    test::writeText(directory / "notes.txt", "mine");
    test::writeText(directory / "views" / "001" / "sketch.png", "mine");
    ASSERT_FALSE(writeSimulation(worldOf("plane"), directory, false)) << "not unasked";
    ASSERT_TRUE(writeSimulation(worldOf("plane"), directory, true));
    EXPECT_THAT(filesIn(directory), testing::UnorderedElementsAre("recording.json", "gravity.csv", "detections.csv",
                                                                  "notes.txt", "views/001/sketch.png"));
    ASSERT_TRUE(writeSimulation(worldOf("coded"), directory, true));
    EXPECT_THAT(filesIn(directory), testing::Not(testing::Contains("detections.csv")));
}

TEST_F(WritingSimulations, OverwritingFollowsNoLinks) {
    const auto directory = directory_ / "w";
    ASSERT_TRUE(writeSimulation(worldOf("plane"), directory, false));
    std::filesystem::create_directories(directory_ / "elsewhere" / "000");
    test::writeText(directory_ / "elsewhere" / "000" / "00000.png", "mine");
    std::filesystem::create_directory_symlink(directory_ / "elsewhere", directory / "views");
    ASSERT_TRUE(writeSimulation(worldOf("plane"), directory, true));
    EXPECT_TRUE(std::filesystem::exists(directory_ / "elsewhere" / "000" / "00000.png"));
}

TEST(SimulatedWorlds, CancellingStopsPictureAndNumberWork) {
    RunContext context;
    context.isCancelled = [] { return true; };
    for (const char* name : {"coded", "plane"}) {
        const World world = buildWorld(*findScenario(name), 1);
        const Recording recording = recordingOf(world);
        const auto body = calibrate(recording, framesOf(world, recording), {}, context);
        ASSERT_FALSE(body);
        EXPECT_TRUE(body.error().cancelled);
    }
}

TEST(PaperStudy, GivesEveryRowOfThePaperWithAFiniteBound) {
    PaperStudyOptions options;
    options.trials = 4;
    const PaperStudy study = runPaperStudy(options);
    EXPECT_EQ(study.rows.size(), 33U);
    for (const ExperimentRow& row : study.rows) {
        EXPECT_TRUE(row.ours.mean) << row.experiment << row.quantity;
        if (row.bound) {
            EXPECT_GT(*row.bound, 0) << row.experiment << row.quantity;
        }
    }
    const std::string table = studyTable(study);
    EXPECT_THAT(table, testing::HasSubstr("| Table I, 0.6 m, flat | shift along z, mm | 20.00 | 19.53 |"));
    EXPECT_THAT(table, testing::HasSubstr("| Table I, 1.4 m, bent to 40 mm | turn about z, rad | 0.175 | 0.182 |"));
    EXPECT_THAT(table, testing::HasSubstr("| Table I, 0.6 m, flat | turn about z, rad | 0.175 | – |"))
        << "not made up where the paper's text does not tell";
}

TEST(PaperStudy, TableOneReachesTheCramerRaoBound) {
    PaperStudyOptions options;
    options.trials = 40;
    options.only = "Table I";
    const PaperStudy study = runPaperStudy(options);
    ASSERT_EQ(study.rows.size(), 24U);
    double logarithms = 0;
    for (const ExperimentRow& row : study.rows) {
        const bool isFlat = row.experiment.find("flat") != std::string::npos;
        // Of flat patches far away most pictures could be of two poses that differ in the quantity: no answer then.
        EXPECT_GE(row.ours.solved, isFlat ? 6 : 39) << row.experiment << ", " << row.quantity;
        const double ratio = *row.ours.rms / *row.bound;
        logarithms += std::log(ratio) / static_cast<double>(study.rows.size());
        // 1.1, and three standard errors of an rms over so many trials.
        EXPECT_LT(ratio, 1.1 * (1 + 3 / std::sqrt(2.0 * row.ours.solved))) << row.experiment << ", " << row.quantity;
    }
    EXPECT_LT(std::exp(logarithms), 1.05);
}

}  // namespace
}  // namespace skincal
