#pragma once

#include <span>
#include <vector>

#include "core/adjustment/body_adjustment.h"

namespace skincal {

/// Unit vectors spread evenly over the sphere (Fibonacci's lattice), the same for the same count.
[[nodiscard]] std::vector<Vector3d> evenDirections(std::size_t count);

/// How well gravity alone tells how a module lies against the others of its body: covariance (rad^2, module frame) of
/// the rotation w in
///   a_p = scale * (exp(w) g up_p) + bias + noise,  up_p known from all modules together,
/// with bias and scale estimated on the way from their priors. One radian where nothing is told about an axis: what
/// directions tell merely because they are noisy does not count.
/// @param up_u   against gravity in the module frame, one per reading.
/// @param sigma  of the readings, m/s^2 per axis.
[[nodiscard]] Matrix3d gravityRotationCovariance(std::span<const Vector3d> up_u, double sigma,
                                                 const AdjustmentOptions& weights);

/// Against gravity in the module frame from the calibrated readings of module u, which points where it should.
[[nodiscard]] std::vector<Vector3d> upDirectionsOf(const AdjustmentInput& input, const BodyState& state, std::size_t u);

/// Standard deviation that the readings of module u count with, m/s^2 per axis: the typical one; where it has none,
/// that of all modules.
[[nodiscard]] double typicalSigma(const AdjustmentInput& input, std::size_t u, const AdjustmentOptions& weights);

/// The largest angle between two lines of gravity, rad, 0 to 90 degrees: upside down is no other line, for a turn about
/// it shows in neither pose.
[[nodiscard]] double largestTilt(std::span<const Vector3d> up);

}  // namespace skincal
