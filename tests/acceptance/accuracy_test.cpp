#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/formats/files.h"
#include "core/formats/recording_parse.h"
#include "core/formats/truth_json.h"
#include "core/study/accuracy_study.h"
#include "core/workflow/calibrate.h"

namespace skincal {
namespace {

// What the joint method promises: to reach, from the data alone, what the same estimate reaches that starts at the
// truth and knows the noise and which detections are false.
constexpr double kWorstRatio = 1.25;
constexpr double kMeanRatio = 1.05;

void expectAsGoodAsFromTheTruth(const WorldAccuracy& world) {
    EXPECT_TRUE(world.failure.empty()) << inWords(world);
    EXPECT_EQ(world.missed, 0U) << inWords(world);
    ASSERT_TRUE(world.ratio) << inWords(world);
    EXPECT_LE(*world.ratio, kWorstRatio) << inWords(world);
    ASSERT_TRUE(world.consistency) << inWords(world);
    EXPECT_EQ(world.consistency->modules, world.placed) << inWords(world);
    EXPECT_EQ(world.consistency->beyondFive, 0U) << inWords(world);
}

TEST(Accuracy, RandomWorldsAreCalibratedAsWellAsIfTheTruthWereKnown) {
    AccuracyStudyOptions options;
    options.worlds = 30;
    options.firstSeed = 1;
    const AccuracyStudy study = runAccuracyStudy(options);
    ASSERT_EQ(study.worlds.size(), 30U);
    for (const WorldAccuracy& world : study.worlds)
        expectAsGoodAsFromTheTruth(world);
    const AccuracySummary summary = summarise(study.worlds);
    ASSERT_TRUE(summary.geometricMean);
    EXPECT_LE(*summary.geometricMean, kMeanRatio) << accuracyTable(study);
    ASSERT_TRUE(summary.nees);
    RecordProperty("ratio_geometric_mean", fmt::format("{:.3f}", *summary.geometricMean));
    RecordProperty("ratio_worst", fmt::format("{:.3f}", *summary.worst));
    RecordProperty("nees_mean", fmt::format("{:.2f}", summary.nees->mean));
}

/// The noise that the other program put in, as it wrote down in its truth. That of the pixels comes from the true
/// residuals: pictures have their own.
TrueNoise noiseOf(const std::filesystem::path& truthFile) {
    const nlohmann::json json = nlohmann::json::parse(readFile(truthFile, kMaxJsonBytes).value());
    const auto& args = json.at("args");
    TrueNoise noise;
    noise.accelerometer = args.at("acc_noise");
    noise.bias = args.at("bias");
    noise.scale = args.at("scale");
    noise.playPosition = args.at("placement");
    noise.playTilt = args.at("tilt");
    return noise;
}

TEST(Accuracy, RecordingsOfOthersAreCalibratedAsWellAsIfTheTruthWereKnown) {
    std::vector<WorldAccuracy> all;
    const std::filesystem::path recordings = std::filesystem::path(SKINCAL_TEST_DATA) / "recordings";
    for (const std::string name : {"cylinder-cables-detections", "flat-detections", "freeform-coded-one-view",
                                   "freeform-detections", "freeform-single-images", "outliers-detections"}) {
        const auto directory = recordings / (name + ".skinrec");
        const auto recording = readRecording(directory);
        ASSERT_TRUE(recording) << recording.error().message();
        const auto truth = readTruth(directory / "truth.json");
        ASSERT_TRUE(truth) << truth.error().message();
        const auto measurements = measure(*recording, framesOf(directory, *recording));
        ASSERT_TRUE(measurements) << measurements.error().message;
        const KnownTruth known = knownTruth(*truth, *measurements, noiseOf(directory / "truth.json"));
        auto accuracy = assessAccuracy(*measurements, known, all.size());
        ASSERT_TRUE(accuracy) << accuracy.error().message();
        accuracy->world = name;
        expectAsGoodAsFromTheTruth(*accuracy);
        RecordProperty(name, fmt::format("{:.3f}", accuracy->ratio.value_or(0)));
        all.push_back(std::move(*accuracy));
    }
    const AccuracySummary summary = summarise(all);
    ASSERT_TRUE(summary.geometricMean);
    EXPECT_LE(*summary.geometricMean, kMeanRatio);
}

}  // namespace
}  // namespace skincal
