#include "core/study/accuracy_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/random.h"
#include "core/study/random_world.h"
#include "core/study/study_world.h"

namespace skincal {
namespace {

using testing::HasSubstr;

AccuracyStudyOptions threeWorlds() {
    AccuracyStudyOptions options;
    options.worlds = 3;
    options.firstSeed = 3;
    return options;
}

TEST(AccuracyStudy, GivesTheSameFiguresWheneverItRuns) {
    AccuracyStudy a = runAccuracyStudy(threeWorlds());
    AccuracyStudy b = runAccuracyStudy(threeWorlds());
    ASSERT_EQ(a.worlds.size(), 3U);
    for (AccuracyStudy* study : {&a, &b}) {
        for (WorldAccuracy& world : study->worlds)
            world.seconds = 0;
    }
    EXPECT_EQ(accuracyTable(a), accuracyTable(b));
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(a.worlds[i].seed, 3 + i);
        EXPECT_EQ(a.worlds[i].ratio, b.worlds[i].ratio);
        EXPECT_EQ(a.worlds[i].consistency->drawnNees, b.worlds[i].consistency->drawnNees);
    }
    EXPECT_THAT(accuracyTable(a), HasSubstr("| 3 | arm, 4 patches"));
    EXPECT_THAT(accuracyTable(a), HasSubstr("geometric mean"));
}

TEST(AccuracyStudy, AWorldDoesNotDependOnThoseBefore) {
    const World world = randomWorld(5);
    const auto alone = assessAccuracy(measurementsOf(world), knownTruth(world), 5);
    ASSERT_TRUE(alone);
    const AccuracyStudy study = runAccuracyStudy(threeWorlds());
    EXPECT_EQ(alone->ratio, study.worlds[2].ratio);
    EXPECT_EQ(alone->placed, study.worlds[2].placed);
}

TEST(AccuracyStudy, CancelledItKeepsTheWorldsThatAreDone) {
    int reports = 0;
    RunContext context;
    context.report = [&](const Sentence&, double done) {
        ++reports;
        EXPECT_GE(done, 0);
        EXPECT_LT(done, 1);
    };
    context.isCancelled = [&] { return reports > 1; };
    const AccuracyStudy study = runAccuracyStudy(threeWorlds(), context);
    EXPECT_TRUE(study.cancelled);
    EXPECT_EQ(study.worlds.size(), 1U);
}

TEST(AccuracyStudy, OptionsOutOfRangeAreABrokenContract) {
    AccuracyStudyOptions options;
    options.worlds = 0;
    EXPECT_THROW((void)runAccuracyStudy(options), std::logic_error);
}

TEST(AccuracyStudy, WithoutAnythingMeasuredThereIsNothingToCompareAndItIsSaid) {
    const World world = randomWorld(4);
    Measurements measurements = measurementsOf(world);
    measurements.gravity.clear();
    for (ViewDetections& view : measurements.views)
        view.found.clear();
    const auto accuracy = assessAccuracy(measurements, knownTruth(world), 4);
    ASSERT_TRUE(accuracy);
    EXPECT_FALSE(accuracy->ratio);
    EXPECT_THAT(inWords(*accuracy), HasSubstr("failed: from the truth"));
    const AccuracySummary summary = summarise({*accuracy});
    EXPECT_EQ(summary.withoutResult, 1U);
    EXPECT_FALSE(summary.geometricMean);
    EXPECT_FALSE(summary.nees);
}

WorldAccuracy worldWith(std::uint64_t seed, double ratio, double nees) {
    WorldAccuracy world;
    world.seed = seed;
    world.ratio = ratio;
    world.consistency = Consistency{1, nees, nees, 1, 0};
    return world;
}

TEST(AccuracySummary, GivesGeometricMeanAndWorst) {
    const AccuracySummary summary = summarise({worldWith(1, 0.5, 6), worldWith(2, 4, 6), worldWith(3, 0.5, 6)});
    EXPECT_NEAR(*summary.geometricMean, 1, 1e-12);
    EXPECT_EQ(*summary.worst, 4);
    EXPECT_EQ(summary.worstSeed, 2U);
}

// Errors drawn from the covariances pass in 95 % of studies, drawn from ones a third larger in few.
TEST(AccuracySummary, TheTestTellsRightCovariancesFromWrongOnes) {
    Random random(1, "chi squared");
    constexpr int kStudies = 400;
    for (const double scale : {1.0, 1.3}) {
        int passed = 0;
        for (int study = 0; study < kStudies; ++study) {
            std::vector<WorldAccuracy> worlds;
            for (std::uint64_t seed = 0; seed < 100; ++seed) {
                double nees = 0;
                for (int axis = 0; axis < 6; ++axis)
                    nees += scale * std::pow(random.normal(), 2);
                worlds.push_back(worldWith(seed, 1, nees));
            }
            passed += summarise(worlds).nees->passes() ? 1 : 0;
        }
        if (scale == 1.0)
            EXPECT_NEAR(passed / double{kStudies}, 0.95, 0.035);
        else
            EXPECT_LT(passed / double{kStudies}, 0.1);
    }
}

}  // namespace
}  // namespace skincal
