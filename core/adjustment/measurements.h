#pragma once

#include <string>
#include <vector>

#include "core/skin/skin.h"
#include "core/vision/camera_model.h"
#include "core/vision/detection.h"

namespace skincal {

/// All that a calibration is computed from, once the pictures have been decoded. Nothing in it is computed from
/// anything else in it.
struct Measurements {
    Skin skin;
    std::vector<GravityReading> gravity;
    CameraModel camera;
    std::vector<ViewDetections> views;
};

}  // namespace skincal
