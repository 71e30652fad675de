#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <unordered_map>

#include "core/formats/body_json.h"
#include "core/formats/files.h"
#include "core/formats/json_cursor.h"
#include "core/formats/recording_parse.h"
#include "core/formats/template_json.h"

namespace skincal {
namespace {

constexpr std::int64_t kMaxId = 0xFFFFFFFFLL;
constexpr std::size_t kMaxTexts = 1'000'000;

ModuleId readId(const JsonCursor& cursor) {
    return ModuleId(static_cast<std::uint32_t>(cursor.integer(1, kMaxId)));
}

template <class Read>
auto optionalAt(const JsonCursor& cursor, std::string_view key, Read read) -> std::optional<decltype(read(cursor))> {
    if (!cursor.holds(key))
        return std::nullopt;
    return read(cursor.at(key));
}

std::string textOr(const JsonCursor& cursor, std::string_view key, const char* otherwise) {
    return cursor.holds(key) ? cursor.at(key).text() : otherwise;
}

double readNumber(const JsonCursor& cursor) {
    return cursor.number();
}
Vector2d readVector2(const JsonCursor& cursor) {
    return cursor.vector2();
}

Isometry3d readPose(const JsonCursor& cursor) {
    const auto q = cursor.at("quaternion_xyzw").array(4);
    if (q.size() != 4)
        cursor.at("quaternion_xyzw").fail(fmt::format("expected 4 numbers, found {}", q.size()));
    const Quaterniond rotation(q[3].number(), q[0].number(), q[1].number(), q[2].number());
    if (std::abs(rotation.norm() - 1) > 1e-3)
        cursor.at("quaternion_xyzw").fail(fmt::format("expected a unit quaternion, its norm is {:g}", rotation.norm()));
    return makeIsometry(rotation.normalized().toRotationMatrix(), cursor.at("translation").translation());
}

Matrix6d readCovariance(const JsonCursor& cursor) {
    const auto rows = cursor.array(6);
    Matrix6d covariance;
    for (std::size_t i = 0; i < 6; ++i) {
        const auto columns = rows.size() == 6 ? rows[i].array(6) : std::vector<JsonCursor>{};
        if (columns.size() != 6)
            cursor.fail("expected 6 rows of 6 numbers");
        for (std::size_t k = 0; k < 6; ++k)
            covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = columns[k].number();
    }
    return covariance;
}

std::vector<std::string> readTexts(const JsonCursor& cursor) {
    std::vector<std::string> texts;
    for (const JsonCursor& item : cursor.array(kMaxTexts))
        texts.push_back(item.text());
    return texts;
}

std::map<std::string, std::string> readTextMap(const JsonCursor& cursor, std::string_view key) {
    std::map<std::string, std::string> map;
    if (cursor.holds(key)) {
        for (const auto& [name, value] : cursor.at(key).members())
            map[name] = value.text();
    }
    return map;
}

template <std::size_t N>
std::size_t readWord(const JsonCursor& cursor, const std::array<const char*, N>& words) {
    const std::string text = cursor.text();
    for (std::size_t i = 0; i < N; ++i) {
        if (text == words.at(i))
            return i;
    }
    cursor.fail(fmt::format("expected one of \"{}\", found \"{}\"", fmt::join(words, "\", \""), text));
}

BodyModule readModule(const JsonCursor& cursor) {
    BodyModule module;
    module.id = readId(cursor.at("id"));
    module.type = cursor.at("type").text();
    module.patch = optionalAt(
        cursor, "patch", [](const JsonCursor& c) { return PatchId(static_cast<std::uint32_t>(c.integer(0, kMaxId))); });
    module.T_patch_module = optionalAt(cursor, "T_patch_module", readPose);
    module.T_body_module = optionalAt(cursor, "T_body_module", readPose);
    module.covariance = optionalAt(cursor, "covariance", readCovariance);
    module.accelerometer = optionalAt(cursor, "accelerometer", [](const JsonCursor& c) {
        return AccelerometerCalibration{c.at("bias").vector3(), c.at("scale").vector3()};
    });
    module.status = cursor.at("status").text();
    return module;
}

BodyPatch readPatch(const JsonCursor& cursor) {
    BodyPatch patch;
    patch.id = PatchId(static_cast<std::uint32_t>(cursor.at("id").integer(0, kMaxId)));
    patch.origin = readId(cursor.at("origin"));
    for (const JsonCursor& item : cursor.at("modules").array(kMaxModules))
        patch.modules.push_back(readId(item));
    patch.T_body_patch = optionalAt(cursor, "T_body_patch", readPose);
    patch.views = readTexts(cursor.at("views"));
    patch.status = cursor.at("status").text();
    return patch;
}

BodyLink readLink(const JsonCursor& cursor) {
    BodyLink link;
    link.link.a = readId(cursor.at("a"));
    link.link.b = readId(cursor.at("b"));
    link.link.a_port = static_cast<int>(cursor.at("a_port").integer(0, kMaxPorts));
    link.link.b_port = static_cast<int>(cursor.at("b_port").integer(0, kMaxPorts));
    link.kind = static_cast<LinkKind>(readWord<2>(cursor.at("kind"), {"adjacent", "cable"}));
    link.reason = textOr(cursor, "reason", "");
    link.distance = optionalAt(cursor, "distance", readNumber);
    return link;
}

BodyView readView(const JsonCursor& cursor) {
    BodyView view;
    view.name = cursor.at("name").text();
    view.T_body_camera = optionalAt(cursor, "T_body_camera", readPose);
    view.residual_rms_px = optionalAt(cursor, "residual_rms_px", readNumber);
    view.status = textOr(cursor, "status", "");
    for (const JsonCursor& item : cursor.at("observations").array(kMaxModules)) {
        BodyObservation o;
        o.module = readId(item.at("module"));
        o.pixel = optionalAt(item, "pixel", readVector2);
        o.residual = optionalAt(item, "residual", readVector2);
        o.verdict = static_cast<ObservationVerdict>(
            readWord<4>(item.at("verdict"), {"used", "rejected", "not found", "ambiguous"}));
        o.reason = textOr(item, "reason", "");
        view.observations.push_back(std::move(o));
    }
    return view;
}

BodyQuality readQuality(const JsonCursor& cursor) {
    BodyQuality q;
    q.residual_rms_px = optionalAt(cursor, "residual_rms_px", readNumber);
    q.link_mismatch_rms = optionalAt(cursor, "link_mismatch_rms", readNumber);
    q.link_mismatch_max = optionalAt(cursor, "link_mismatch_max", readNumber);
    q.gravity_residual_rms = optionalAt(cursor, "gravity_residual_rms", readNumber);
    if (cursor.holds("condition")) {
        for (const auto& [name, value] : cursor.at("condition").members())
            q.condition[name] = value.json().is_null() ? std::numeric_limits<double>::infinity() : value.number();
    }
    if (cursor.holds("warnings"))
        q.warnings = readTexts(cursor.at("warnings"));
    if (cursor.holds("missing"))
        q.missing = readTexts(cursor.at("missing"));
    if (cursor.holds("verdict"))
        q.trust = static_cast<Trust>(readWord<3>(cursor.at("verdict"), {"good", "usable", "not to be trusted"}));
    return q;
}

/// Names and ids are taken once, and what is referred to is there: whoever uses a body may look things up blindly.
void checkReferences(const JsonCursor& root, const BodyModel& body) {
    const auto entry = [&](const char* key, std::size_t i) { return root.at(key).array(kMaxLinks)[i]; };
    std::map<std::string, const ModuleTemplate*> types;
    for (std::size_t t = 0; t < body.templates.size(); ++t) {
        if (!types.emplace(body.templates[t].name, &body.templates[t]).second)
            entry("module_types", t).at("name").fail("expected a name of its own, it is taken");
    }
    std::set<PatchId> patches;
    for (std::size_t p = 0; p < body.patches.size(); ++p) {
        if (!patches.insert(body.patches[p].id).second)
            entry("patches", p).at("id").fail("expected an id of its own, it is taken");
    }
    std::unordered_map<ModuleId, const ModuleTemplate*> modules;
    for (std::size_t m = 0; m < body.modules.size(); ++m) {
        const BodyModule& module = body.modules[m];
        const auto type = types.find(module.type);
        if (type == types.end())
            entry("modules", m).at("type").fail("expected a name from module_types, found '" + module.type + "'");
        if (!modules.emplace(module.id, type->second).second)
            entry("modules", m).at("id").fail(fmt::format("expected an id of its own, {} is taken", module.id.value));
        if (module.patch && patches.count(*module.patch) == 0)
            entry("modules", m)
                .at("patch")
                .fail(fmt::format("expected the id of a patch, {} is none", module.patch->value));
    }
    const auto need = [&](ModuleId id, const JsonCursor& cursor) {
        if (modules.count(id) == 0)
            cursor.fail(fmt::format("expected the ids of modules, {} is none", id.value));
    };
    const std::vector<JsonCursor> patchCursors = root.at("patches").array(kMaxModules);
    for (std::size_t p = 0; p < body.patches.size(); ++p) {
        need(body.patches[p].origin, patchCursors[p].at("origin"));
        for (const ModuleId id : body.patches[p].modules)
            need(id, patchCursors[p].at("modules"));
    }
    const auto needPort = [&](ModuleId id, int port, const JsonCursor& cursor) {
        if (static_cast<std::size_t>(port) >= modules.at(id)->ports.size())
            cursor.fail(fmt::format("expected a port below {} of '{}', found {}", modules.at(id)->ports.size(),
                                    modules.at(id)->name, port));
    };
    const std::vector<JsonCursor> links = root.at("links").array(kMaxLinks);
    for (std::size_t l = 0; l < body.links.size(); ++l) {
        const Link& link = body.links[l].link;
        need(link.a, links[l].at("a"));
        need(link.b, links[l].at("b"));
        needPort(link.a, link.a_port, links[l].at("a_port"));
        needPort(link.b, link.b_port, links[l].at("b_port"));
    }
    const std::vector<JsonCursor> views = root.at("views").array(kMaxViews);
    for (std::size_t v = 0; v < body.views.size(); ++v) {
        for (const BodyObservation& observation : body.views[v].observations)
            need(observation.module, views[v].at("observations"));
    }
}

}  // namespace

tl::expected<BodyModel, FileError> parseBodyJson(std::string_view text, const std::filesystem::path& file) {
    try {
        const nlohmann::json json = parseJson(text, file);
        const JsonCursor root(json, file);
        if (root.at("format").text() != "skincal-body")
            root.at("format").fail(fmt::format("expected \"skincal-body\", found \"{}\"", root.at("format").text()));
        const auto version = root.at("version").integer(1, 1'000'000);
        if (version > 1)
            root.at("version").fail(fmt::format(
                "expected version 1, found {}: this body was written by a newer version of the program", version));
        BodyModel body;
        const JsonCursor generator = root.at("generator");
        body.generator.program = textOr(generator, "program", "");
        body.generator.version = textOr(generator, "version", "");
        body.generator.method = textOr(generator, "method", "");
        body.generator.options = readTextMap(generator, "options");
        body.generator.recording_sha256 = readTextMap(generator, "recording_sha256");
        body.body_frame = root.at("body_frame").text();
        for (const JsonCursor& item : root.at("module_types").array(kMaxTemplates))
            body.templates.push_back(readTemplate(item));
        for (const JsonCursor& item : root.at("modules").array(kMaxModules))
            body.modules.push_back(readModule(item));
        for (const JsonCursor& item : root.at("patches").array(kMaxModules))
            body.patches.push_back(readPatch(item));
        for (const JsonCursor& item : root.at("links").array(kMaxLinks))
            body.links.push_back(readLink(item));
        for (const JsonCursor& item : root.at("views").array(kMaxViews))
            body.views.push_back(readView(item));
        body.quality = readQuality(root.at("quality"));
        body.quality.modulesTotal = body.modules.size();
        body.quality.modulesPlaced = static_cast<std::size_t>(std::count_if(
            body.modules.begin(), body.modules.end(), [](const BodyModule& m) { return m.T_body_module.has_value(); }));
        checkReferences(root, body);
        return body;
    } catch (const FileErrorException& exception) {
        return tl::unexpected(exception.error);
    }
}

tl::expected<BodyModel, FileError> readBody(const std::filesystem::path& file) {
    const auto text = readFile(file, kMaxJsonBytes);
    if (!text)
        return tl::unexpected(text.error());
    return parseBodyJson(*text, file);
}

}  // namespace skincal
