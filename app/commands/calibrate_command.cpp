#include <fmt/format.h>

#include <filesystem>

#include "app/command_line.h"
#include "app/quality_table.h"
#include "core/formats/body_json.h"
#include "core/workflow/calibrate.h"

namespace skincal {
namespace {

struct CalibrateArguments {
    std::filesystem::path recording;
    std::filesystem::path output;
    std::string method{name(Method::Sturdy)};
    bool json = false;
};

std::filesystem::path defaultOutput(const std::filesystem::path& recording) {
    auto name = recording.filename().empty() ? recording.parent_path().filename() : recording.filename();
    return name.replace_extension(".body.json");
}

int runCalibrate(const CalibrateArguments& arguments) {
    const auto recording = readRecording(arguments.recording);
    if (!recording)
        return badInput(recording.error().message());
    CalibrateOptions options;
    options.method = *methodFromName(arguments.method);
    tl::expected<BodyModel, CalibrateError> body;
    {
        TerminalProgress progress;
        body = calibrate(*recording, framesOf(arguments.recording, *recording), options, progress.context());
    }
    if (!body && body.error().cancelled)
        return badInput("interrupted, nothing was written");
    if (!body && body.error().badInput)
        return badInput(body.error().message);
    if (!body) {
        fmt::print(stderr, "skincal: the data do not suffice: {}\n", body.error().message);
        return kDataDoNotSuffice;
    }
    auto digests = digestRecording(arguments.recording, *recording);
    if (!digests)
        return badInput(digests.error().message());
    body->generator.recording_sha256 = std::move(*digests);
    const auto output = arguments.output.empty() ? defaultOutput(arguments.recording) : arguments.output;
    if (const auto written = writeBody(*body, output); !written)
        return badInput(written.error().message());

    if (arguments.json) {
        auto json = qualityJson(*body);
        json["output"] = output.string();
        fmt::print("{}\n", json.dump(2));
    } else {
        fmt::print("{}\nbody model         {}\n", qualityTable(*body), output.string());
    }
    return body->quality.modulesPlaced < body->quality.modulesTotal ? kDataDoNotSuffice : kDone;
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
                     "sturdy: planar-safe poses, loops closed, outliers rejected; paper: the method of the IROS 2014 "
                     "paper to the letter, as a baseline")
        ->check(CLI::IsMember({"sturdy", "paper"}))
        ->capture_default_str();
    command->add_flag("--json", arguments->json, "Print the quality figures as JSON");
    command->footer(
        "A body model is written even where modules could not be placed; they have no pose in it, the exit\n"
        "code is 1, and what is missing is printed.");
    command->callback([&line, arguments] { line.run = [arguments] { return runCalibrate(*arguments); }; });
}

}  // namespace skincal
