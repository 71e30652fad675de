#pragma once

#include <string>
#include <vector>

#include "core/geometry/ids.h"
#include "core/geometry/se3.h"

namespace skincal {

struct TrueModule {
    ModuleId id;
    int patch = 0;
    Isometry3d T_body_module = Isometry3d::Identity();
};

struct TrueView {
    std::string name;
    Isometry3d T_body_camera = Isometry3d::Identity();
};

struct TruePixel {
    std::string view;
    ModuleId module;
    Vector2d pixel = Vector2d::Zero();
};

/// What a simulated world really was; for scoring only, never read by a calibration.
struct Truth {
    std::vector<TrueModule> modules;
    std::vector<TrueView> views;
    std::vector<TruePixel> pixels;  ///< LEDs that the camera could see
};

}  // namespace skincal
