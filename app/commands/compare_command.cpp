#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "core/estimation/compare.h"
#include "core/formats/body_json.h"
#include "core/formats/truth_json.h"

namespace skincal {
namespace {

struct CompareArguments {
    std::filesystem::path body;
    std::filesystem::path truth;
    bool json = false;
};

int runCompare(const CompareArguments& arguments) {
    const auto body = readBody(arguments.body);
    if (!body)
        return badInput(body.error().message());
    const auto truth = readTruth(arguments.truth);
    if (!truth)
        return badInput(truth.error().message());
    std::vector<NamedPose> found;
    for (const BodyModule& module : body->modules) {
        if (module.T_body_module)
            found.push_back({module.id, *module.T_body_module});
    }
    std::vector<NamedPose> real;
    for (const TrueModule& module : truth->modules)
        real.push_back({module.id, module.T_body_module});
    const auto difference = compareBodies(found, real);
    if (!difference)
        return dataDoNotSuffice("nothing to compare: the body and the truth share no placed module");
    const std::size_t strangers = found.size() - difference->compared;
    if (strangers > 0)
        fmt::print(stderr, "warning: {} of the {} placed modules are not in this truth: is it that of another skin?\n",
                   strangers, found.size());
    if (arguments.json) {
        nlohmann::ordered_json json;
        json["modules"] = real.size();
        json["placed"] = difference->compared;
        json["position_rms"] = difference->positionRms;
        json["position_max"] = difference->positionMax;
        json["rotation_rms"] = difference->rotationRms;
        json["rotation_max"] = difference->rotationMax;
        json["worst_module"] = difference->worst.value;
        printJson(json);
    } else {
        fmt::print("modules placed   {} of {}\n", difference->compared, real.size());
        fmt::print("position         {:.3f} mm rms, {:.3f} mm max (module {})\n", difference->positionRms * 1e3,
                   difference->positionMax * 1e3, difference->worst.value);
        fmt::print("rotation         {:.3f}° rms, {:.3f}° max\n", difference->rotationRms / kDegree,
                   difference->rotationMax / kDegree);
    }
    return kDone;
}

}  // namespace

void addCompareCommand(CommandLine& line) {
    auto arguments = std::make_shared<CompareArguments>();
    CLI::App* command =
        line.app.add_subcommand("compare", "Compare a body model with the truth, after rigid alignment without scale");
    command->add_option("BODY", arguments->body, "A *.body.json file")->required();
    command->add_option("TRUTH", arguments->truth, "What simulate --truth wrote, or the truth.json beside a recording")
        ->required();
    command->add_flag("--json", arguments->json, "Print as JSON (metres and radians)");
    command->callback([&line, arguments] { line.run = [arguments] { return runCompare(*arguments); }; });
}

}  // namespace skincal
