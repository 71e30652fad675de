#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Outcome {
    int code = -1;
    std::string output;
};

class AdviseCommand : public testing::Test {
  protected:
    std::string at(const std::string& name) const { return (directory_ / name).string(); }

    Outcome run(const std::string& arguments) const {
        Outcome outcome;
        FILE* pipe = ::popen((std::string(SKINCAL_PROGRAM) + " " + arguments + " 2>&1").c_str(), "r");
        std::array<char, 4096> buffer{};
        while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
            outcome.output.append(buffer.data(), n);
        const int status = ::pclose(pipe);
        outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        return outcome;
    }

    std::string simulated(const std::string& scenario) const {
        EXPECT_EQ(run("simulate " + scenario + " --seed 1 -o " + at(scenario)).code, 0);
        return at(scenario);
    }

    nlohmann::json json(const std::string& recording, int code) const {
        const Outcome outcome = run("advise --json " + recording);
        EXPECT_EQ(outcome.code, code) << outcome.output;
        return nlohmann::json::parse(outcome.output);
    }

    test::TemporaryDirectory directory_;
};

TEST_F(AdviseCommand, AGoodRecordingLacksNothing) {
    const Outcome outcome = run("advise " + simulated("plane"));
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.output, HasSubstr("What is missing\n  nothing"));
    EXPECT_THAT(outcome.output, HasSubstr("would hardly help"));
    EXPECT_FALSE(std::filesystem::exists(at("plane.body.json"))) << "nothing is written";
}

TEST_F(AdviseCommand, NothingPlacedIsOneAndNothingIsForecast) {
    const std::string recording = simulated("plane");
    test::writeText(recording + "/detections.csv", "view,module,x,y,sigma\n");
    const Outcome outcome = run("advise " + recording);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_THAT(outcome.output, HasSubstr("was seen in no view"));
    EXPECT_THAT(outcome.output, Not(HasSubstr("Next")));
    const auto advice = json(recording, 1);
    EXPECT_EQ(advice["shortfalls"][0]["kind"], "patch-unseen");
    EXPECT_EQ(advice["shortfalls"][0]["patches"].size(), 1U);
    EXPECT_TRUE(advice["worst_sigma"].is_null());
    EXPECT_TRUE(advice["next_poses"].empty());
    EXPECT_TRUE(advice["next_views"].empty());
}

TEST_F(AdviseCommand, TheDirectionsThatGravityLacks) {
    const std::string recording = simulated("plane");
    // All readings of all poses are those of the first.
    const std::string all = test::readText(recording + "/gravity.csv");
    std::istringstream lines(all);
    std::string text;
    std::string line;
    std::getline(lines, line);
    text = line + "\n";
    while (std::getline(lines, line)) {
        if (line.rfind("0,", 0) == 0)
            text += line + "\n" + "1" + line.substr(1) + "\n";
    }
    test::writeText(recording + "/gravity.csv", text);
    const std::string detections = test::readText(recording + "/detections.csv");
    test::writeText(recording + "/detections.csv", detections.substr(0, detections.find("view3,")));
    const Outcome outcome = run("advise --json " + recording);
    const auto advice = nlohmann::json::parse(outcome.output);
    EXPECT_EQ(advice["shortfalls"][0]["kind"], "poses-alike");
    EXPECT_EQ(advice["shortfalls"][0]["unit"], "deg");
    EXPECT_THAT(advice["shortfalls"][0]["text"].get<std::string>(), HasSubstr("too few or too alike"));
}

TEST_F(AdviseCommand, ViewsThatShowWhatWasNeverSeen) {
    const std::string recording = simulated("arm");
    const Outcome outcome = run("advise --best 2 " + recording);
    EXPECT_EQ(outcome.code, 0);
    const std::string text = std::regex_replace(outcome.output, std::regex("\\s+"), " ");  // as before it was wrapped
    EXPECT_THAT(text, HasSubstr("for no view looks at"));
    EXPECT_THAT(text, HasSubstr("for the first time"));
    EXPECT_THAT(outcome.output, Not(HasSubstr("\n  3. ")));
    const auto advice = json(recording, 0);
    const auto& views = advice["next_views"];
    ASSERT_GT(views.size(), 5U);
    EXPECT_LT(views[0]["gain"]["worst_after"], views[0]["gain"]["worst_before"]);
    EXPECT_LE(views[0]["gain"]["worst_after"], views[1]["gain"]["worst_after"]);
    EXPECT_EQ(views[0]["T_body_camera"]["rotation_wxyz"].size(), 4U);
    EXPECT_EQ(advice["next_poses"].size(), 28U) << "as many as are affordable";
    EXPECT_EQ(advice["next_poses"][0]["up"].size(), 3U);
}

TEST_F(AdviseCommand, BadInputIsTwo) {
    EXPECT_EQ(run("advise " + at("nowhere")).code, 2);
    EXPECT_EQ(run("advise").code, 2);
    EXPECT_EQ(run("advise --best 0 " + at("nowhere")).code, 2);
}

}  // namespace
}  // namespace skincal
