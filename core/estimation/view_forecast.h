#pragma once

#include <optional>
#include <vector>

#include "core/estimation/advice_basis.h"

namespace skincal {

struct ViewLimits {
    double maxAngle = 70 * kDegree;  ///< between an LED's axis and the ray to the camera
    double margin_px = 20;           ///< from the picture's border

    [[nodiscard]] bool validate() const { return maxAngle > 0 && maxAngle <= 90 * kDegree && margin_px >= 0; }
};

/// What pictures do not show of the placed modules.
struct UnseenModules {
    std::vector<std::size_t> unseen;  ///< no view looks at them
    /// Views look at them (two or more) and do not show them: they are covered, behind something that is no part of the
    /// skin, or their LED is broken. No forecast counts on them.
    std::vector<std::size_t> hidden;

    [[nodiscard]] bool isHidden(std::size_t module) const;
};
[[nodiscard]] UnseenModules unseenModules(const AdviceBasis& basis, const ViewLimits& limits);

/// Pixels that a camera at T_r_v would see, one per module; nothing where the LED is turned away, behind, out of the
/// picture or hidden by a board of the body (a disc of its ports' radius).
[[nodiscard]] std::vector<std::optional<Vector2d>> forecastPixels(const AdviceBasis& basis, const Isometry3d& T_r_v,
                                                                  const ViewLimits& limits);

}  // namespace skincal
