#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/command_line.h"
#include "app/outcome.h"
#include "core/formats/files.h"
#include "core/study/paper_experiments.h"

namespace skincal {
namespace {

struct ReproduceArguments {
    PaperStudyOptions study;
    std::filesystem::path json;
};

nlohmann::ordered_json toJson(const MethodOutcome& outcome) {
    nlohmann::ordered_json json;
    json["solved"] = outcome.solved;
    json["mean"] = outcome.mean ? nlohmann::ordered_json(*outcome.mean) : nlohmann::ordered_json();
    json["rms_error"] = outcome.rms ? nlohmann::ordered_json(*outcome.rms) : nlohmann::ordered_json();
    return json;
}

nlohmann::ordered_json toJson(const PaperStudy& study) {
    nlohmann::ordered_json json;
    json["trials"] = study.options.trials;
    json["pixel_noise_px"] = study.options.pixelNoise;
    json["experiments"] = nlohmann::ordered_json::array();
    for (const ExperimentRow& row : study.rows) {
        nlohmann::ordered_json entry;
        entry["experiment"] = row.experiment;
        entry["quantity"] = row.quantity;
        entry["unit"] = row.unit;
        entry["truth"] = row.truth;
        entry["printed"] = row.printed ? nlohmann::ordered_json(*row.printed) : nlohmann::ordered_json();
        entry["paper"] = toJson(row.paper);
        entry["ours"] = toJson(row.ours);
        entry["cramer_rao_bound"] = row.bound ? nlohmann::ordered_json(*row.bound) : nlohmann::ordered_json();
        json["experiments"].push_back(std::move(entry));
    }
    return json;
}

int runReproduce(const ReproduceArguments& arguments) {
    if (!arguments.json.empty()) {
        if (const auto complaint = complaintAboutOutput(arguments.json))
            return badInput(*complaint);
    }
    PaperStudy study;
    {
        TerminalProgress progress;
        study = runPaperStudy(arguments.study, progress.context());
    }
    if (study.cancelled)
        return badInput("interrupted");
    if (study.rows.empty())
        return badInput(fmt::format("--only: no experiment has \"{}\" in its name", arguments.study.only));
    fmt::print("Mean of the quantity (rms of its error) over {} simulated worlds, {:g} px of pixel noise.\n\n{}",
               arguments.study.trials, arguments.study.pixelNoise, studyTable(study));
    if (!arguments.json.empty()) {
        if (const auto written = writeFileAtomically(arguments.json, toJson(study).dump(2) + "\n"); !written)
            return badInput(written.error().message());
    }
    return kDone;
}

}  // namespace

void addReproducePaperCommand(CommandLine& line) {
    auto arguments = std::make_shared<ReproduceArguments>();
    CLI::App* command = line.app.add_subcommand(
        "reproduce-paper",
        "Repeat the paper's experiments in simulation: its figures, its method, ours, and the bound");
    command->add_option("--trials", arguments->study.trials, "Simulated worlds per experiment")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    command->add_option("--only", arguments->study.only, "Only experiments whose name has this in it: 'Table I'");
    command->add_option("--json", arguments->json, "Also write the figures to a file");
    command->callback([&line, arguments] { line.run = [arguments] { return runReproduce(*arguments); }; });
}

}  // namespace skincal
