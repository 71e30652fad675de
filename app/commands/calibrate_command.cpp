#include <fmt/format.h>

#include <filesystem>

#include "app/calibrate_to_file.h"
#include "app/command_line.h"
#include "app/outcome.h"
#include "app/quality_table.h"
#include "core/workflow/calibrate.h"

namespace skincal {
namespace {

struct CalibrateArguments {
    std::filesystem::path recording;
    std::filesystem::path output;
    std::string method{name(CalibrateOptions{}.method)};
    double misalignment_deg = 0;
    bool force = false;
    bool json = false;
};

std::filesystem::path defaultOutput(const std::filesystem::path& recording) {
    // "." and ".." have no name of their own.
    std::error_code error;
    const std::filesystem::path full = std::filesystem::canonical(recording, error);
    auto name = full.filename().empty() ? full.parent_path().filename() : full.filename();
    return name.empty() ? "recording.body.json" : name.replace_extension(".body.json");
}

int runCalibrate(const CalibrateArguments& arguments) {
    const auto recording = readRecording(arguments.recording);
    if (!recording)
        return badInput(recording.error().message());
    const auto output = arguments.output.empty() ? defaultOutput(arguments.recording) : arguments.output;
    if (const auto complaint = complaintAboutOutput(output, pathsOf(arguments.recording, *recording)))
        return badInput(*complaint);
    if (const auto complaint = complaintAboutExisting(output); complaint && !arguments.force)
        return badInput(*complaint);
    CalibrateOptions options;
    options.method = *methodFromName(arguments.method);
    options.joint.misalignmentSigma = arguments.misalignment_deg * kDegree;
    return calibrateToFile(arguments.recording, *recording, options, output, arguments.json);
}

}  // namespace

void addCalibrateCommand(CommandLine& line) {
    auto arguments = std::make_shared<CalibrateArguments>();
    CLI::App* command = line.app.add_subcommand("calibrate", "Compute a body model from a recording");
    command->add_option("RECORDING", arguments->recording, "A *.skinrec directory")->required();
    command->add_option("-o,--output", arguments->output,
                        "Where the body model goes; the recording's name with .body.json, here, unless given");
    command
        ->add_option("--method", arguments->method,
                     "joint: everything at once, weighed by what the residuals show,\n"
                     "  with covariances; what disagrees is taken out and named\n"
                     "sturdy: where joint starts: planar-safe poses, loops closed,\n"
                     "  outliers rejected\n"
                     "paper: the method of the IROS 2014 paper to the letter, as a baseline")
        ->check(CLI::IsMember({"joint", "sturdy", "paper"}))
        ->capture_default_str();
    command
        ->add_option(
            "--misalignment", arguments->misalignment_deg,
            "How far accelerometers sit askew on their boards, in degrees about each axis (standard deviation), "
            "where their maker says so; joint method only. It enters the uncertainties, too")
        ->check(CLI::Range(0.0, 20.0));
    command->add_flag("--force", arguments->force, "Replace a body model, or another file, that is there");
    command->add_flag("--json", arguments->json, "Print the quality figures as JSON");
    command->footer(
        "A recording is a directory with recording.json, which holds\n"
        "  the module types (outline, LED, ports) and the modules with their ids,\n"
        "  the links port to port that the network reported, and the camera's intrinsics;\n"
        "  gravity.csv: what each accelerometer read at rest, in several poses of the body;\n"
        "  and per view either pictures with the list of lit LEDs, or detections.csv with LED positions.\n"
        "docs/formats/recording.md describes it key by key, docs/formats/body-model.md the result.\n\n"
        "A body model is written even where modules could not be placed; they have no pose in it, and what is\n"
        "missing is printed.\n\n"
        "Exit codes: 0 every module is placed; 1 the data do not suffice: a module or all are not placed, or the\n"
        "verdict is \"not to be trusted\"; 2 bad input or usage, nothing is written.");
    command->callback([&line, arguments] { line.run = [arguments] { return runCalibrate(*arguments); }; });
}

}  // namespace skincal
