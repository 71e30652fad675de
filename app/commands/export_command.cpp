#include <fmt/format.h>

#include <filesystem>

#include "app/command_line.h"
#include "core/formats/body_json.h"
#include "core/formats/export_csv.h"
#include "core/formats/export_ply.h"
#include "core/formats/export_urdf.h"
#include "core/formats/files.h"

namespace skincal {
namespace {

struct ExportArguments {
    std::filesystem::path body;
    std::filesystem::path output;
    std::string format;
};

int runExport(const ExportArguments& arguments) {
    const auto body = readBody(arguments.body);
    if (!body)
        return badInput(body.error().message());
    if (body->quality.modulesPlaced == 0) {
        fmt::print(stderr, "skincal: {} holds no placed module, there is nothing to export\n", arguments.body.string());
        return kDataDoNotSuffice;
    }
    std::string bytes;
    if (arguments.format == "urdf")
        bytes = exportUrdf(*body);
    else if (arguments.format == "csv")
        bytes = exportCsv(*body);
    else
        bytes = exportPly(*body);
    if (const auto written = writeFileAtomically(arguments.output, bytes); !written)
        return badInput(written.error().message());
    fmt::print("{}: {} of {} modules, metres, frame \"{}\"\n", arguments.output.string(), body->quality.modulesPlaced,
               body->quality.modulesTotal, body->body_frame);
    return kDone;
}

}  // namespace

void addExportCommand(CommandLine& line) {
    auto arguments = std::make_shared<ExportArguments>();
    CLI::App* command = line.app.add_subcommand("export", "Write a body model for other programs");
    command->add_option("BODY", arguments->body, "A *.body.json file")->required();
    command
        ->add_option("--format", arguments->format,
                     "urdf: a fixed link per patch and module; csv: one row per module; ply: a mesh of the boards")
        ->check(CLI::IsMember({"urdf", "csv", "ply"}))
        ->required();
    command->add_option("-o,--output", arguments->output, "The file to write")->required();
    command->callback([&line, arguments] { line.run = [arguments] { return runExport(*arguments); }; });
}

}  // namespace skincal
