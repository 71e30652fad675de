#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/camera/camera_controls.h"
#include "core/camera/v4l2_device.h"

namespace skincal {

/// What a camera's controls were before they were locked, and what became of them.
struct ControlLock {
    struct Saved {
        std::uint32_t id = 0;
        std::int32_t value = 0;
    };

    std::vector<ControlState> states;  ///< one for each of CameraControl, in that order
    std::vector<Saved> before;         ///< in the order in which they were changed
};

/// Values that are to be taken rather than those of the moment; each as the camera counts it.
using ControlValues = std::vector<std::pair<CameraControl, std::int32_t>>;

/// Switches automatic exposure, gain, focus and white balance off and keeps the values of the moment (or those given,
/// each brought into the camera's range). What a camera takes without doing it is noticed by reading it back.
[[nodiscard]] ControlLock lockControls(V4l2Device& device, const ControlValues& values = {});

/// Puts back what lockControls changed, last first: values before what decides whether they count.
/// @return whether all of it could be put back. Nothing is left out because something else failed.
bool restoreControls(V4l2Device& device, const ControlLock& lock);

/// Shortest and longest exposure in seconds; nothing where it can't be set.
[[nodiscard]] std::optional<std::pair<double, double>> exposureRange(V4l2Device& device);
[[nodiscard]] std::optional<double> exposure(V4l2Device& device);
/// The nearest that the camera has; automatic exposure should be off. @return whether it was taken
bool setExposure(V4l2Device& device, double seconds);

}  // namespace skincal
