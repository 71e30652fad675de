#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace skincal {

class JsonCursor;

/// Where a camera's intrinsics come from, so that a result can be traced to them.
struct CameraOrigin {
    enum class Kind {
        Unknown,
        File,        ///< of another program
        Calibrated,  ///< here, from views of a board
        Nominal,     ///< what the camera's maker says of it
    };
    Kind kind = Kind::Unknown;
    std::string file{};  ///< its name, of Kind::File
    int boards = 0;      ///< that were used, of Kind::Calibrated
    double rms_px = 0;   ///< of their residuals, likewise
    std::string date{};  ///< on which they were calibrated or chosen, "2026-11-26"

    friend bool operator==(const CameraOrigin&, const CameraOrigin&) = default;
};

/// Throws FileErrorException as all readers do.
[[nodiscard]] CameraOrigin readCameraOrigin(const JsonCursor& cursor);
[[nodiscard]] nlohmann::ordered_json cameraOriginToJson(const CameraOrigin& origin);

}  // namespace skincal
