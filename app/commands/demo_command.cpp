#include <fmt/format.h>

#include <filesystem>

#include "app/command_line.h"
#include "app/headless_display.h"
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
};

int runDemo(const DemoArguments& arguments) {
    const World world = buildWorld(*findScenario("demo"), arguments.seed);
    const Recording recording = recordingOf(world);
    fmt::print("A simulated arm: {} modules in {} patches, {} views of {} frames, lit in coded patterns.\n\n",
               world.T_r_u.size(), world.scenario.patches.size(), recording.views.size(),
               recording.views.front().frames.size());
    tl::expected<BodyModel, CalibrateError> body;
    {
        TerminalProgress progress;
        body = calibrate(recording, framesOf(world, recording), {}, progress.context());
    }
    if (!body)
        return badInput(body.error().message);
    std::error_code error;
    std::filesystem::create_directories(arguments.output, error);
    const auto bodyFile = arguments.output / "demo.body.json";
    if (const auto written = writeBody(*body, bodyFile); !written)
        return badInput(written.error().message());
    fmt::print("{}", qualityTable(*body));

    std::vector<NamedPose> found;
    for (const BodyModule& module : body->modules) {
        if (module.T_body_module)
            found.push_back({module.id, *module.T_body_module});
    }
    std::vector<NamedPose> real;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
        real.push_back({world.skin.modules[u].id, world.T_r_u[u]});
    if (const auto difference = compareBodies(found, real))
        fmt::print("against the truth  {:.2f} mm and {:.2f}° rms\n", difference->positionRms * 1e3,
                   difference->rotationRms / kDegree);
    fmt::print("body model         {}\n", bodyFile.string());

    const HeadlessDisplay display;
    const auto png = drawPicture(*body);
    if (!png)
        return badInput(png.error());
    const auto picture = arguments.output / "demo.png";
    if (const auto written = writeFileAtomically(picture, *png); !written)
        return badInput(written.error().message());
    fmt::print("picture            {}\n", picture.string());
    return body->quality.modulesPlaced < body->quality.modulesTotal ? kDataDoNotSuffice : kDone;
}

}  // namespace

void addDemoCommand(CommandLine& line) {
    auto arguments = std::make_shared<DemoArguments>();
    CLI::App* command =
        line.app.add_subcommand("demo", "Simulate an arm, scan and calibrate it, write body model and picture");
    command->add_option("-o,--output", arguments->output, "Directory for the results")->capture_default_str();
    command->add_option("--seed", arguments->seed, "Another seed, another world")->capture_default_str();
    command->callback([&line, arguments] { line.run = [arguments] { return runDemo(*arguments); }; });
}

}  // namespace skincal
