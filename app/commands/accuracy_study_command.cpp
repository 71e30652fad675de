#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "core/study/accuracy_study.h"

namespace skincal {
namespace {

using Json = nlohmann::ordered_json;

struct AccuracyArguments {
    AccuracyStudyOptions study;
    bool json = false;
};

template <class T>
Json orNull(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

Json toJson(const std::optional<PoseAccuracy>& accuracy) {
    if (!accuracy)
        return {};
    return {{"position_rms", accuracy->positionRms}, {"rotation_rms", accuracy->rotationRms}};
}

Json toJson(const std::optional<Consistency>& c) {
    if (!c)
        return {};
    return {{"modules", c->modules},
            {"mean_nees", c->meanNees},
            {"drawn_nees", c->drawnNees},
            {"largest_sigmas", c->largestSigmas},
            {"beyond_five_sigma", c->beyondFive}};
}

Json toJson(const std::optional<NeesTest>& test) {
    if (!test)
        return {};
    return {{"worlds", test->worlds},
            {"expected", 6},
            {"mean", test->mean},
            {"interval_95", Json::array({test->low, test->high})},
            {"passes", test->passes()}};
}

Json toJson(const WorldAccuracy& world) {
    Json json;
    json["seed"] = world.seed;
    json["world"] = world.world;
    json["failure"] = world.failure.empty() ? Json() : Json(world.failure);
    json["modules"] = world.modules;
    json["placed"] = world.placed;
    json["placeable"] = world.placeable;
    json["missed"] = world.missed;
    json["verdict"] = world.verdict ? Json(name(*world.verdict)) : Json();
    json["from_data"] = toJson(world.fromData);
    json["from_truth"] = toJson(world.fromTruth);
    json["ratio"] = orNull(world.ratio);
    json["consistency"] = toJson(world.consistency);
    json["consistency_from_truth"] = toJson(world.consistencyFromTruth);
    json["seconds"] = world.seconds;
    return json;
}

Json toJson(const AccuracySummary& summary) {
    Json json;
    json["modules"] = summary.modules;
    json["missed"] = summary.missed;
    json["beyond_five_sigma"] = summary.beyondFive;
    json["worlds_without_ratio"] = summary.withoutResult;
    json["ratio_geometric_mean"] = orNull(summary.geometricMean);
    json["ratio_worst"] = orNull(summary.worst);
    json["worst_seed"] = summary.worst ? Json(summary.worstSeed) : Json();
    json["nees"] = toJson(summary.nees);
    json["nees_from_truth"] = toJson(summary.neesFromTruth);
    return json;
}

Json toJson(const AccuracyStudy& study) {
    Json json;
    json["first_seed"] = study.options.firstSeed;
    json["summary"] = toJson(summarise(study.worlds));
    json["worlds"] = Json::array();
    for (const WorldAccuracy& world : study.worlds)
        json["worlds"].push_back(toJson(world));
    return json;
}

int runAccuracy(const AccuracyArguments& arguments) {
    AccuracyStudy study;
    {
        TerminalProgress progress;
        study = runAccuracyStudy(arguments.study, progress.context());
    }
    if (study.cancelled)
        return badInput("interrupted");
    if (arguments.json)
        printJson(toJson(study));
    else
        fmt::print("{}", accuracyTable(study));
    return kDone;
}

}  // namespace

void addAccuracyStudyCommand(CommandLine& line) {
    auto arguments = std::make_shared<AccuracyArguments>();
    CLI::App* command = line.app.add_subcommand(
        "accuracy-study",
        "Calibrate random worlds with the joint method, next to the same estimate started at the truth, and test its "
        "covariances");
    command->add_option("--worlds", arguments->study.worlds, "Simulated worlds")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    addSeedOption(*command, arguments->study.firstSeed, "Seed of the first world; the next ones count on",
                  "--first-seed");
    command->add_flag("--json", arguments->json, "Print as JSON (metres and radians)");
    command->callback([&line, arguments] { line.run = [arguments] { return runAccuracy(*arguments); }; });
}

}  // namespace skincal
