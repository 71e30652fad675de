#include <fmt/format.h>

#include <filesystem>

#include "app/command_line.h"
#include "app/outcome.h"
#include "app/text_layout.h"
#include "core/estimation/advice_basis.h"
#include "core/formats/file_error.h"
#include "core/workflow/advise.h"

namespace skincal {
namespace {

using Json = nlohmann::ordered_json;

struct AdviseArguments {
    std::filesystem::path recording;
    std::size_t best = 3;
    bool json = false;
};

template <class Id>
Json numbers(const std::vector<Id>& ids) {
    Json json = Json::array();
    for (const Id id : ids)
        json.push_back(id.value);
    return json;
}

template <class T>
Json orNull(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

Json toJson(const Vector3d& v) {
    return Json::array({v.x(), v.y(), v.z()});
}

Json toJson(const ForecastGain& gain) {
    return {{"worst_before", gain.worstBefore},
            {"worst_after", gain.worstAfter},
            {"rms_before", gain.rmsBefore},
            {"rms_after", gain.rmsAfter},
            {"modules", gain.modules}};
}

Json toJson(const Shortfall& shortfall) {
    Json json;
    json["kind"] = name(shortfall.kind);
    json["patches"] = numbers(shortfall.patches);
    json["modules"] = numbers(shortfall.modules);
    json["views"] = shortfall.views;
    json["up"] = shortfall.up_r ? toJson(*shortfall.up_r) : Json();
    json["figure"] = orNull(shortfall.figure);
    json["unit"] = shortfall.unit;
    json["text"] = shortfall.text.english();
    return json;
}

Json toJson(const NextPose& pose) {
    Json json;
    json["up"] = toJson(pose.up_r);
    json["nearest_pose"] = pose.nearest;
    json["gain"] = toJson(pose.gain);
    json["text"] = pose.words.english();
    return json;
}

Json toJson(const NextView& view) {
    Json json;
    const Quaterniond q(view.T_r_v.linear());
    json["T_body_camera"] = {{"translation", toJson(view.T_r_v.translation())},
                             {"rotation_wxyz", Json::array({q.w(), q.x(), q.y(), q.z()})}};
    json["patches"] = numbers(view.patches);
    json["first_seen"] = numbers(view.firstSeen);
    json["gain"] = toJson(view.gain);
    json["text"] = view.words.english();
    return json;
}

Json toJson(const Advice& advice) {
    Json json;
    json["modules_placed"] = advice.body.quality.modulesPlaced;
    json["modules_total"] = advice.body.quality.modulesTotal;
    json["verdict"] = name(advice.body.quality.trust);
    json["worst_sigma"] = orNull(advice.worst);
    json["worst_module"] = advice.worstModule ? Json(advice.worstModule->value) : Json();
    json["worst_size_part"] = orNull(advice.worstSize);
    json["rms_sigma"] = orNull(advice.rms);
    json["relative_scale_sigma"] = orNull(advice.scale);
    const auto list = [](const auto& entries) {
        Json array = Json::array();
        for (const auto& entry : entries)
            array.push_back(toJson(entry));
        return array;
    };
    json["shortfalls"] = list(advice.shortfalls);
    json["next_poses"] = list(advice.poses);
    json["next_views"] = list(advice.views);
    return json;
}

std::string gainText(const ForecastGain& gain) {
    return fmt::format("worst module {:.3f} → {:.3f} mm, rms {:.3f} → {:.3f} mm", gain.worstBefore * 1e3,
                       gain.worstAfter * 1e3, gain.rmsBefore * 1e3, gain.rmsAfter * 1e3);
}

/// A measurement that improves the worst module by less than this is hardly worth the operator's time.
constexpr double kWorthwhile = 0.02;

/// The best of a kind of measurement in turn, or that none is worth its time.
template <class Next, class Line>
std::string bestText(const char* what, const std::vector<Next>& ranked, std::size_t best, const Line& line) {
    if (ranked.empty())
        return {};
    std::string text = fmt::format("\nNext {}, the best first\n", what);
    const ForecastGain& gain = ranked.front().gain;
    if (gain.worstDrop() < kWorthwhile * gain.worstBefore)
        return text + wrapped("  ", fmt::format("one more would hardly help: {} at best", gainText(gain)));
    for (std::size_t i = 0; i < std::min(best, ranked.size()); ++i)
        text += wrapped(fmt::format("  {}. ", i + 1), line(ranked[i])) + "     " + gainText(ranked[i].gain) + "\n";
    return text;
}

std::string poseText(const NextPose& pose) {
    return fmt::format(
        "turn the body until {}: up is ({:.2f}, {:.2f}, {:.2f}) in the body frame, {:.0f}° from the "
        "nearest pose there is",
        printable(pose.words.english()), pose.up_r.x(), pose.up_r.y(), pose.up_r.z(), pose.nearest / kDegree);
}

std::string viewText(const NextView& view) {
    const std::string first =
        view.firstSeen.empty() ? "" : fmt::format(", {} for the first time", listed(view.firstSeen).english());
    return fmt::format("{}: shows {} modules{}", printable(view.words.english()), view.gain.modules, first);
}

std::string adviceText(const Advice& advice, std::size_t best) {
    const BodyQuality& q = advice.body.quality;
    std::string text = fmt::format("modules placed     {} of {}\nverdict            {}\n", q.modulesPlaced,
                                   q.modulesTotal, name(q.trust));
    if (advice.worst)
        text += fmt::format("within the body    ±{:.3f} mm rms, ±{:.3f} mm at worst (module {})\n", *advice.rms * 1e3,
                            *advice.worst * 1e3, advice.worstModule->value);
    // First-order parts need not add up: the size is worth a word where it is most of the whole.
    constexpr double kMost = 0.7;
    if (advice.scale)
        text += fmt::format("size of the body   ±{:.2f} %, told by links alone{}\n", *advice.scale * 100,
                            *advice.worstSize > kMost * *advice.worst ? "; most of the worst module's" : "");
    text += "\nWhat is missing\n";
    if (advice.shortfalls.empty())
        text += "  nothing\n";
    for (const Shortfall& shortfall : advice.shortfalls)
        text += wrapped("  - ", printable(shortfall.text.english()));
    return text + bestText("gravity pose", advice.poses, best, poseText) +
           bestText("view", advice.views, best, viewText);
}

int runAdvise(const AdviseArguments& arguments) {
    const auto recording = readRecording(arguments.recording);
    if (!recording)
        return badInput(recording.error().message());
    tl::expected<Advice, CalibrateError> advice;
    {
        TerminalProgress progress;
        advice = advise(*recording, framesOf(arguments.recording, *recording), {}, progress.context());
    }
    if (!advice)
        return reportFailure(advice.error());
    if (arguments.json)
        printJson(toJson(*advice));
    else
        fmt::print("{}", adviceText(*advice, arguments.best));
    return exitCodeOf(advice->body);
}

}  // namespace

void addAdviseCommand(CommandLine& line) {
    auto arguments = std::make_shared<AdviseArguments>();
    CLI::App* command = line.app.add_subcommand("advise", "Say what a recording lacks and what to measure next");
    command->add_option("RECORDING", arguments->recording, "A *.skinrec directory")->required();
    command->add_option("--best", arguments->best, "How many poses and views to print")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    command->add_flag("--json", arguments->json, "Print all of it as JSON (metres and radians)");
    command->footer(
        "The recording is calibrated by the joint method; nothing is written. Standard deviations are those of module\n"
        "positions within the body, wherever it stands. Every pose and view offered was forecast: readings and\n"
        "detections as the recording's own would be were added to it and all standard deviations computed anew. The\n"
        "best brings the worst module's down the most.\n\n"
        "Directions are those that point up, against gravity, in the body frame of body models.\n\n"
        "Exit codes: 0 every module is placed; 1 the data do not suffice: a module or all are not placed, or the\n"
        "verdict is \"not to be trusted\"; 2 bad input or usage.");
    command->callback([&line, arguments] { line.run = [arguments] { return runAdvise(*arguments); }; });
}

}  // namespace skincal
