#pragma once

#include <optional>
#include <vector>

#include "core/adjustment/body_adjustment.h"
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

/// A module whose accelerometer is far noisier than the others.
struct NoisyAccelerometer {
    std::size_t module = 0;
    double sigma = 0;  ///< m/s^2
};

struct PatchShapesResult {
    std::vector<PatchShape> shapes;                        ///< per patch
    std::vector<bool> assumedFlat;                         ///< per module: its rotation is a guess, not measured
    std::vector<AccelerometerCalibration> accelerometers;  ///< per module
    /// Against gravity in each patch's frame, [patch][pose]; nothing where no module of the patch has a reading.
    std::vector<std::vector<std::optional<Vector3d>>> up_o;
    /// Of the bulk of the accelerometers, from the residuals, m/s^2; 0 where there are no more readings than unknowns.
    double accelerometerSigma = 0;
    std::vector<NoisyAccelerometer> noisy;
};

/// Shapes of all patches by least squares over gravity and link points, with bias and scale of each accelerometer
/// estimated from the same poses: loops close, and an uncalibrated sensor costs 0.35 degrees instead of 1.8. The noise
/// is estimated from the residuals and the fit repeated with it; it is the median's, so that one broken sensor spoils
/// only itself. A module without usable readings starts flat beside its neighbour: link points and pixels may turn it,
/// but until something measured holds it (see heldModules) its rotation is a guess. So is the whole shape of a patch
/// without any usable reading. Fails with Cancelled.
[[nodiscard]] tl::expected<PatchShapesResult, CalibrationError> estimatePatchShapes(const Skin& skin,
                                                                                    const SkinLayout& layout,
                                                                                    const GravityTable& gravity,
                                                                                    AdjustmentOptions options = {},
                                                                                    const RunContext& context = {});

/// The port pairs of all links that join neighbours, with their position in the graph.
[[nodiscard]] std::vector<PortPair> adjacentPorts(const Skin& skin, const SkinLayout& layout);

}  // namespace skincal
