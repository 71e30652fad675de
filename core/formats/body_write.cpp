#include <array>

#include "core/formats/body_json.h"
#include "core/formats/files.h"
#include "core/formats/template_json.h"

namespace skincal {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
Json orNull(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

template <class Vector>
Json numbers(const Vector& v) {
    Json json = Json::array();
    for (Eigen::Index i = 0; i < v.size(); ++i)
        json.push_back(v[i]);
    return json;
}

Json idsOf(const std::vector<ModuleId>& modules) {
    Json json = Json::array();
    for (const ModuleId id : modules)
        json.push_back(id.value);
    return json;
}

Json toJson(const std::optional<Isometry3d>& T) {
    if (!T)
        return {};
    Quaterniond q(T->linear());
    q.normalize();
    if (q.w() < 0)
        q.coeffs() = -q.coeffs();
    Json json;
    json["translation"] = numbers(T->translation());
    json["quaternion_xyzw"] = {q.x(), q.y(), q.z(), q.w()};
    return json;
}

Json toJson(const BodyModule& module) {
    Json json;
    json["id"] = module.id.value;
    json["type"] = module.type;
    json["patch"] = module.patch ? Json(module.patch->value) : Json();
    json["T_patch_module"] = toJson(module.T_patch_module);
    json["T_body_module"] = toJson(module.T_body_module);
    json["covariance"] = nullptr;
    if (module.covariance && module.covariance->allFinite()) {
        json["covariance"] = Json::array();
        for (Eigen::Index i = 0; i < 6; ++i)
            json["covariance"].push_back(numbers(Vector6d(module.covariance->row(i))));
    }
    if (module.accelerometer) {
        json["accelerometer"]["bias"] = numbers(module.accelerometer->bias);
        json["accelerometer"]["scale"] = numbers(module.accelerometer->scale);
        if (!module.accelerometer->misalignment.isZero(0))
            json["accelerometer"]["misalignment"] = numbers(module.accelerometer->misalignment);
    }
    json["status"] = module.status.english();
    json["support"] = nullptr;
    if (module.T_body_module)
        json["support"] = module.seen ? "pictures" : "links and gravity";
    return json;
}

Json toJson(const BodyPatch& patch) {
    Json json;
    json["id"] = patch.id.value;
    json["origin"] = patch.origin.value;
    json["modules"] = idsOf(patch.modules);
    json["T_body_patch"] = toJson(patch.T_body_patch);
    json["views"] = patch.views;
    json["status"] = patch.status.english();
    return json;
}

Json toJson(const BodyLink& link) {
    Json json;
    json["a"] = link.link.a.value;
    json["a_port"] = link.link.a_port;
    json["b"] = link.link.b.value;
    json["b_port"] = link.link.b_port;
    json["kind"] = link.kind == LinkKind::Adjacent ? "adjacent" : "cable";
    json["reason"] = link.reason.english();
    json["distance"] = orNull(link.distance);
    return json;
}

Json toJson(const BodyObservation& o) {
    static constexpr std::array kVerdicts{"used", "rejected", "not found", "ambiguous"};
    Json json;
    json["module"] = o.module.value;
    json["pixel"] = o.pixel ? numbers(*o.pixel) : Json();
    json["residual"] = o.residual ? numbers(*o.residual) : Json();
    json["verdict"] = kVerdicts.at(static_cast<std::size_t>(o.verdict));
    json["reason"] = o.reason.english();
    return json;
}

Json toJson(const BodyView& view) {
    Json json;
    json["name"] = view.name;
    json["T_body_camera"] = toJson(view.T_body_camera);
    json["residual_rms_px"] = orNull(view.residual_rms_px);
    json["status"] = view.status.english();
    json["observations"] = Json::array();
    for (const BodyObservation& o : view.observations)
        json["observations"].push_back(toJson(o));
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

template <class Items>
Json arrayOf(const Items& items) {
    Json json = Json::array();
    for (const auto& item : items)
        json.push_back(toJson(item));
    return json;
}

Json toJson(const BodyQuality& q) {
    Json json;
    json["modules_placed"] = q.modulesPlaced;
    json["modules_total"] = q.modulesTotal;
    json["residual_rms_px"] = orNull(q.residual_rms_px);
    json["link_mismatch_rms"] = orNull(q.link_mismatch_rms);
    json["link_mismatch_max"] = orNull(q.link_mismatch_max);
    json["gravity_residual_rms"] = orNull(q.gravity_residual_rms);
    json["condition"] = Json::object();
    for (const auto& [key, value] : q.condition)
        json["condition"][key] = value;
    json["warnings"] = english(q.warnings);
    json["missing"] = english(q.missing);
    json["findings"] = arrayOf(q.findings);
    json["verdict"] = name(q.trust);
    return json;
}

}  // namespace

std::string bodyToJson(const BodyModel& body, const std::map<std::string, UnknownKeys>& unknownOfTypes) {
    Json json;
    json["format"] = "skincal-body";
    json["version"] = 1;
    Json& generator = json["generator"];
    generator["program"] = body.generator.program;
    generator["version"] = body.generator.version;
    generator["method"] = body.generator.method;
    generator["options"] = Json::object();
    for (const auto& [key, value] : body.generator.options)
        generator["options"][key] = value;
    generator["recording_sha256"] = Json::object();
    for (const auto& [key, value] : body.generator.recording_sha256)
        generator["recording_sha256"][key] = value;
    json["body_frame"] = body.body_frame;
    json["module_types"] = Json::array();
    for (const ModuleTemplate& type : body.templates) {
        json["module_types"].push_back(templateToJson(type));
        if (const auto unknown = unknownOfTypes.find(type.name); unknown != unknownOfTypes.end())
            addKeys(json["module_types"].back(), unknown->second);
    }
    json["quality"] = toJson(body.quality);
    json["patches"] = arrayOf(body.patches);
    json["modules"] = arrayOf(body.modules);
    json["links"] = arrayOf(body.links);
    json["views"] = arrayOf(body.views);
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

tl::expected<void, FileError> writeBody(const BodyModel& body, const std::filesystem::path& file,
                                        const std::map<std::string, UnknownKeys>& unknownOfTypes) {
    return writeFileAtomically(file, bodyToJson(body, unknownOfTypes));
}

}  // namespace skincal
