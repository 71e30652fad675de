#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "app/command_line.h"
#include "core/formats/truth_json.h"
#include "core/workflow/simulated_recording.h"

namespace skincal {
namespace {

struct SimulateArguments {
    std::string scenario;
    std::filesystem::path output;
    std::filesystem::path truth;
    std::uint64_t seed = 1;
    bool list = false;
    bool force = false;
};

int listScenarios() {
    for (const Scenario& scenario : builtInScenarios())
        fmt::print("{:<16} {}\n", scenario.name, scenario.description);
    return kDone;
}

int runSimulate(const SimulateArguments& arguments) {
    if (arguments.list)
        return listScenarios();
    const Scenario* scenario = findScenario(arguments.scenario);
    if (scenario == nullptr)
        return badInput(
            fmt::format("there is no scenario '{}'; skincal simulate --list names them", arguments.scenario));
    if (arguments.output.empty())
        return badInput("expected -o RECORDING, the directory to write");
    const World world = buildWorld(*scenario, arguments.seed);
    {
        TerminalProgress progress;
        const auto written = writeSimulation(world, arguments.output, arguments.force, progress.context());
        if (!written)
            return badInput(written.error().message());
    }
    if (!arguments.truth.empty()) {
        if (const auto written = writeTruth(truthOf(world), arguments.truth); !written)
            return badInput(written.error().message());
    }
    fmt::print("{}: {} modules in {} patches, {} views, seed {}\n", arguments.output.string(), world.T_r_u.size(),
               scenario->patches.size(), world.T_r_v.size(), arguments.seed);
    return kDone;
}

}  // namespace

void addSimulateCommand(CommandLine& line) {
    auto arguments = std::make_shared<SimulateArguments>();
    CLI::App* command = line.app.add_subcommand("simulate", "Record a simulated skin, with the truth beside it");
    command->add_option("SCENARIO", arguments->scenario, "One of --list");
    command->add_option("-o,--output", arguments->output, "The *.skinrec directory to write");
    command->add_option("--truth", arguments->truth, "Also write what is true, for skincal compare");
    command->add_option("--seed", arguments->seed, "Same seed, same bytes")->capture_default_str();
    command->add_flag("--list", arguments->list, "Name the scenarios");
    command->add_flag("--force", arguments->force, "Overwrite a recording that is there");
    command->callback([&line, arguments] { line.run = [arguments] { return runSimulate(*arguments); }; });
}

}  // namespace skincal
