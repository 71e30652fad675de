#pragma once

#include <optional>
#include <vector>

#include "core/estimation/body_adjustment.h"
#include "core/estimation/skin_layout.h"

namespace skincal {

/// The shape of one patch: module poses in the frame of its origin module. Nothing where neither gravity nor a
/// neighbour tells how a module lies.
struct PatchShape {
    std::vector<std::optional<Isometry3d>> T_o_u;  ///< per entry of Patch::modules
};

/// The paper's reconstruction (Algorithm 1): edge rotations from gravity, t = p_c - R p_n, propagated along shortest
/// paths (eq. 2, 5, 7, 8). A module behind an edge whose rotation can't be estimated is left out.
[[nodiscard]] PatchShape chainPatchShape(const Skin& skin, const SkinLayout& layout, const GravityTable& gravity,
                                         const Patch& patch, const RelativeRotationOptions& options = {});

struct PatchShapesResult {
    std::vector<PatchShape> shapes;                        ///< per patch
    std::vector<AccelerometerCalibration> accelerometers;  ///< per module
    /// Against gravity in each patch's frame, [patch][pose].
    std::vector<std::vector<std::optional<Vector3d>>> up_o;
    double accelerometerSigma = 0;  ///< estimated from the residuals, m/s^2; 0 where there are none
};

/// Shapes of all patches by least squares over gravity and link points, with bias and scale of each accelerometer
/// estimated from the same poses: loops close, and an uncalibrated sensor costs 0.35 degrees instead of 1.8.
/// A module without accelerometer readings starts flat beside its neighbour and is held by its links; with fewer than
/// two links it is left out.
[[nodiscard]] tl::expected<PatchShapesResult, CalibrationError> estimatePatchShapes(const Skin& skin,
                                                                                    const SkinLayout& layout,
                                                                                    const GravityTable& gravity,
                                                                                    AdjustmentOptions options = {},
                                                                                    const RunContext& context = {});

/// The port pairs of all links that join neighbours.
[[nodiscard]] std::vector<PortPair> adjacentPorts(const Skin& skin, const SkinLayout& layout);

}  // namespace skincal
