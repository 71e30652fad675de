#include <fmt/format.h>

#include <filesystem>

#include "app/command_line.h"
#include "app/headless_display.h"
#include "app/outcome.h"
#include "core/formats/body_json.h"
#include "core/formats/files.h"
#include "ui/scene3d/picture.h"

namespace skincal {
namespace {

struct RenderArguments {
    std::filesystem::path body;
    std::filesystem::path output;
    PictureOptions picture;
    bool json = false;
};

int runRender(const RenderArguments& arguments) {
    const auto body = readBody(arguments.body);
    if (!body)
        return badInput(body.error().message());
    if (body->quality.modulesPlaced == 0)
        return dataDoNotSuffice(
            fmt::format("{} holds no placed module, there is nothing to draw", printable(arguments.body.string())));
    if (const auto complaint = complaintAboutOutput(arguments.output, {arguments.body}))
        return badInput(*complaint);
    const HeadlessDisplay display;
    if (!display.complaint().empty())
        return badInput(display.complaint());
    const auto png = drawPicture(*body, arguments.picture);
    if (!png)
        return badInput(png.error());
    if (const auto written = writeFileAtomically(arguments.output, *png); !written)
        return badInput(written.error().message());
    if (arguments.json) {
        nlohmann::ordered_json json;
        json["output"] = arguments.output.string();
        json["width"] = arguments.picture.width;
        json["height"] = arguments.picture.height;
        json["modules_placed"] = body->quality.modulesPlaced;
        json["modules_total"] = body->quality.modulesTotal;
        printJson(json);
    } else {
        fmt::print("{}\n", printable(arguments.output.string()));
    }
    return kDone;
}

}  // namespace

void addRenderCommand(CommandLine& line) {
    auto arguments = std::make_shared<RenderArguments>();
    CLI::App* command = line.app.add_subcommand("render", "Draw a picture of a body model");
    command->add_option("BODY", arguments->body, "A *.body.json file")->required();
    command->add_option("-o,--output", arguments->output, "The PNG file to write")->required();
    command->add_option("--width", arguments->picture.width, "Pixels")
        ->check(CLI::Range(64, 8192))
        ->capture_default_str();
    command->add_option("--height", arguments->picture.height, "Pixels")
        ->check(CLI::Range(64, 8192))
        ->capture_default_str();
    command->add_flag("--dark", arguments->picture.dark, "Dark background");
    command->add_flag("--json", arguments->json, "Print what was written as JSON");
    command->callback([&line, arguments] { line.run = [arguments] { return runRender(*arguments); }; });
}

}  // namespace skincal
