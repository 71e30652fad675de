#include "core/formats/camera_origin.h"

#include <fmt/format.h>

#include <array>

#include "core/formats/json_cursor.h"

namespace skincal {
namespace {

using Kind = CameraOrigin::Kind;

constexpr std::array kNames{std::pair(Kind::File, "file"), std::pair(Kind::Calibrated, "calibrated"),
                            std::pair(Kind::Nominal, "nominal")};
constexpr std::int64_t kMaxBoards = 1'000'000;
constexpr double kMaxRms_px = 1e4;

}  // namespace

CameraOrigin readCameraOrigin(const JsonCursor& cursor) {
    CameraOrigin origin;
    const JsonCursor kind = cursor.at("kind");
    const std::string word = kind.text();
    for (const auto& [of, name] : kNames) {
        if (word == name)
            origin.kind = of;
    }
    if (origin.kind == Kind::Unknown)
        kind.fail(fmt::format("expected \"file\", \"calibrated\" or \"nominal\", found \"{}\"", word));
    if (origin.kind == Kind::File)
        origin.file = cursor.at("file").text();
    if (origin.kind == Kind::Calibrated) {
        origin.boards = static_cast<int>(cursor.at("boards").integer(1, kMaxBoards));
        origin.rms_px = cursor.at("rms_px").number(0, kMaxRms_px);
    }
    if (cursor.holds("date"))
        origin.date = cursor.at("date").text();
    return origin;
}

nlohmann::ordered_json cameraOriginToJson(const CameraOrigin& origin) {
    nlohmann::ordered_json json;
    for (const auto& [of, name] : kNames) {
        if (origin.kind == of)
            json["kind"] = name;
    }
    if (origin.kind == Kind::File)
        json["file"] = origin.file;
    if (origin.kind == Kind::Calibrated) {
        json["boards"] = origin.boards;
        json["rms_px"] = origin.rms_px;
    }
    if (!origin.date.empty())
        json["date"] = origin.date;
    return json;
}

}  // namespace skincal
