#include "core/formats/recording_parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "core/formats/csv.h"
#include "core/formats/json_cursor.h"
#include "core/formats/template_json.h"

namespace skincal {
namespace {

constexpr std::int64_t kMaxId = 0xFFFFFFFFLL;

using ModuleIndex = std::unordered_map<ModuleId, std::size_t>;

void readTemplates(const JsonCursor& root, Skin& skin) {
    std::set<std::string> names;
    for (const JsonCursor& item : root.at("module_types").array(kMaxTemplates)) {
        skin.templates.push_back(readTemplate(item));
        if (!names.insert(skin.templates.back().name).second)
            item.at("name").fail(fmt::format("expected a name of its own, '{}' is taken", skin.templates.back().name));
    }
}

ModuleIndex readModules(const JsonCursor& root, Skin& skin) {
    std::unordered_map<std::string, std::size_t> types;
    for (std::size_t t = 0; t < skin.templates.size(); ++t)
        types.emplace(skin.templates[t].name, t);
    ModuleIndex index;
    for (const JsonCursor& item : root.at("modules").array(kMaxModules)) {
        const ModuleId id(static_cast<std::uint32_t>(item.at("id").integer(1, kMaxId)));
        const std::string type = item.at("type").text();
        const auto found = types.find(type);
        if (found == types.end())
            item.at("type").fail(fmt::format("expected a name from module_types, found '{}'", type));
        if (!index.emplace(id, skin.modules.size()).second)
            item.at("id").fail(fmt::format("expected an id of its own, {} is taken", id.value));
        skin.modules.push_back({id, found->second, {}});
        if (item.holds("unique_id"))
            skin.modules.back().uniqueId = item.at("unique_id").text();
    }
    return index;
}

ModuleId readModule(const JsonCursor& cursor, const ModuleIndex& index) {
    const ModuleId id(static_cast<std::uint32_t>(cursor.integer(1, kMaxId)));
    if (index.count(id) == 0)
        cursor.fail(fmt::format("expected the id of a module, {} is none", id.value));
    return id;
}

int readPort(const JsonCursor& cursor, ModuleId id, const Skin& skin, const ModuleIndex& index) {
    const ModuleTemplate& type = skin.templateOf(index.at(id));
    const auto port = cursor.integer(INT32_MIN, INT32_MAX);
    if (port < 0 || static_cast<std::size_t>(port) >= type.ports.size())
        cursor.fail(fmt::format("expected a port below {} of '{}', found {}", type.ports.size(), type.name, port));
    return static_cast<int>(port);
}

/// A link is one connection, whichever end reports it.
using Ends = std::pair<std::pair<ModuleId, int>, std::pair<ModuleId, int>>;

Ends endsOf(const Link& link) {
    return std::minmax(std::pair(link.a, link.a_port), std::pair(link.b, link.b_port));
}

void readLinks(const JsonCursor& root, Skin& skin, const ModuleIndex& index) {
    std::map<Ends, LinkKind> kinds;
    for (const JsonCursor& item : root.at("links").array(kMaxLinks)) {
        Link link;
        link.a = readModule(item.at("a"), index);
        link.b = readModule(item.at("b"), index);
        link.a_port = readPort(item.at("a_port"), link.a, skin, index);
        link.b_port = readPort(item.at("b_port"), link.b, skin, index);
        if (item.holds("kind")) {
            const std::string kind = item.at("kind").text();
            if (kind != "adjacent" && kind != "cable")
                item.at("kind").fail(fmt::format("expected \"adjacent\" or \"cable\", found \"{}\"", kind));
            link.decided = kind == "adjacent" ? LinkKind::Adjacent : LinkKind::Cable;
            if (kinds.emplace(endsOf(link), *link.decided).first->second != *link.decided)
                item.at("kind").fail(
                    fmt::format("expected one kind for each link, found \"{}\" where the same link is "
                                "said to be the other above",
                                kind));
        }
        skin.links.push_back(link);
    }
    if (!root.holds("host_links"))
        return;
    for (const JsonCursor& item : root.at("host_links").array(kMaxLinks)) {
        const ModuleId id = readModule(item.at("module"), index);
        skin.hostLinks.push_back({id, readPort(item.at("port"), id, skin, index)});
    }
}

LitModule readLit(const JsonCursor& cursor, const ModuleIndex& index) {
    if (!cursor.json().is_object())
        return {readModule(cursor, index), std::nullopt};
    LitModule lit{readModule(cursor.at("module"), index), std::nullopt};
    if (cursor.holds("colour")) {
        const auto channels = cursor.at("colour").array(3);
        if (channels.size() != 3)
            cursor.at("colour").fail(fmt::format("expected 3 channels, found {}", channels.size()));
        lit.colour.emplace();
        for (std::size_t i = 0; i < 3; ++i)
            lit.colour->at(i) = static_cast<int>(channels[i].integer(0, 1));
    }
    return lit;
}

FrameInfo readFrame(const JsonCursor& cursor, const ModuleIndex& index) {
    FrameInfo frame;
    frame.file = cursor.at("file").text();
    std::unordered_set<ModuleId> seen;
    for (const JsonCursor& item : cursor.at("lit").array(kMaxModules)) {
        frame.lit.push_back(readLit(item, index));
        if (!seen.insert(frame.lit.back().module).second)
            item.fail(fmt::format("expected each module once, {} is listed twice", frame.lit.back().module.value));
    }
    if (cursor.holds("t"))
        frame.time_s = cursor.at("t").number();
    // A key that other readers may pass over.
    if (cursor.holds("look"))
        frame.look = static_cast<std::size_t>(cursor.at("look").integer(0, kMaxLooks));
    return frame;
}

/// detections.csv names views: what its fields can't hold can't be a name.
bool fitsIntoCsv(const std::string& name) {
    const auto breaks = [](char c) { return c == ',' || static_cast<unsigned char>(c) < 0x20 || c == 0x7F; };
    return !name.empty() && std::none_of(name.begin(), name.end(), breaks) && name.front() != ' ' && name.back() != ' ';
}

void readViews(const JsonCursor& root, Recording& recording, const ModuleIndex& index) {
    std::set<std::string> names;
    for (const JsonCursor& item : root.at("views").array(kMaxViews)) {
        RecordedView view;
        view.name = item.at("name").text();
        if (!fitsIntoCsv(view.name))
            item.at("name").fail("expected a name without commas, control characters or blanks at its ends, not empty");
        if (!names.insert(view.name).second)
            item.at("name").fail(fmt::format("expected a name of its own, '{}' is taken", view.name));
        if (item.holds("frames")) {
            for (const JsonCursor& frame : item.at("frames").array(kMaxFramesPerView)) {
                const std::size_t before = view.frames.empty() ? 0 : view.frames.back().look;
                view.frames.push_back(readFrame(frame, index));
                if (view.frames.back().look < before)
                    frame.at("look").fail(fmt::format("expected {} or more, as in the frame before", before));
            }
        }
        recording.views.push_back(std::move(view));
    }
}

/// Weights are 1 / sigma^2: what is tinier or larger than any sensor's noise would swamp all other measurements.
void checkSigma(const CsvReader& csv, double sigma) {
    if (!(sigma > 0))
        csv.fail("sigma", fmt::format("expected a number above 0, found {:g}", sigma));
    if (sigma < kMinSigma || sigma > kMaxSigma)
        csv.fail("sigma", fmt::format("expected a number from {:g} to {:g}, found {:g}", kMinSigma, kMaxSigma, sigma));
}

void readDecisions(const JsonCursor& root, Recording& recording, const ModuleIndex& index) {
    if (!root.holds("decisions"))
        return;
    std::set<std::string> names;
    for (const RecordedView& view : recording.views)
        names.insert(view.name);
    std::map<std::pair<std::string, ModuleId>, std::string> verdicts;
    for (const JsonCursor& item : root.at("decisions").array(kMaxLinks)) {
        Decision decision;
        decision.view = item.at("view").text();
        if (names.count(decision.view) == 0)
            item.at("view").fail(fmt::format("expected the name of a view, '{}' is none", decision.view));
        decision.module = readModule(item.at("module"), index);
        decision.verdict = item.at("verdict").text();
        if (decision.verdict != "accepted" && decision.verdict != "rejected")
            item.at("verdict").fail(
                fmt::format("expected \"accepted\" or \"rejected\", found \"{}\"", decision.verdict));
        const auto& first = verdicts.emplace(std::pair(decision.view, decision.module), decision.verdict).first->second;
        if (first != decision.verdict)
            item.at("verdict").fail(
                fmt::format("expected one verdict for each view and module, module {} in '{}' is "
                            "\"{}\" above and \"{}\" here",
                            decision.module.value, decision.view, first, decision.verdict));
        if (item.holds("reason"))
            decision.reason = item.at("reason").text();
        recording.decisions.push_back(std::move(decision));
    }
}

constexpr std::array<std::string_view, 11> kKeys{"format", "version",    "module_types", "modules",
                                                 "links",  "host_links", "gravity",      "camera",
                                                 "views",  "detections", "decisions"};

}  // namespace

tl::expected<Recording, FileError> parseRecordingJson(std::string_view text, const std::filesystem::path& file,
                                                      Completeness completeness) {
    try {
        const nlohmann::json json = parseJson(text, file);
        const JsonCursor root(json, file);
        const std::string format = root.at("format").text();
        if (format != "skincal-recording")
            root.at("format").fail(fmt::format("expected \"skincal-recording\", found \"{}\"", format));
        const auto version = root.at("version").integer(1, 1'000'000);
        if (version > 1)
            root.at("version").fail(fmt::format(
                "expected version 1, found {}: this recording was written by a newer version of the program", version));
        Recording recording;
        readTemplates(root, recording.skin);
        for (const JsonCursor& type : root.at("module_types").array(kMaxTemplates)) {
            if (auto unknown = unknownTemplateKeys(type); !unknown.empty())
                recording.unknownOfTypes[type.at("name").text()] = std::move(unknown);
        }
        recording.unknown = root.membersBut(kKeys);
        const ModuleIndex index = readModules(root, recording.skin);
        readLinks(root, recording.skin, index);
        const bool isBegun = completeness == Completeness::Begun && root.holds("views") &&
                             root.at("views").array(kMaxViews).empty() && !root.holds("camera");
        if (!isBegun) {
            recording.camera = readCamera(root.at("camera"));
            if (root.at("camera").holds("origin"))
                recording.cameraOrigin = readCameraOrigin(root.at("camera").at("origin"));
        }
        readViews(root, recording, index);
        readDecisions(root, recording, index);
        recording.gravityFile = root.at("gravity").text();
        if (root.holds("detections")) {
            recording.detectionsFile = root.at("detections").text();
            if (recording.detectionsFile.empty())
                root.at("detections").fail("expected a path inside the recording, found ''");
        }
        return recording;
    } catch (const FileErrorException& exception) {
        return tl::unexpected(exception.error);
    }
}

tl::expected<void, FileError> parseGravityCsv(std::string_view text, const std::filesystem::path& file,
                                              Recording& recording) {
    try {
        CsvReader csv(text, file, {"pose", "module", "ax", "ay", "az"});
        const ModuleIndex index = recording.skin.indexById();
        std::set<std::pair<int, ModuleId>> seen;
        while (csv.next()) {
            GravityReading reading;
            reading.pose = static_cast<int>(csv.integer("pose", 0, 1'000'000));
            reading.module = ModuleId(static_cast<std::uint32_t>(csv.integer("module", 1, kMaxId)));
            if (index.count(reading.module) == 0)
                csv.fail("module", fmt::format("expected the id of a module, {} is none", reading.module.value));
            if (!seen.emplace(reading.pose, reading.module).second)
                csv.fail("module", fmt::format("expected one row for each module and pose, pose {} module {} has two",
                                               reading.pose, reading.module.value));
            reading.acceleration = {csv.number("ax"), csv.number("ay"), csv.number("az")};
            if (reading.acceleration.norm() > 1000)
                csv.fail("ax", "expected an acceleration below 1000 m/s^2");
            reading.sigma = csv.optionalNumber("sigma");
            if (reading.sigma)
                checkSigma(csv, *reading.sigma);
            if (const auto samples = csv.optionalNumber("samples")) {
                if (*samples < 1 || *samples > 1e9 || *samples != std::floor(*samples))
                    csv.fail("samples", fmt::format("expected a whole number of at least 1, found {:g}", *samples));
                reading.samples = static_cast<int>(*samples);
            }
            recording.gravity.push_back(reading);
        }
        return {};
    } catch (const FileErrorException& exception) {
        return tl::unexpected(exception.error);
    }
}

tl::expected<void, FileError> parseDetectionsCsv(std::string_view text, const std::filesystem::path& file,
                                                 Recording& recording) {
    try {
        CsvReader csv(text, file, {"view", "module", "x", "y", "sigma"});
        const ModuleIndex index = recording.skin.indexById();
        std::unordered_map<std::string, std::size_t> views;
        for (std::size_t v = 0; v < recording.views.size(); ++v)
            views.emplace(recording.views[v].name, v);
        std::set<std::pair<std::size_t, ModuleId>> seen;
        while (csv.next()) {
            const auto view = views.find(std::string(csv.text("view")));
            if (view == views.end())
                csv.fail("view", fmt::format("expected the name of a view, '{}' is none", csv.text("view")));
            LedDetection detection;
            detection.module = ModuleId(static_cast<std::uint32_t>(csv.integer("module", 1, kMaxId)));
            if (index.count(detection.module) == 0)
                csv.fail("module", fmt::format("expected the id of a module, {} is none", detection.module.value));
            if (!seen.emplace(view->second, detection.module).second)
                csv.fail("module", fmt::format("expected one row for each view and module, {} has two in '{}'",
                                               detection.module.value, view->first));
            detection.pixel = {csv.number("x"), csv.number("y")};
            if (!recording.camera.contains(detection.pixel))
                csv.fail("x", fmt::format("expected a pixel inside the picture of {}x{}, found {:g}, {:g}",
                                          recording.camera.width, recording.camera.height, detection.pixel.x(),
                                          detection.pixel.y()));
            detection.sigma_px = csv.number("sigma");
            checkSigma(csv, detection.sigma_px);
            recording.views[view->second].detections.push_back(detection);
        }
        return {};
    } catch (const FileErrorException& exception) {
        return tl::unexpected(exception.error);
    }
}

}  // namespace skincal
