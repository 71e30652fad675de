#include <fmt/format.h>

#include <filesystem>

#include "app/command_line.h"
#include "app/outcome.h"
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
    bool json = false;
};

int runExport(const ExportArguments& arguments) {
    const auto body = readBody(arguments.body);
    if (!body)
        return badInput(body.error().message());
    if (body->quality.modulesPlaced == 0)
        return dataDoNotSuffice(
            fmt::format("{} holds no placed module, there is nothing to export", printable(arguments.body.string())));
    if (const auto complaint = complaintAboutOutput(arguments.output, {arguments.body}))
        return badInput(*complaint);
    if (body->quality.trust == Trust::NotToBeTrusted)
        fmt::print(stderr, "warning: the verdict on this body is \"{}\"\n", name(body->quality.trust));
    std::string bytes;
    if (arguments.format == "urdf")
        bytes = exportUrdf(*body);
    else if (arguments.format == "csv")
        bytes = exportCsv(*body);
    else
        bytes = exportPly(*body);
    if (const auto written = writeFileAtomically(arguments.output, bytes); !written)
        return badInput(written.error().message());
    if (arguments.json) {
        nlohmann::ordered_json json;
        json["output"] = arguments.output.string();
        json["format"] = arguments.format;
        json["modules_placed"] = body->quality.modulesPlaced;
        json["modules_total"] = body->quality.modulesTotal;
        json["body_frame"] = body->body_frame;
        printJson(json);
        return kDone;
    }
    fmt::print("{}: {} of {} modules, metres, frame \"{}\"\n", printable(arguments.output.string()),
               body->quality.modulesPlaced, body->quality.modulesTotal, printable(body->body_frame));
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
    command->add_flag("--json", arguments->json, "Print what was written as JSON");
    command->callback([&line, arguments] { line.run = [arguments] { return runExport(*arguments); }; });
}

}  // namespace skincal
