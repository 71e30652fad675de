#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/vision/camera_model.h"

namespace skincal {

enum class CameraFileKind {
    Ros,     ///< camera_info YAML, see cameraModelToYaml
    OpenCv,  ///< FileStorage YAML: camera_matrix, distortion_coefficients, fisheye_model
    Kalibr,  ///< camchain YAML of one camera, cam0: pinhole with radtan or equidistant
};

/// A camera as other programs read it; parseCameraModel reads the same camera from it to the same bits, but for a
/// camera without distortion, which may come back with zeros. Nothing where the kind has no room for the lens:
/// Kalibr's radtan ends at k2, and it knows no rational model.
/// @param name  camera_name of ROS, ignored by others
[[nodiscard]] std::optional<std::string> exportCamera(const CameraModel& camera, CameraFileKind kind,
                                                      std::string_view name = "camera");

}  // namespace skincal
