#include <fmt/format.h>

#include <fstream>

#include "app/command_line.h"
#include "core/study/scan_study.h"

namespace skincal {
namespace {

using Json = nlohmann::ordered_json;

struct ScanArguments {
    int seeds = 10;
    std::uint64_t firstSeed = 1;
    std::vector<std::string> disturbances;
    std::vector<std::size_t> modules;
    std::vector<std::string> methods;
    std::string plot;
    bool json = false;
};

template <class T>
bool wanted(const std::vector<T>& asked, const T& value) {
    return asked.empty() || std::find(asked.begin(), asked.end(), value) != asked.end();
}

Json toJson(const ScanStudyRow& row) {
    const ScanScore& score = row.score;
    return {{"disturbance", name(row.what.disturbance)},
            {"strength", row.what.strength},
            {"modules", row.what.modules},
            {"distance", row.what.distance},
            {"scan", name(row.what.method)},
            {"views", score.views},
            {"refused", score.refused},
            {"pictures", score.frames / std::max<std::size_t>(1, score.views)},
            {"visible", score.visible},
            {"found", score.found},
            {"to_choose_from", score.choices},
            {"taken_by_the_body", score.settled},
            {"wrong", score.wrong},
            {"rms_px", score.rms_px()},
            {"rms_sigma", score.rmsSigmas()},
            {"bounded", score.sharp},
            {"rms_bound", score.sharp > 0 ? Json(score.rmsBounds()) : Json()},
            {"seconds", score.seconds}};
}

int runScan(const ScanArguments& arguments) {
    ScanStudyOptions options;
    options.seeds = arguments.seeds;
    options.firstSeed = arguments.firstSeed;
    for (const ScanCase& what : allScanCases()) {
        if (wanted(arguments.disturbances, std::string(name(what.disturbance))) &&
            wanted(arguments.modules, what.modules) && wanted(arguments.methods, std::string(name(what.method))))
            options.cases.push_back(what);
    }
    if (options.cases.empty())
        return badInput("the study has no such scans");
    ScanStudy study;
    {
        TerminalProgress progress;
        study = runScanStudy(options, progress.context());
    }
    if (study.cancelled)
        return badInput("interrupted");
    if (!arguments.plot.empty()) {
        std::ofstream file(arguments.plot);
        file << scanPlot(study);
        file.close();
        if (!file)
            return badInput(arguments.plot + ": cannot be written");
    }
    if (arguments.json) {
        Json json = Json::array();
        for (const ScanStudyRow& row : study.rows)
            json.push_back(toJson(row));
        printJson(json);
    } else {
        fmt::print("{}", scanTable(study));
    }
    return kDone;
}

}  // namespace

void addScanStudyCommand(CommandLine& line) {
    auto arguments = std::make_shared<ScanArguments>();
    CLI::App* command = line.app.add_subcommand(
        "scan-study",
        "Scan simulated skins in pictures with everything that disturbs a scan, and count what is found and what is "
        "taken for something else, next to the paper's scan and detector");
    command->add_option("--seeds", arguments->seeds, "Skins per case")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    addSeedOption(*command, arguments->firstSeed, "Seed of the first skin; the next ones count on", "--first-seed");
    std::vector<std::string> known;
    for (const ScanCase& what : allScanCases()) {
        if (!std::count(known.begin(), known.end(), std::string(name(what.disturbance))))
            known.emplace_back(name(what.disturbance));
    }
    command->add_option("--disturbance", arguments->disturbances, "Only these")->check(CLI::IsMember(known));
    command->add_option("--modules", arguments->modules, "Only skins of so many modules: 7, 55, 200, 1000, 10000");
    command->add_option("--scan", arguments->methods, "Only these")
        ->check(CLI::IsMember({std::string(name(ScanMethod::Coded)), std::string(name(ScanMethod::CodedOnce)),
                               std::string(name(ScanMethod::OneAtATime)), std::string(name(ScanMethod::PaperSingle))}));
    command->add_option("--plot", arguments->plot, "Write what is found against strength as a picture (SVG)");
    command->add_flag("--json", arguments->json, "Print as JSON (metres, pixels, seconds of decoding)");
    command->callback([&line, arguments] { line.run = [arguments] { return runScan(*arguments); }; });
}

}  // namespace skincal
