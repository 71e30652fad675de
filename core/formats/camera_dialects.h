#pragma once

#include <string>

#include "core/formats/json_cursor.h"
#include "core/vision/camera_model.h"

namespace skincal {

/// The camera in the tree of a ROS, OpenCV or Kalibr file, as camera_file.h tells. Throws FileErrorException.
[[nodiscard]] CameraModel cameraOfTree(const JsonCursor& root, const std::string& camera);

}  // namespace skincal
