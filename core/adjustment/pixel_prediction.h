#pragma once

#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "core/adjustment/body_adjustment.h"

namespace skincal {

/// A module's LED in a view's picture.
struct LedInView {
    std::size_t view = 0;
    std::size_t module = 0;
};

/// Where an LED must appear, and how exactly the rest of the data tells.
struct PixelPrediction {
    Vector2d pixel = Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< px^2, without the noise of any detection
};

/// The pixels that the solution `state` of these measurements has for LEDs, whether they were detected or not:
///   z = project(T_r_v^-1 T_r_u led),  cov z = J C J^T,  C = H^-1 over the poses of view and module together
/// One factorisation and one selected inversion for all of them: time linear in the size of the body. In the order
/// asked for; nothing where a pose is missing, nothing was measured of one of the two, or the LED does not project.
/// Fails with DegeneratePoints where the data do not fix all unknowns, and with Cancelled.
/// @throws std::logic_error where a view or module is out of range.
[[nodiscard]] tl::expected<std::vector<std::optional<PixelPrediction>>, CalibrationError> predictPixels(
    const AdjustmentInput& input, const BodyState& state, const Gauge& gauge, const AdjustmentOptions& options,
    const std::vector<LedInView>& leds, const RunContext& context = {});

}  // namespace skincal
