#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <set>

#include "core/formats/body_json.h"
#include "core/formats/body_references.h"
#include "core/formats/files.h"
#include "core/formats/json_cursor.h"
#include "core/formats/recording_parse.h"
#include "core/formats/template_json.h"

namespace skincal {
namespace {

constexpr std::int64_t kMaxId = 0xFFFFFFFFLL;
constexpr std::size_t kMaxTexts = 1'000'000;
constexpr std::int64_t kMaxPose = 1'000'000;

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

std::vector<Sentence> readSentences(const JsonCursor& cursor) {
    std::vector<Sentence> sentences;
    for (std::string& text : readTexts(cursor))
        sentences.push_back(Sentence::verbatim(std::move(text)));
    return sentences;
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
std::size_t readWord(const JsonCursor& cursor, const std::array<std::string_view, N>& words) {
    const std::string text = cursor.text();
    for (std::size_t i = 0; i < N; ++i) {
        if (text == words.at(i))
            return i;
    }
    cursor.fail(fmt::format("expected one of \"{}\", found \"{}\"", fmt::join(words, "\", \""), text));
}

Vector3d readRotationVector(const JsonCursor& cursor) {
    const Vector3d w = cursor.vector3();
    if (w.norm() > std::numbers::pi)
        cursor.fail(fmt::format("expected a rotation vector in rad, at most pi long, it is {:g} long", w.norm()));
    return w;
}

AccelerometerCalibration readAccelerometer(const JsonCursor& cursor) {
    AccelerometerCalibration calibration;
    calibration.bias = cursor.at("bias").vector3();
    calibration.scale = cursor.at("scale").vector3();
    calibration.misalignment = optionalAt(cursor, "misalignment", readRotationVector).value_or(Vector3d::Zero());
    return calibration;
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
    module.accelerometer = optionalAt(cursor, "accelerometer", readAccelerometer);
    module.status = Sentence::verbatim(cursor.at("status").text());
    if (cursor.holds("support")) {
        module.seen = readWord<2>(cursor.at("support"), {"pictures", "links and gravity"}) == 0;
        if (!module.T_body_module)
            cursor.at("support").fail("expected null: the module has no T_body_module");
    }
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
    patch.status = Sentence::verbatim(cursor.at("status").text());
    return patch;
}

BodyLink readLink(const JsonCursor& cursor) {
    BodyLink link;
    link.link.a = readId(cursor.at("a"));
    link.link.b = readId(cursor.at("b"));
    link.link.a_port = static_cast<int>(cursor.at("a_port").integer(0, kMaxPorts));
    link.link.b_port = static_cast<int>(cursor.at("b_port").integer(0, kMaxPorts));
    link.kind = static_cast<LinkKind>(readWord<2>(cursor.at("kind"), {"adjacent", "cable"}));
    link.reason = Sentence::verbatim(textOr(cursor, "reason", ""));
    link.distance = optionalAt(cursor, "distance", readNumber);
    return link;
}

BodyView readView(const JsonCursor& cursor) {
    BodyView view;
    view.name = cursor.at("name").text();
    view.T_body_camera = optionalAt(cursor, "T_body_camera", readPose);
    view.residual_rms_px = optionalAt(cursor, "residual_rms_px", readNumber);
    view.status = Sentence::verbatim(textOr(cursor, "status", ""));
    for (const JsonCursor& item : cursor.at("observations").array(kMaxModules)) {
        BodyObservation o;
        o.module = readId(item.at("module"));
        o.pixel = optionalAt(item, "pixel", readVector2);
        o.residual = optionalAt(item, "residual", readVector2);
        o.verdict = static_cast<ObservationVerdict>(
            readWord<4>(item.at("verdict"), {"used", "rejected", "not found", "ambiguous"}));
        o.reason = Sentence::verbatim(textOr(item, "reason", ""));
        view.observations.push_back(std::move(o));
    }
    return view;
}

Finding::Kind readKind(const JsonCursor& cursor) {
    std::array<std::string_view, kFindingKinds.size()> words{};
    std::transform(kFindingKinds.begin(), kFindingKinds.end(), words.begin(),
                   [](Finding::Kind kind) { return name(kind); });
    return kFindingKinds.at(readWord(cursor, words));
}

Finding readFinding(const JsonCursor& cursor) {
    Finding finding;
    finding.kind = readKind(cursor.at("kind"));
    if (cursor.holds("modules")) {
        for (const JsonCursor& item : cursor.at("modules").array(kMaxModules))
            finding.modules.push_back(readId(item));
    }
    finding.view = optionalAt(cursor, "view", [](const JsonCursor& c) { return c.text(); });
    finding.pose =
        optionalAt(cursor, "pose", [](const JsonCursor& c) { return static_cast<int>(c.integer(0, kMaxPose)); });
    finding.text = Sentence::verbatim(cursor.at("text").text());
    return finding;
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
        q.warnings = readSentences(cursor.at("warnings"));
    if (cursor.holds("missing"))
        q.missing = readSentences(cursor.at("missing"));
    if (cursor.holds("findings")) {
        for (const JsonCursor& item : cursor.at("findings").array(kMaxTexts))
            q.findings.push_back(readFinding(item));
    }
    if (cursor.holds("verdict"))
        q.trust = static_cast<Trust>(readWord<3>(cursor.at("verdict"), {"good", "usable", "not to be trusted"}));
    return q;
}

/// Files from before the key: what a picture shows that counts rests on pictures.
void completeSupport(const JsonCursor& modules, BodyModel& body) {
    std::set<ModuleId> shown;
    for (const BodyView& view : body.views) {
        for (const BodyObservation& o : view.observations) {
            if (o.verdict == ObservationVerdict::Used)
                shown.insert(o.module);
        }
    }
    const std::vector<JsonCursor> cursors = modules.array(kMaxModules);
    for (std::size_t m = 0; m < body.modules.size(); ++m) {
        BodyModule& module = body.modules[m];
        if (module.T_body_module && !cursors[m].holds("support"))
            module.seen = shown.contains(module.id);
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
        completeSupport(root.at("modules"), body);
        body.quality = readQuality(root.at("quality"));
        body.quality.modulesTotal = body.modules.size();
        body.quality.modulesPlaced = static_cast<std::size_t>(std::count_if(
            body.modules.begin(), body.modules.end(), [](const BodyModule& m) { return m.T_body_module.has_value(); }));
        checkBodyReferences(root, body);
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
