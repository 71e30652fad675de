#include <fmt/format.h>

#include <filesystem>

#include "app/command_line.h"
#include "app/headless_display.h"
#include "app/outcome.h"
#include "app/quality_table.h"
#include "core/estimation/compare.h"
#include "core/formats/body_json.h"
#include "core/formats/files.h"
#include "core/workflow/simulated_recording.h"
#include "ui/scene3d/picture.h"

namespace skincal {
namespace {

struct DemoArguments {
    std::filesystem::path output = "out";
    std::uint64_t seed = 1;
    bool json = false;
};

constexpr const char* kBodyFile = "demo.body.json";
constexpr const char* kPictureFile = "demo.png";

/// Makes the directory and asks whether both results can be written there.
std::optional<std::string> complaintAboutDirectory(const DemoArguments& arguments) {
    std::error_code error;
    std::filesystem::create_directories(arguments.output, error);
    if (error)
        return FileError{arguments.output, "", "can't make the directory: " + error.message()}.message();
    for (const char* name : {kBodyFile, kPictureFile}) {
        if (auto complaint = complaintAboutOutput(arguments.output / name))
            return complaint;
    }
    return std::nullopt;
}

tl::expected<BodyComparison, CalibrationError> differenceFromTruth(const BodyModel& body, const World& world) {
    std::vector<NamedPose> found;
    for (const BodyModule& module : body.modules) {
        if (module.T_body_module)
            found.push_back({module.id, *module.T_body_module});
    }
    std::vector<NamedPose> real;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
        real.push_back({world.skin.modules[u].id, world.T_r_u[u]});
    return compareBodies(found, real);
}

void printResult(const DemoArguments& arguments, const BodyModel& body,
                 const tl::expected<BodyComparison, CalibrationError>& difference) {
    if (arguments.json) {
        auto json = qualityJson(body);
        if (difference) {
            json["truth"]["position_rms"] = difference->positionRms;
            json["truth"]["rotation_rms"] = difference->rotationRms;
        }
        json["output"] = (arguments.output / kBodyFile).string();
        json["picture"] = (arguments.output / kPictureFile).string();
        printJson(json);
        return;
    }
    std::vector<TableRow> rows;
    if (difference)
        rows.emplace_back("against the truth", fmt::format("{:.2f} mm and {:.2f}° rms", difference->positionRms * 1e3,
                                                           difference->rotationRms / kDegree));
    rows.emplace_back("body model", (arguments.output / kBodyFile).string());
    rows.emplace_back("picture", (arguments.output / kPictureFile).string());
    fmt::print("{}", qualityTable(body, rows));
}

int runDemo(const DemoArguments& arguments) {
    if (const auto complaint = complaintAboutDirectory(arguments))
        return badInput(*complaint);
    const HeadlessDisplay display;
    if (!display.complaint().empty())
        return badInput(display.complaint());
    const World world = buildWorld(*findScenario("demo"), arguments.seed);
    const Recording recording = recordingOf(world);
    if (!arguments.json)
        fmt::print("A simulated arm: {} modules in {} patches, {} views of {} frames, lit in coded patterns.\n\n",
                   world.T_r_u.size(), world.scenario.patches.size(), recording.views.size(),
                   recording.views.front().frames.size());
    std::fflush(stdout);  // calibrating takes a while
    tl::expected<BodyModel, CalibrateError> body;
    {
        TerminalProgress progress;
        body = calibrate(recording, framesOf(world, recording), {}, progress.context());
    }
    if (!body)
        return reportFailure(body.error());
    if (const auto written = writeBody(*body, arguments.output / kBodyFile); !written)
        return badInput(written.error().message());
    const auto png = drawPicture(*body);
    if (!png)
        return badInput(png.error());
    if (const auto written = writeFileAtomically(arguments.output / kPictureFile, *png); !written)
        return badInput(written.error().message());
    printResult(arguments, *body, differenceFromTruth(*body, world));
    return exitCodeOf(*body);
}

}  // namespace

void addDemoCommand(CommandLine& line) {
    auto arguments = std::make_shared<DemoArguments>();
    CLI::App* command =
        line.app.add_subcommand("demo", "Simulate an arm, scan and calibrate it, write body model and picture");
    command->add_option("-o,--output", arguments->output, "Directory for the results")->capture_default_str();
    addSeedOption(*command, arguments->seed, "Another seed, another world");
    command->add_flag("--json", arguments->json, "Print the figures as JSON");
    command->callback([&line, arguments] { line.run = [arguments] { return runDemo(*arguments); }; });
}

}  // namespace skincal
