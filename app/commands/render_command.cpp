#include <fmt/format.h>

#include <filesystem>

#include "app/command_line.h"
#include "app/headless_display.h"
#include "core/formats/body_json.h"
#include "core/formats/files.h"
#include "ui/scene3d/picture.h"

namespace skincal {
namespace {

struct RenderArguments {
    std::filesystem::path body;
    std::filesystem::path output;
    PictureOptions picture;
};

int runRender(const RenderArguments& arguments) {
    const auto body = readBody(arguments.body);
    if (!body)
        return badInput(body.error().message());
    const HeadlessDisplay display;
    const auto png = drawPicture(*body, arguments.picture);
    if (!png)
        return badInput(png.error());
    if (const auto written = writeFileAtomically(arguments.output, *png); !written)
        return badInput(written.error().message());
    fmt::print("{}\n", arguments.output.string());
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
    command->callback([&line, arguments] { line.run = [arguments] { return runRender(*arguments); }; });
}

}  // namespace skincal
