#include <fmt/format.h>

#include <stdexcept>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "core/formats/files.h"
#include "core/formats/recording.h"
#include "core/formats/recording_bytes.h"
#include "core/formats/template_json.h"

namespace skincal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json frameToJson(const FrameInfo& frame) {
    Json json;
    json["file"] = frame.file;
    json["lit"] = Json::array();
    for (const LitModule& lit : frame.lit) {
        if (lit.colour) {
            Json entry;
            entry["module"] = lit.module.value;
            entry["colour"] = *lit.colour;
            json["lit"].push_back(std::move(entry));
        } else {
            json["lit"].push_back(lit.module.value);
        }
    }
    if (frame.time_s)
        json["t"] = *frame.time_s;
    if (frame.look > 0)
        json["look"] = frame.look;
    return json;
}

Json skinToJson(const Recording& recording) {
    const Skin& skin = recording.skin;
    Json json;
    json["format"] = "skincal-recording";
    json["version"] = 1;
    json["module_types"] = Json::array();
    for (const ModuleTemplate& type : skin.templates) {
        json["module_types"].push_back(templateToJson(type));
        if (const auto unknown = recording.unknownOfTypes.find(type.name); unknown != recording.unknownOfTypes.end())
            addKeys(json["module_types"].back(), unknown->second);
    }
    json["modules"] = Json::array();
    for (const SkinModule& module : skin.modules) {
        json["modules"].push_back({{"id", module.id.value}, {"type", skin.templates[module.type].name}});
        if (!module.uniqueId.empty())
            json["modules"].back()["unique_id"] = module.uniqueId;
    }
    json["links"] = Json::array();
    for (const Link& link : skin.links) {
        Json entry;
        entry["a"] = link.a.value;
        entry["a_port"] = link.a_port;
        entry["b"] = link.b.value;
        entry["b_port"] = link.b_port;
        if (link.decided)
            entry["kind"] = *link.decided == LinkKind::Adjacent ? "adjacent" : "cable";
        json["links"].push_back(std::move(entry));
    }
    if (!skin.hostLinks.empty()) {
        json["host_links"] = Json::array();
        for (const HostLink& link : skin.hostLinks)
            json["host_links"].push_back({{"module", link.module.value}, {"port", link.port}});
    }
    return json;
}

std::string gravityToCsv(const std::vector<GravityReading>& gravity) {
    const bool extended =
        std::any_of(gravity.begin(), gravity.end(), [](const GravityReading& r) { return r.sigma || r.samples; });
    std::string csv = extended ? "pose,module,ax,ay,az,sigma,samples\n" : "pose,module,ax,ay,az\n";
    for (const GravityReading& r : gravity) {
        csv += fmt::format("{},{},{},{},{}", r.pose, r.module.value, r.acceleration.x(), r.acceleration.y(),
                           r.acceleration.z());
        if (extended)
            csv += fmt::format(",{},{}", r.sigma ? fmt::format("{}", *r.sigma) : "",
                               r.samples ? fmt::format("{}", *r.samples) : "");
        csv += '\n';
    }
    return csv;
}

}  // namespace

RecordingTexts textsOf(const Recording& recording) {
    Json json = skinToJson(recording);
    json["gravity"] = "gravity.csv";
    if (recording.camera.width > 0) {
        json["camera"] = cameraToJson(recording.camera);
        if (recording.cameraOrigin.kind != CameraOrigin::Kind::Unknown)
            json["camera"]["origin"] = cameraOriginToJson(recording.cameraOrigin);
    } else if (!recording.views.empty())
        throw std::logic_error("a recording with views needs a camera");
    json["views"] = Json::array();
    std::string detections = "view,module,x,y,sigma\n";
    bool anyDetection = false;
    for (const RecordedView& view : recording.views) {
        Json entry;
        entry["name"] = view.name;
        if (!view.frames.empty()) {
            entry["frames"] = Json::array();
            for (const FrameInfo& frame : view.frames)
                entry["frames"].push_back(frameToJson(frame));
        }
        json["views"].push_back(std::move(entry));
        for (const LedDetection& d : view.detections) {
            anyDetection = true;
            detections +=
                fmt::format("{},{},{},{},{}\n", view.name, d.module.value, d.pixel.x(), d.pixel.y(), d.sigma_px);
        }
    }
    if (anyDetection)
        json["detections"] = "detections.csv";
    if (!recording.decisions.empty()) {
        json["decisions"] = Json::array();
        for (const Decision& d : recording.decisions)
            json["decisions"].push_back(
                {{"view", d.view}, {"module", d.module.value}, {"verdict", d.verdict}, {"reason", d.reason}});
    }

    addKeys(json, recording.unknown);
    RecordingTexts texts{{"gravity.csv", gravityToCsv(recording.gravity)}};
    if (anyDetection)
        texts.emplace_back("detections.csv", std::move(detections));
    texts.emplace_back("recording.json", json.dump(1) + "\n");
    return texts;
}

std::string pngOf(const cv::Mat& picture) {
    std::vector<unsigned char> bytes;
    // Level 1: noise does not compress, and writing is what a simulated scan spends its time on.
    if (!cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1}))
        return {};
    return {bytes.begin(), bytes.end()};
}

tl::expected<void, FileError> writeRecording(const Recording& recording, const fs::path& directory, bool overwrite) {
    std::error_code error;
    if (!overwrite && fs::exists(directory / "recording.json", error))
        return tl::unexpected(FileError{directory, "", "there is a recording already"});
    fs::create_directories(directory, error);
    if (error)
        return tl::unexpected(FileError{directory, "", "can't make the directory: " + error.message()});
    for (const auto& [file, text] : textsOf(recording)) {
        if (auto result = writeFileAtomically(directory / file, text); !result)
            return result;
    }
    return {};
}

tl::expected<void, FileError> writeFrame(const fs::path& directory, const std::string& file, const cv::Mat& picture) {
    const fs::path path = directory / file;
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    const std::string bytes = error ? std::string() : pngOf(picture);
    if (bytes.empty())
        return tl::unexpected(FileError{path, "", "can't write the picture"});
    return writeFileAtomically(path, bytes);
}

}  // namespace skincal
