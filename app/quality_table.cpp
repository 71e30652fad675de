#include "app/quality_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "app/text_layout.h"
#include "core/formats/file_error.h"

namespace skincal {
namespace {

std::string orDash(const std::optional<double>& value, double factor, int digits, const char* unit) {
    return value ? fmt::format("{:.{}f} {}", *value * factor, digits, unit) : "-";
}

std::string counted(std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string duration(double seconds) {
    return fmt::format("{:.{}f} s", seconds, seconds < 0.1 ? 2 : seconds < 10 ? 1 : 0);
}

std::string timeTaken(const std::vector<StageReport>& all) {
    const std::vector<StageReport> stages = sumByStage(all);
    const StageReport sum = total(stages);
    std::string text = duration(sum.seconds);
    std::string parts;
    for (const StageReport& stage : stages)
        parts += (parts.empty() ? "" : ", ") + stage.stage + " " + duration(stage.seconds);
    if (stages.size() > 1)
        text += " (" + parts + ")";
    if (sum.iterations > 0)
        text += ", " + counted(static_cast<std::size_t>(sum.iterations), "iteration");
    return text;
}

std::string patchRows(const BodyModel& body) {
    constexpr std::size_t kMaxRows = 30;
    std::map<PatchId, std::size_t> placed;
    for (const BodyModule& module : body.modules) {
        if (module.patch && module.T_body_module)
            ++placed[*module.patch];
    }
    std::string text =
        fmt::format("{:>5}  {:>6}  {:>7}  {:>6}  {:>5}  status\n", "patch", "origin", "modules", "placed", "views");
    for (std::size_t k = 0; k < std::min(kMaxRows, body.patches.size()); ++k) {
        const BodyPatch& patch = body.patches[k];
        text += wrapped(fmt::format("{:>5}  {:>6}  {:>7}  {:>6}  {:>5}  ", patch.id.value, patch.origin.value,
                                    patch.modules.size(), placed[patch.id], patch.views.size()),
                        printable(patch.status.english()));
    }
    if (body.patches.size() > kMaxRows)
        text += fmt::format("  … and {} patches more\n", body.patches.size() - kMaxRows);
    return text;
}

std::string figures(const BodyModel& body) {
    const BodyQuality& q = body.quality;
    const auto cables = std::count_if(body.links.begin(), body.links.end(),
                                      [](const BodyLink& l) { return l.kind == LinkKind::Cable; });
    const auto views = std::count_if(body.views.begin(), body.views.end(),
                                     [](const BodyView& v) { return v.T_body_camera.has_value(); });
    const auto row = [](const char* what, const std::string& value) {
        return wrapped(fmt::format("{:<19}", what), value);
    };
    std::string text = row("modules placed", fmt::format("{} of {}", q.modulesPlaced, q.modulesTotal));
    if (const std::size_t unseen = restingOnLinksAndGravity(body); unseen > 0)
        text += row("", "resting on links and gravity alone: " + counted(unseen, "module"));
    text += row("views placed", fmt::format("{} of {}", views, body.views.size()));
    text += row("links", fmt::format("{}, {} of them cables", body.links.size(), cables));
    text += row("pixel residual", orDash(q.residual_rms_px, 1, 3, "px") + " rms");
    text += row("link mismatch", fmt::format("{} rms, {} max", orDash(q.link_mismatch_rms, 1e3, 2, "mm"),
                                             orDash(q.link_mismatch_max, 1e3, 2, "mm")));
    text += row("gravity residual", orDash(q.gravity_residual_rms, 1, 3, "m/s²") + " rms");
    text += row("method", body.generator.method);
    if (!q.stages.empty())
        text += row("time", timeTaken(q.stages));
    text += row("verdict", std::string(name(q.trust)));
    return text;
}

}  // namespace

std::string qualityTable(const BodyModel& body, const std::vector<TableRow>& more) {
    const BodyQuality& q = body.quality;
    std::string text = patchRows(body) + "\n" + figures(body);
    for (const auto& [what, value] : more)
        text += fmt::format("{:<18} {}\n", what, printable(value));

    std::set<std::string> told;
    const auto once = [&](const char* lead, const Sentence& sentence) {
        const std::string said = sentence.english();
        return told.insert(said).second ? wrapped(lead, printable(said)) : "";
    };
    std::string findings;
    for (const Finding& finding : q.findings)
        findings += once("  - ", finding.text);
    if (!findings.empty())
        text += "\nwhat disagrees with the rest:\n" + findings;
    std::string rest;
    for (const Sentence& missing : q.missing)
        rest += once("missing: ", missing);
    for (const Sentence& warning : q.warnings)
        rest += once("warning: ", warning);
    return rest.empty() ? text : text + "\n" + rest;
}

}  // namespace skincal
