// Recordings of simulated worlds on the disc.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/workflow/simulated_recording.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

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

}  // namespace
}  // namespace skincal
