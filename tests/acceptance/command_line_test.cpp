#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>
#include <vtkPLYReader.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/formats/body_json.h"
#include "core/formats/image_header.h"
#include "core/formats/stl_file.h"
#include "tests/acceptance/program.h"
#include "tests/unit/formats/temporary_directory.h"

namespace skincal {
namespace {

using test::Outcome;
using test::run;
using testing::HasSubstr;

class CommandLineTest : public testing::Test {
  protected:
    std::string at(const std::string& name) const { return (directory_ / name).string(); }

    /// Two modules, no view, and nothing that could be placed.
    void writeSmallRecording(const std::string& name, const std::string& modules) const {
        test::writeText(directory_ / (name + "/gravity.csv"), "pose,module,ax,ay,az\n");
        test::writeText(directory_ / (name + "/recording.json"),
                        R"({"format": "skincal-recording", "version": 1, "module_types": [{"name": "hex",
                        "outline": [[0.01, 0], [0, 0.01], [-0.01, 0]], "led": [0, 0, 0], "ports": []}],
                        "modules": )" +
                            modules +
                            R"(, "links": [], "gravity": "gravity.csv", "camera": {"model": "pinhole", "width": 64,
                        "height": 48, "fx": 60, "fy": 60, "cx": 32, "cy": 24, "distortion_model": "plumb_bob",
                        "distortion": [0, 0, 0, 0, 0]}, "views": []})");
    }

    test::TemporaryDirectory directory_;
};

TEST_F(CommandLineTest, SaysWhichOfSeveralSpotsWasTaken) {
    const Outcome simulated = run("simulate mirror -o " + at("w.skinrec") + " --truth " + at("truth.json"));
    ASSERT_EQ(simulated.code, 0) << simulated.error;
    const Outcome calibrated = run("calibrate --json " + at("w.skinrec") + " -o " + at("b.body.json"));
    ASSERT_EQ(calibrated.code, 0) << calibrated.error;
    const auto body = readBody(at("b.body.json"));
    ASSERT_TRUE(body);
    std::size_t taken = 0;
    for (const BodyView& view : body->views) {
        for (const BodyObservation& o : view.observations) {
            if (o.verdict != ObservationVerdict::Used || o.reason.empty())
                continue;
            EXPECT_THAT(o.reason, HasSubstr("lies where the body has it"));
            ++taken;
        }
    }
    EXPECT_GT(taken, 10U);
    EXPECT_EQ(body->quality.condition.at("spots taken"), static_cast<double>(taken));
    const Outcome compared = run("compare --json " + at("b.body.json") + " " + at("truth.json"));
    ASSERT_EQ(compared.code, 0) << compared.error;
    EXPECT_LT(nlohmann::json::parse(compared.output)["position_rms"].get<double>(), 1e-3);
}

TEST_F(CommandLineTest, FromSimulationToEveryExport) {
    const Outcome simulated = run("simulate plane --seed 3 -o " + at("w.skinrec") + " --truth " + at("truth.json"));
    ASSERT_EQ(simulated.code, 0) << simulated.error;
    const Outcome calibrated = run("calibrate " + at("w.skinrec") + " -o " + at("b.body.json"));
    ASSERT_EQ(calibrated.code, 0) << calibrated.error;
    EXPECT_THAT(calibrated.output, HasSubstr("modules placed     36 of 36"));
    const auto body = readBody(at("b.body.json"));
    ASSERT_TRUE(body);
    EXPECT_EQ(body->generator.method, "joint");
    EXPECT_EQ(body->generator.recording_sha256.size(), 3U);

    const Outcome compared = run("compare --json " + at("b.body.json") + " " + at("truth.json"));
    ASSERT_EQ(compared.code, 0) << compared.error;
    EXPECT_LT(nlohmann::json::parse(compared.output)["position_rms"].get<double>(), 1e-3);

    for (const std::string format : {"urdf", "csv", "ply"})
        EXPECT_EQ(run("export " + at("b.body.json") + " --format " + format + " -o " + at("b." + format)).code, 0);
    auto reader = vtkSmartPointer<vtkPLYReader>::New();
    reader->SetFileName(at("b.ply").c_str());
    reader->Update();
    EXPECT_EQ(reader->GetOutput()->GetNumberOfPolys(), 36);

    const Outcome rendered = run("render --width 320 --height 200 " + at("b.body.json") + " -o " + at("b.png"));
    ASSERT_EQ(rendered.code, 0) << rendered.error;
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

TEST_F(CommandLineTest, EveryCommandThatSaysJsonPrintsNothingElse) {
    const auto json = [&](const std::string& arguments, int code = 0) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, code) << arguments << outcome.error;
        auto parsed = nlohmann::json::parse(outcome.output, nullptr, false);
        EXPECT_FALSE(parsed.is_discarded()) << arguments << outcome.output;
        return parsed;
    };
    EXPECT_GT(json("simulate --list --json").size(), 5U);
    EXPECT_EQ(json("simulate plane --json -o " + at("w") + " --truth " + at("w/truth.json"))["modules"], 36);
    EXPECT_EQ(json("simulate arm --json -o " + at("a") + " --mesh " + at("arm.stl"))["mesh"], at("arm.stl"));
    const auto mesh = readStl(directory_ / "arm.stl");
    ASSERT_TRUE(mesh) << mesh.error().message();
    EXPECT_GT(enclosedVolume(*mesh).value_or(0), 1e6) << "mm^3";
    // A path that is no UTF-8.
    const auto result = json("calibrate --json " + at("w") + " -o " + at("$(printf 'b\\377').json"));
    EXPECT_THAT(result["output"].get<std::string>(), HasSubstr("b\uFFFD.json"));
    ASSERT_EQ(run("calibrate " + at("w") + " -o " + at("b.json")).code, 0);
    EXPECT_EQ(json("compare --json " + at("b.json") + " " + at("w/truth.json"))["placed"], 36);
    EXPECT_EQ(json("export --json " + at("b.json") + " --format csv -o " + at("b.csv"))["modules_placed"], 36);
    EXPECT_EQ(json("render --json " + at("b.json") + " --width 64 --height 64 -o " + at("b.png"))["width"], 64);
}

TEST_F(CommandLineTest, DataThatDoNotSufficeGiveOneAndWhatIsMissing) {
    ASSERT_EQ(run("simulate plane -o " + at("w")).code, 0);
    // No view shows anything.
    test::writeText(at("w/detections.csv"), "view,module,x,y,sigma\n");
    const Outcome outcome = run("calibrate " + at("w") + " -o " + at("b.json"));
    EXPECT_EQ(outcome.code, 1) << outcome.output;
    EXPECT_THAT(outcome.output, HasSubstr("missing: patch 0"));
    EXPECT_EQ(run("export " + at("b.json") + " --format csv -o " + at("b.csv")).code, 1);
    EXPECT_EQ(run("render " + at("b.json") + " -o " + at("b.png")).code, 1);
    EXPECT_FALSE(std::filesystem::exists(at("b.png")));
}

TEST_F(CommandLineTest, NoModulesAreNotEnough) {
    for (const auto& [name, modules] : {std::pair("none", "[]"), {"two", R"([{"id": 1, "type": "hex"}])"}}) {
        writeSmallRecording(name, modules);
        for (const char* method : {"paper", "sturdy", "joint"}) {
            const Outcome outcome =
                run("calibrate " + at(name) + " --force -o " + at("b.json") + " --method " + method);
            EXPECT_EQ(outcome.code, 1) << name << method << outcome.output << outcome.error;
        }
    }
}

TEST_F(CommandLineTest, ABodyModelIsReplacedOnlyWhereAskedFor) {
    ASSERT_EQ(run("simulate plane -o " + at("w.skinrec")).code, 0);
    ASSERT_EQ(run("calibrate --method paper " + at("w.skinrec") + " -o " + at("b.json")).code, 0);
    const std::string before = test::readText(at("b.json"));
    const Outcome again = run("calibrate --method sturdy " + at("w.skinrec") + " -o " + at("b.json"));
    EXPECT_EQ(again.code, 2);
    EXPECT_THAT(again.error, testing::AllOf(HasSubstr("b.json"), HasSubstr("--force")));
    EXPECT_EQ(std::count(again.error.begin(), again.error.end(), '\n'), 1);
    EXPECT_EQ(test::readText(at("b.json")), before);
    EXPECT_EQ(run("calibrate --force --method sturdy " + at("w.skinrec") + " -o " + at("b.json")).code, 0);
    EXPECT_NE(test::readText(at("b.json")), before);
    // What was asked for by name and is written from a body in a moment is another matter.
    for (int time = 0; time < 2; ++time)
        EXPECT_EQ(run("export " + at("b.json") + " --format csv -o " + at("b.csv")).code, 0);
}

TEST_F(CommandLineTest, OutputsThatWouldDestroyOrCanNotBeWrittenAreRefusedFirst) {
    ASSERT_EQ(run("simulate plane -o " + at("w") + " --truth " + at("truth.json")).code, 0);
    const std::string before = test::readText(at("w/recording.json"));
    std::filesystem::create_symlink(at("w/gravity.csv"), at("link"));
    for (const std::string& output : {at("w/recording.json"), at("w/../w/detections.csv"), at("link")}) {
        const Outcome outcome = run("calibrate " + at("w") + " -o " + output);
        EXPECT_EQ(outcome.code, 2);
        EXPECT_THAT(outcome.error, HasSubstr("another file"));
    }
    EXPECT_EQ(test::readText(at("w/recording.json")), before);
    const Outcome null = run("calibrate " + at("w") + " -o /dev/null");
    EXPECT_EQ(null.code, 2);
    EXPECT_THAT(null.error, HasSubstr("expected a regular file"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    EXPECT_THAT(run("calibrate " + at("w") + " -o " + at("no/b.json")).error, HasSubstr("there is no directory"));
    EXPECT_EQ(run("reproduce-paper --trials 100000 --json " + at("no/b.json")).code, 2);
    EXPECT_EQ(run("simulate plane -o " + at("v") + " --truth " + at("no/t.json")).code, 2);
    EXPECT_EQ(run("simulate plane -o " + at("v") + " --mesh " + at("no/t.stl")).code, 2);
    EXPECT_EQ(run("simulate plane -o " + at("v") + " --truth " + at("v/gravity.csv")).code, 2);
    EXPECT_FALSE(std::filesystem::exists(at("v")));
    ASSERT_EQ(run("calibrate " + at("w") + " -o " + at("b.json")).code, 0);
    EXPECT_EQ(run("export " + at("b.json") + " --format csv -o " + at("b.json")).code, 2);
    EXPECT_EQ(run("render " + at("b.json") + " -o " + at("b.json")).code, 2);
    EXPECT_TRUE(readBody(at("b.json")));
}

TEST_F(CommandLineTest, TheRecordingOneStandsInHasAName) {
    ASSERT_EQ(run("simulate plane -o " + at("arm.skinrec")).code, 0);
    const std::string command = "cd " + at("arm.skinrec") + " && " + SKINCAL_PROGRAM + " calibrate . >/dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0);
    EXPECT_TRUE(readBody(at("arm.skinrec/arm.body.json")));
}

TEST_F(CommandLineTest, OnlySeedsThatAreOnes) {
    for (const char* seed : {"-1", "18446744073709551616", "1.5", "0x10", "''"}) {
        EXPECT_EQ(run(std::string("simulate plane --seed ") + seed + " -o " + at("w")).code, 2) << seed;
        EXPECT_EQ(run(std::string("demo --seed ") + seed + " -o " + at("w")).code, 2) << seed;
        EXPECT_EQ(run(std::string("accuracy-study --first-seed ") + seed).code, 2) << seed;
    }
    EXPECT_FALSE(std::filesystem::exists(at("w")));
    EXPECT_EQ(run("simulate plane --seed 18446744073709551615 -o " + at("w")).code, 0);
}

TEST_F(CommandLineTest, TheAccuracyStudyPrintsATableOrJson) {
    const Outcome table = run("accuracy-study --worlds 1 --first-seed 7");
    EXPECT_EQ(table.code, 0) << table.error;
    EXPECT_THAT(table.output, testing::AllOf(HasSubstr("| 7 | arm, 2 patches"), HasSubstr("geometric mean")));
    const Outcome outcome = run("accuracy-study --worlds 1 --first-seed 7 --json");
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    const auto json = nlohmann::json::parse(outcome.output);
    ASSERT_EQ(json.at("worlds").size(), 1U);
    const auto& world = json.at("worlds").at(0);
    EXPECT_EQ(world.at("seed"), 7);
    EXPECT_GT(world.at("from_data").at("position_rms"), 0);
    EXPECT_GT(world.at("from_truth").at("position_rms"), 0);
    EXPECT_EQ(json.at("summary").at("ratio_worst"), world.at("ratio"));
    EXPECT_EQ(json.at("summary").at("nees").at("worlds"), 1);
    EXPECT_EQ(run("accuracy-study --worlds 0").code, 2);
}

TEST_F(CommandLineTest, AFullDiskBehindStandardOutputIsAnError) {
    for (const char* arguments : {"simulate --list", "--help", "--version"}) {
        const Outcome outcome = run(std::string(arguments) + " >/dev/full");
        EXPECT_EQ(outcome.code, 2) << arguments;
        EXPECT_EQ(outcome.error, "skincal: can't write to standard output\n");
    }
}

TEST_F(CommandLineTest, DrawsWhateverDisplaySays) {
    ASSERT_EQ(run("simulate plane -o " + at("w")).code, 0);
    ASSERT_EQ(run("calibrate " + at("w") + " -o " + at("b.json")).code, 0);
    const std::string arguments = "render --width 64 --height 64 " + at("b.json") + " -o " + at("b.png");
    for (const char* environment : {"DISPLAY=", "DISPLAY=:4711", "DISPLAY=nonsense", "-u DISPLAY"}) {
        const Outcome outcome = run(arguments, environment);
        EXPECT_EQ(outcome.code, 0) << environment << outcome.error;
    }
    const Outcome outcome = run(arguments, "DISPLAY=:4711 PATH=/nowhere");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.error, HasSubstr("the X display ':4711' can't be used, and Xvfb could not be started"));
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1);
}

bool isRunning(const std::string& pid) {
    const std::string stat = test::readText("/proc/" + pid + "/stat");
    return !stat.empty() && stat.find(") Z ") == std::string::npos;
}

TEST_F(CommandLineTest, XvfbDoesNotOutliveTheProgram) {
    ASSERT_EQ(run("simulate plane -o " + at("w")).code, 0);
    ASSERT_EQ(run("calibrate " + at("w") + " -o " + at("b.json")).code, 0);
    // Stands in for Xvfb, kills whoever started it and would go on for long.
    test::writeText(at("bin/Xvfb"), "#!/bin/sh\necho $$ >" + at("pid") + "\nkill -KILL $PPID\nexec sleep 1000\n");
    std::filesystem::permissions(at("bin/Xvfb"), std::filesystem::perms::owner_all);
    run("render " + at("b.json") + " -o " + at("b.png"), "DISPLAY= PATH=" + at("bin") + ":$PATH");
    std::string pid = test::readText(at("pid"));
    ASSERT_FALSE(pid.empty());
    pid.pop_back();
    for (int i = 0; i < 200 && isRunning(pid); ++i)
        ::usleep(50'000);
    EXPECT_FALSE(isRunning(pid));
}

TEST_F(CommandLineTest, BadInputGivesTwoOneLineAndNoFile) {
    ASSERT_EQ(run("simulate plane -o " + at("w")).code, 0);
    test::writeText(at("w/gravity.csv"), "pose,module,ax,ay,az\n0,1,x,0,0\n");
    const Outcome outcome = run("calibrate " + at("w") + " -o " + at("b.json"));
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.output, "");
    EXPECT_THAT(outcome.error, HasSubstr("gravity.csv: row 2"));
    EXPECT_EQ(std::count(outcome.error.begin(), outcome.error.end(), '\n'), 1);
    EXPECT_FALSE(std::filesystem::exists(at("b.json")));
    EXPECT_EQ(run("calibrate " + at("none")).code, 2);
    EXPECT_EQ(run("compare " + at("none") + " " + at("none")).code, 2);
    EXPECT_EQ(run("render " + at("none") + " -o " + at("x.png")).code, 2);
    EXPECT_EQ(run("simulate nonsense -o " + at("x")).code, 2);
    EXPECT_EQ(run("simulate plane -o " + at("w")).code, 2) << "does not overwrite unasked";
}

TEST_F(CommandLineTest, UsageErrorsGiveTwoAndHelpGivesZero) {
    const Outcome window = run("", "-u DISPLAY -u WAYLAND_DISPLAY");
    EXPECT_EQ(window.code, 2) << "there is no display to open a window on";
    EXPECT_THAT(window.error, HasSubstr("no display"));
    EXPECT_THAT(run(directory_.path().string(), "-u DISPLAY").error, HasSubstr("no display"))
        << "a recording is one to open";
    const Outcome unknown = run("calibrat");
    EXPECT_EQ(unknown.code, 2);
    EXPECT_THAT(
        unknown.error,
        HasSubstr("'calibrat' is neither a command nor the directory of a recording; commands are demo, calibrate, "));
    EXPECT_EQ(run("calibrate").code, 2);
    EXPECT_EQ(run("calibrate x --method magic").code, 2);
    EXPECT_EQ(run("--version").code, 0);
    for (const char* command :
         {"", "calibrate", "simulate", "compare", "render", "export", "reproduce-paper", "accuracy-study", "demo"}) {
        const Outcome help = run(std::string(command) + " --help");
        EXPECT_EQ(help.code, 0) << command;
        EXPECT_GT(help.output.size(), 200U) << command;
    }
    EXPECT_THAT(run("calibrate --help").output, testing::AllOf(HasSubstr("Exit codes: 0"), HasSubstr("gravity.csv")));
    EXPECT_THAT(run("simulate --list").output, HasSubstr("shoe-sole"));
}

}  // namespace
}  // namespace skincal
