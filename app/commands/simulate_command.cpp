#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "app/command_line.h"
#include "app/outcome.h"
#include "core/formats/files.h"
#include "core/formats/stl_file.h"
#include "core/formats/truth_json.h"
#include "core/simulation/body_surface.h"
#include "core/workflow/simulated_recording.h"

namespace skincal {
namespace {

struct SimulateArguments {
    std::string scenario;
    std::filesystem::path output;
    std::filesystem::path truth;
    std::filesystem::path mesh;
    std::uint64_t seed = 1;
    bool list = false;
    bool force = false;
    bool json = false;
};

int listScenarios(bool asJson) {
    if (asJson) {
        auto json = nlohmann::ordered_json::array();
        for (const Scenario& scenario : builtInScenarios())
            json.push_back({{"name", scenario.name}, {"description", scenario.description}});
        printJson(json);
        return kDone;
    }
    for (const Scenario& scenario : builtInScenarios())
        fmt::print("{:<16} {}\n", scenario.name, scenario.description);
    return kDone;
}

/// Asked before anything is drawn. The truth may go into the recording's directory, which need not be there yet.
std::optional<std::string> complaintAboutTruth(const SimulateArguments& arguments, const Recording& recording) {
    if (arguments.truth.empty())
        return std::nullopt;
    std::error_code error;
    const auto paths = pathsOf(arguments.output, recording);
    for (const std::filesystem::path& path : paths) {
        if (sameFile(path, arguments.truth))
            return FileError{arguments.truth, "", "expected another file for the truth, the recording has this one"}
                .message();
    }
    const auto directory = (std::filesystem::weakly_canonical(arguments.output, error) / "").parent_path();
    if (!std::filesystem::exists(directory, error) &&
        std::filesystem::weakly_canonical(arguments.truth, error).parent_path() == directory)
        return std::nullopt;
    return complaintAboutOutput(arguments.truth);
}

int runSimulate(const SimulateArguments& arguments) {
    if (arguments.list)
        return listScenarios(arguments.json);
    const Scenario* scenario = findScenario(arguments.scenario);
    if (scenario == nullptr)
        return badInput(
            fmt::format("there is no scenario '{}'; skincal simulate --list names them", arguments.scenario));
    if (arguments.output.empty())
        return badInput("expected -o RECORDING, the directory to write");
    const World world = buildWorld(*scenario, arguments.seed);
    Recording planned = recordingOf(world);
    planned.gravityFile = "gravity.csv";
    planned.detectionsFile = "detections.csv";
    if (const auto complaint = complaintAboutTruth(arguments, planned))
        return badInput(*complaint);
    if (!arguments.mesh.empty()) {
        if (const auto complaint = complaintAboutOutput(arguments.mesh))
            return badInput(*complaint);
        if (!arguments.truth.empty() && sameFile(arguments.mesh, arguments.truth))
            return badInput("expected different files for the truth and the mesh");
    }
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
    if (!arguments.mesh.empty()) {
        // Drawings are in millimetres.
        const std::string bytes = stlBytes(scaled(bodySurface(world), 1e3));
        if (const auto written = writeFileAtomically(arguments.mesh, bytes); !written)
            return badInput(written.error().message());
    }
    if (arguments.json) {
        nlohmann::ordered_json json;
        json["output"] = arguments.output.string();
        json["truth"] = nullptr;
        if (!arguments.truth.empty())
            json["truth"] = arguments.truth.string();
        json["mesh"] = nullptr;
        if (!arguments.mesh.empty())
            json["mesh"] = arguments.mesh.string();
        json["scenario"] = scenario->name;
        json["seed"] = arguments.seed;
        json["modules"] = world.T_r_u.size();
        json["patches"] = scenario->patches.size();
        json["views"] = world.T_r_v.size();
        printJson(json);
        return kDone;
    }
    fmt::print("{}: {} modules in {} patches, {} views, seed {}\n", printable(arguments.output.string()),
               world.T_r_u.size(), scenario->patches.size(), world.T_r_v.size(), arguments.seed);
    return kDone;
}

}  // namespace

void addSimulateCommand(CommandLine& line) {
    auto arguments = std::make_shared<SimulateArguments>();
    CLI::App* command =
        line.app.add_subcommand("simulate", "Record a simulated skin, and with --truth what is true of it");
    command->add_option("SCENARIO", arguments->scenario, "One of --list");
    command->add_option("-o,--output", arguments->output, "The *.skinrec directory to write");
    command->add_option("--truth", arguments->truth, "Also write what is true, for skincal compare");
    command->add_option("--mesh", arguments->mesh,
                        "Also write the true surface of the body (STL, millimetres), for the window's comparison");
    addSeedOption(*command, arguments->seed, "Same seed, same bytes");
    command->add_flag("--list", arguments->list, "Name the scenarios");
    command->add_flag("--force", arguments->force, "Overwrite a recording that is there");
    command->add_flag("--json", arguments->json, "Print what was written, or the list, as JSON");
    command->callback([&line, arguments] { line.run = [arguments] { return runSimulate(*arguments); }; });
}

}  // namespace skincal
