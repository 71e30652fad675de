#include <algorithm>

#include "app/quality_table.h"

namespace skincal {
namespace {

using Json = nlohmann::ordered_json;

Json orNull(const auto& value) {
    return value ? Json(*value) : Json();
}

Json idsOf(const std::vector<ModuleId>& modules) {
    Json json = Json::array();
    for (const ModuleId id : modules)
        json.push_back(id.value);
    return json;
}

Json toJson(const Finding& finding) {
    Json json;
    json["kind"] = name(finding.kind);
    json["modules"] = idsOf(finding.modules);
    json["view"] = orNull(finding.view);
    json["pose"] = orNull(finding.pose);
    json["text"] = finding.text.english();
    return json;
}

Json toJson(const StageReport& stage) {
    Json json;
    json["stage"] = stage.stage;
    json["seconds"] = stage.seconds;
    json["iterations"] = stage.iterations;
    return json;
}

}  // namespace

std::vector<StageReport> sumByStage(const std::vector<StageReport>& stages) {
    std::vector<StageReport> sums;
    for (const StageReport& stage : stages) {
        const auto same =
            std::find_if(sums.begin(), sums.end(), [&](const StageReport& sum) { return sum.stage == stage.stage; });
        StageReport& sum = same != sums.end() ? *same : sums.emplace_back(StageReport{stage.stage});
        sum.seconds += stage.seconds;
        sum.iterations += stage.iterations;
    }
    return sums;
}

StageReport total(const std::vector<StageReport>& stages) {
    StageReport sum{"all"};
    for (const StageReport& stage : stages) {
        sum.seconds += stage.seconds;
        sum.iterations += stage.iterations;
    }
    return sum;
}

std::size_t restingOnLinksAndGravity(const BodyModel& body) {
    return static_cast<std::size_t>(std::count_if(body.modules.begin(), body.modules.end(),
                                                  [](const BodyModule& m) { return m.T_body_module && !m.seen; }));
}

nlohmann::ordered_json qualityJson(const BodyModel& body) {
    const BodyQuality& q = body.quality;
    Json json;
    json["method"] = body.generator.method;
    json["verdict"] = name(q.trust);
    json["modules_placed"] = q.modulesPlaced;
    json["modules_total"] = q.modulesTotal;
    json["modules_seen"] = q.modulesPlaced - restingOnLinksAndGravity(body);
    json["modules_on_links_and_gravity"] = restingOnLinksAndGravity(body);
    json["residual_rms_px"] = orNull(q.residual_rms_px);
    json["link_mismatch_rms"] = orNull(q.link_mismatch_rms);
    json["link_mismatch_max"] = orNull(q.link_mismatch_max);
    json["gravity_residual_rms"] = orNull(q.gravity_residual_rms);
    json["condition"] = q.condition;
    json["warnings"] = english(q.warnings);
    json["missing"] = english(q.missing);
    json["findings"] = Json::array();
    for (const Finding& finding : q.findings)
        json["findings"].push_back(toJson(finding));
    json["seconds"] = total(q.stages).seconds;
    json["iterations"] = total(q.stages).iterations;
    json["stages"] = Json::array();
    for (const StageReport& stage : sumByStage(q.stages))
        json["stages"].push_back(toJson(stage));
    json["patches"] = Json::array();
    for (const BodyPatch& patch : body.patches) {
        Json entry;
        entry["id"] = patch.id.value;
        entry["modules"] = patch.modules.size();
        entry["placed"] = std::count_if(body.modules.begin(), body.modules.end(), [&](const BodyModule& m) {
            return m.patch == patch.id && m.T_body_module.has_value();
        });
        entry["views"] = patch.views.size();
        entry["status"] = patch.status.english();
        json["patches"].push_back(std::move(entry));
    }
    return json;
}

}  // namespace skincal
