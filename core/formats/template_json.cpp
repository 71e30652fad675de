#include "core/formats/template_json.h"

#include <fmt/format.h>

#include <array>

#include "core/formats/files.h"
#include "core/formats/recording_parse.h"

namespace skincal {
namespace {

/// No board is larger than this, m; a file in millimetres is found out by it.
constexpr double kMaxModuleSize = 1.0;

Vector3d readPosition(const JsonCursor& cursor) {
    const Vector3d p = cursor.vector3();
    if (p.cwiseAbs().maxCoeff() > kMaxModuleSize)
        cursor.fail(fmt::format("expected a position within {} m of the module's origin (metres, not millimetres)",
                                kMaxModuleSize));
    return p;
}

/// m^2, positive where the corners run counter-clockwise.
double signedArea(const std::vector<Vector2d>& outline) {
    double twice = 0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const Vector2d& p = outline[i];
        const Vector2d& q = outline[(i + 1) % outline.size()];
        twice += p.x() * q.y() - p.y() * q.x();
    }
    return 0.5 * twice;
}

nlohmann::ordered_json toJson(const Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}

}  // namespace

tl::expected<ModuleTemplate, FileError> readTemplateFile(const std::filesystem::path& file) {
    constexpr std::size_t kMostBytes = 1 << 20;
    const auto text = readFile(file, kMostBytes);
    if (!text)
        return tl::unexpected(text.error());
    try {
        const nlohmann::json json = parseJson(*text, file);
        return readTemplate(JsonCursor(json, file));
    } catch (const FileErrorException& error) {
        return tl::unexpected(error.error);
    }
}

ModuleTemplate readTemplate(const JsonCursor& cursor) {
    ModuleTemplate type;
    type.name = cursor.at("name").text();
    if (type.name.empty())
        cursor.at("name").fail("expected a name, found an empty string");
    const auto outline = cursor.at("outline").array(10'000);
    if (outline.size() < 3)
        cursor.at("outline").fail(fmt::format("expected at least 3 points, found {}", outline.size()));
    for (const JsonCursor& point : outline) {
        const Vector2d p = point.vector2();
        if (p.cwiseAbs().maxCoeff() > kMaxModuleSize)
            point.fail(fmt::format("expected a point within {} m of the module's origin", kMaxModuleSize));
        type.outline.push_back(p);
    }
    // Also of a board no larger than a grain of sand.
    constexpr double kMinArea = 1e-9;
    if (const double area = signedArea(type.outline); area < kMinArea)
        cursor.at("outline").fail(area > -kMinArea ? "expected an outline that encloses an area"
                                                   : "expected the outline counter-clockwise, it is clockwise");
    type.led = readPosition(cursor.at("led"));
    for (const JsonCursor& port : cursor.at("ports").array(kMaxPorts))
        type.ports.push_back(readPosition(port));
    if (cursor.holds("accelerometer"))
        type.accelerometer = readPosition(cursor.at("accelerometer"));
    if (cursor.holds("sensors")) {
        for (const JsonCursor& sensor : cursor.at("sensors").array(10'000))
            type.sensors.push_back({sensor.at("kind").text(), readPosition(sensor.at("position"))});
    }
    return type;
}

nlohmann::ordered_json templateToJson(const ModuleTemplate& type) {
    nlohmann::ordered_json json;
    json["name"] = type.name;
    json["outline"] = nlohmann::ordered_json::array();
    for (const Vector2d& p : type.outline)
        json["outline"].push_back({p.x(), p.y()});
    json["led"] = toJson(type.led);
    json["ports"] = nlohmann::ordered_json::array();
    for (const Vector3d& port : type.ports)
        json["ports"].push_back(toJson(port));
    if (type.accelerometer)
        json["accelerometer"] = toJson(*type.accelerometer);
    if (!type.sensors.empty()) {
        json["sensors"] = nlohmann::ordered_json::array();
        for (const SensorSite& sensor : type.sensors) {
            nlohmann::ordered_json entry;
            entry["kind"] = sensor.kind;
            entry["position"] = toJson(sensor.position);
            json["sensors"].push_back(std::move(entry));
        }
    }
    return json;
}

std::map<std::string, std::string> unknownTemplateKeys(const JsonCursor& cursor) {
    static constexpr std::array<std::string_view, 6> kKeys{"name",  "outline",       "led",
                                                           "ports", "accelerometer", "sensors"};
    return cursor.membersBut(kKeys);
}

void addKeys(nlohmann::ordered_json& json, const std::map<std::string, std::string>& keys) {
    for (const auto& [key, text] : keys)
        json[key] = nlohmann::ordered_json::parse(text);
}

CameraModel readCamera(const JsonCursor& cursor) {
    CameraModel camera;
    const std::string model = cursor.at("model").text();
    if (model != "pinhole")
        cursor.at("model").fail(fmt::format("expected \"pinhole\", found \"{}\"", model));
    camera.width = static_cast<int>(cursor.at("width").integer(1, kMaxImageSide));
    camera.height = static_cast<int>(cursor.at("height").integer(1, kMaxImageSide));
    if (static_cast<double>(camera.width) * camera.height > kMaxImagePixels)
        cursor.at("height").fail(fmt::format("expected a picture of at most {:g} megapixels, found {}x{}",
                                             kMaxImagePixels / 1e6, camera.width, camera.height));
    camera.fx = cursor.at("fx").number(kMinFocalShare * camera.width, kMaxFocalShare * camera.width);
    camera.fy = cursor.at("fy").number(kMinFocalShare * camera.width, kMaxFocalShare * camera.width);
    camera.cx = cursor.at("cx").number(-1e5, 1e5);
    camera.cy = cursor.at("cy").number(-1e5, 1e5);
    const JsonCursor nameCursor = cursor.at("distortion_model");
    const auto distortion = distortionModelFromName(nameCursor.text());
    if (!distortion)
        nameCursor.fail(fmt::format("expected \"plumb_bob\", \"rational_polynomial\" or \"equidistant\", found \"{}\"",
                                    nameCursor.text()));
    camera.distortionModel = *distortion;
    const std::size_t needed = coefficientCount(*distortion);
    for (const JsonCursor& coefficient : cursor.at("distortion").array(64))
        camera.distortion.push_back(coefficient.number(-1e4, 1e4));
    if (camera.distortion.size() != needed)
        cursor.at("distortion")
            .fail(fmt::format("expected {} coefficients of {}, found {}", needed, name(*distortion),
                              camera.distortion.size()));
    return camera;
}

nlohmann::ordered_json cameraToJson(const CameraModel& camera) {
    nlohmann::ordered_json json;
    json["model"] = "pinhole";
    json["width"] = camera.width;
    json["height"] = camera.height;
    json["fx"] = camera.fx;
    json["fy"] = camera.fy;
    json["cx"] = camera.cx;
    json["cy"] = camera.cy;
    json["distortion_model"] = std::string(name(camera.distortionModel));
    json["distortion"] = camera.distortion;
    if (camera.distortion.empty())
        json["distortion"] = std::vector<double>(coefficientCount(camera.distortionModel), 0.0);
    return json;
}

}  // namespace skincal
