#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/ids.h"
#include "core/geometry/se3.h"

namespace skincal {

/// Where an LED was found in one view: raw (distorted) pixel and its standard deviation per axis.
struct LedDetection {
    ModuleId module;
    Vector2d pixel = Vector2d::Zero();
    double sigma_px = 0.1;
};

/// What became of a module in a view's picture.
enum class DetectionVerdict { Found, NotFound, Ambiguous };

/// A module that the decoder did not accept, and why ("two spots blink its word", "no spot above the noise", …).
struct Undetected {
    ModuleId module;
    DetectionVerdict verdict = DetectionVerdict::NotFound;
    std::string reason;
};

/// Everything the picture of one view yields.
struct ViewDetections {
    std::string name;
    std::vector<LedDetection> found;
    std::vector<Undetected> undetected;
};

}  // namespace skincal
