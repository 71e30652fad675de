#include "app/quality_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/formats/file_error.h"

namespace skincal {
namespace {

std::string orDash(const std::optional<double>& value, double factor, int digits, const char* unit) {
    return value ? fmt::format("{:.{}f} {}", *value * factor, digits, unit) : "-";
}

std::size_t placedIn(const BodyModel& body, PatchId patch) {
    return static_cast<std::size_t>(std::count_if(body.modules.begin(), body.modules.end(), [&](const BodyModule& m) {
        return m.patch == patch && m.T_body_module.has_value();
    }));
}

}  // namespace

std::string qualityTable(const BodyModel& body) {
    const BodyQuality& q = body.quality;
    std::string text;
    text += fmt::format("{:>5}  {:>6}  {:>7}  {:>6}  {:>5}  status\n", "patch", "origin", "modules", "placed", "views");
    constexpr std::size_t kMaxRows = 30;
    for (std::size_t k = 0; k < std::min(kMaxRows, body.patches.size()); ++k) {
        const BodyPatch& patch = body.patches[k];
        text +=
            fmt::format("{:>5}  {:>6}  {:>7}  {:>6}  {:>5}  {}\n", patch.id.value, patch.origin.value,
                        patch.modules.size(), placedIn(body, patch.id), patch.views.size(), printable(patch.status));
    }
    if (body.patches.size() > kMaxRows)
        text += fmt::format("  … and {} patches more\n", body.patches.size() - kMaxRows);
    const auto cables = std::count_if(body.links.begin(), body.links.end(),
                                      [](const BodyLink& l) { return l.kind == LinkKind::Cable; });
    const auto views = std::count_if(body.views.begin(), body.views.end(),
                                     [](const BodyView& v) { return v.T_body_camera.has_value(); });
    text += fmt::format("\nmodules placed     {} of {}\n", q.modulesPlaced, q.modulesTotal);
    text += fmt::format("views placed       {} of {}\n", views, body.views.size());
    text += fmt::format("links              {}, {} of them cables\n", body.links.size(), cables);
    text += fmt::format("pixel residual     {} rms\n", orDash(q.residual_rms_px, 1, 3, "px"));
    text += fmt::format("link mismatch      {} rms, {} max\n", orDash(q.link_mismatch_rms, 1e3, 2, "mm"),
                        orDash(q.link_mismatch_max, 1e3, 2, "mm"));
    text += fmt::format("gravity residual   {} rms\n", orDash(q.gravity_residual_rms, 1, 3, "m/s²"));
    text += fmt::format("method             {}\n", body.generator.method);
    text += fmt::format("verdict            {}\n", name(q.trust));
    for (const std::string& missing : q.missing)
        text += fmt::format("missing: {}\n", printable(missing));
    for (const std::string& warning : q.warnings)
        text += fmt::format("warning: {}\n", printable(warning));
    return text;
}

nlohmann::ordered_json qualityJson(const BodyModel& body) {
    const auto number = [](const std::optional<double>& value) {
        return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
    };
    const BodyQuality& q = body.quality;
    nlohmann::ordered_json json;
    json["method"] = body.generator.method;
    json["verdict"] = name(q.trust);
    json["modules_placed"] = q.modulesPlaced;
    json["modules_total"] = q.modulesTotal;
    json["residual_rms_px"] = number(q.residual_rms_px);
    json["link_mismatch_rms"] = number(q.link_mismatch_rms);
    json["link_mismatch_max"] = number(q.link_mismatch_max);
    json["gravity_residual_rms"] = number(q.gravity_residual_rms);
    json["condition"] = q.condition;
    json["warnings"] = q.warnings;
    json["missing"] = q.missing;
    json["patches"] = nlohmann::ordered_json::array();
    for (const BodyPatch& patch : body.patches) {
        nlohmann::ordered_json entry;
        entry["id"] = patch.id.value;
        entry["modules"] = patch.modules.size();
        entry["placed"] = placedIn(body, patch.id);
        entry["views"] = patch.views.size();
        entry["status"] = patch.status;
        json["patches"].push_back(std::move(entry));
    }
    return json;
}

}  // namespace skincal
