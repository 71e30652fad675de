#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <vtkPLYReader.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/formats/body_json.h"
#include "core/formats/image_header.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

struct Outcome {
    int code = -1;
    std::string output;  ///< standard output and error together
};

Outcome run(const std::string& arguments) {
    Outcome outcome;
    FILE* pipe = ::popen((std::string(SKINCAL_PROGRAM) + " " + arguments + " 2>&1").c_str(), "r");
    std::array<char, 4096> buffer{};
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
        outcome.output.append(buffer.data(), n);
    const int status = ::pclose(pipe);
    outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return outcome;
}

using testing::HasSubstr;

class CommandLineTest : public testing::Test {
  protected:
    std::string at(const std::string& name) const { return (directory_ / name).string(); }
    test::TemporaryDirectory directory_;
};

TEST_F(CommandLineTest, FromSimulationToEveryExport) {
    const Outcome simulated = run("simulate plane --seed 3 -o " + at("w.skinrec") + " --truth " + at("truth.json"));
    ASSERT_EQ(simulated.code, 0) << simulated.output;
    const Outcome calibrated = run("calibrate " + at("w.skinrec") + " -o " + at("b.body.json"));
    ASSERT_EQ(calibrated.code, 0) << calibrated.output;
    EXPECT_THAT(calibrated.output, HasSubstr("modules placed     36 of 36"));
    const auto body = readBody(at("b.body.json"));
    ASSERT_TRUE(body);
    EXPECT_EQ(body->generator.method, "sturdy");
    EXPECT_EQ(body->generator.recording_sha256.size(), 3U);

    const Outcome compared = run("compare --json " + at("b.body.json") + " " + at("truth.json"));
    ASSERT_EQ(compared.code, 0) << compared.output;
    EXPECT_LT(nlohmann::json::parse(compared.output)["position_rms"].get<double>(), 1e-3);

    for (const std::string format : {"urdf", "csv", "ply"})
        EXPECT_EQ(run("export " + at("b.body.json") + " --format " + format + " -o " + at("b." + format)).code, 0);
    auto reader = vtkSmartPointer<vtkPLYReader>::New();
    reader->SetFileName(at("b.ply").c_str());
    reader->Update();
    EXPECT_EQ(reader->GetOutput()->GetNumberOfPolys(), 36);

    const Outcome rendered = run("render --width 320 --height 200 " + at("b.body.json") + " -o " + at("b.png"));
    ASSERT_EQ(rendered.code, 0) << rendered.output;
    const auto header = parseImageHeader(test::readText(at("b.png")));
    ASSERT_TRUE(header);
    EXPECT_EQ(header->width, 320);
}

TEST_F(CommandLineTest, SameSeedSameBytes) {
    for (const char* name : {"a", "b"})
        ASSERT_EQ(run("simulate flicker --seed 5 -o " + at(name)).code, 0);
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(directory_ / "a")) {
        if (!entry.is_regular_file())
            continue;
        const auto other = directory_ / "b" / std::filesystem::relative(entry.path(), directory_ / "a").string();
        EXPECT_EQ(test::readText(entry.path()), test::readText(other)) << entry.path();
        ++files;
    }
    EXPECT_GT(files, 20U);
}

TEST_F(CommandLineTest, JsonIsForScripts) {
    ASSERT_EQ(run("simulate freeform -o " + at("w")).code, 0);
    const Outcome outcome = run("calibrate --json " + at("w") + " -o " + at("b.json") + " --method paper");
    const auto json = nlohmann::json::parse(outcome.output);
    EXPECT_EQ(json["method"], "paper");
    EXPECT_EQ(json["modules_total"], 76);
}

TEST_F(CommandLineTest, DataThatDoNotSufficeGiveOneAndWhatIsMissing) {
    ASSERT_EQ(run("simulate plane -o " + at("w")).code, 0);
    // No view shows anything.
    test::writeText(at("w/detections.csv"), "view,module,x,y,sigma\n");
    const Outcome outcome = run("calibrate " + at("w") + " -o " + at("b.json"));
    EXPECT_EQ(outcome.code, 1) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("missing: patch 0"));
    EXPECT_EQ(run("export " + at("b.json") + " --format csv -o " + at("b.csv")).code, 1);
}

TEST_F(CommandLineTest, BadInputGivesTwoOneLineAndNoFile) {
    ASSERT_EQ(run("simulate plane -o " + at("w")).code, 0);
    test::writeText(at("w/gravity.csv"), "pose,module,ax,ay,az\n0,1,x,0,0\n");
    const Outcome outcome = run("calibrate " + at("w") + " -o " + at("b.json"));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.output, HasSubstr("gravity.csv: row 2"));
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1);
    EXPECT_FALSE(std::filesystem::exists(at("b.json")));
    EXPECT_EQ(run("calibrate " + at("none")).code, 2);
    EXPECT_EQ(run("compare " + at("none") + " " + at("none")).code, 2);
    EXPECT_EQ(run("render " + at("none") + " -o " + at("x.png")).code, 2);
    EXPECT_EQ(run("simulate nonsense -o " + at("x")).code, 2);
    EXPECT_EQ(run("simulate plane -o " + at("w")).code, 2) << "does not overwrite unasked";
}

TEST_F(CommandLineTest, UsageErrorsGiveTwoAndHelpGivesZero) {
    EXPECT_EQ(run("").code, 2);
    EXPECT_EQ(run("fly").code, 2);
    EXPECT_EQ(run("calibrate").code, 2);
    EXPECT_EQ(run("calibrate x --method magic").code, 2);
    EXPECT_EQ(run("--version").code, 0);
    for (const char* command :
         {"", "calibrate", "simulate", "compare", "render", "export", "reproduce-paper", "demo"}) {
        const Outcome help = run(std::string(command) + " --help");
        EXPECT_EQ(help.code, 0) << command;
        EXPECT_GT(help.output.size(), 200U) << command;
    }
    EXPECT_THAT(run("simulate --list").output, HasSubstr("shoe-sole"));
}

}  // namespace
}  // namespace skincal
