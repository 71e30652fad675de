#pragma once

#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "core/adjustment/body_adjustment.h"
#include "core/adjustment/measurements.h"
#include "core/geometry/error.h"
#include "core/geometry/run_context.h"
#include "core/simulation/truth.h"
#include "core/simulation/world.h"

namespace skincal {

/// True standard deviations.
struct TrueNoise {
    double pixelFactor = 1;        ///< of the pixels, in units of what each detection says of itself
    double accelerometer = 0.03;   ///< m/s^2 per axis and reading
    double bias = 0.3;             ///< m/s^2 per axis
    double scale = 0.01;           ///< per axis
    double playPosition = 0.3e-3;  ///< of a module in its mould, m per axis
    double playTilt = 0.01;        ///< rad per axis
};

/// What no calibration may know.
struct KnownTruth {
    std::vector<Isometry3d> T_r_u;  ///< per module
    std::vector<Isometry3d> T_r_v;  ///< per view
    std::vector<bool> isCable;      ///< per entry of Skin::links
    TrueNoise noise;
    double falseBeyond_px = 2;  ///< detections farther than this from where they belong are false
};

/// Everything about a simulated world. Detections are false beyond six standard deviations.
[[nodiscard]] KnownTruth knownTruth(const World& world);

/// The truth that came with a recording: views in the recording's order, links between patches are cables. The pixels'
/// noise is that of the true detections, the rest of `noise` is taken over.
/// Throws std::logic_error where modules or views have no truth.
[[nodiscard]] KnownTruth knownTruth(const Truth& truth, const Measurements& measurements, const TrueNoise& noise);

struct TruthEstimate {
    /// Poses in the true body's frame as far as the gauge, the first used view's true pose, tells. Nothing where the
    /// data leave a pose open: modules whose position they tell no better than to the module's own size, views of fewer
    /// than four true detections (their own pose takes up all that these tell).
    BodyState state;
    std::vector<std::optional<Matrix6d>> covariances;  ///< per module, as from reviewSolution
};

/// The best that could be expected of an estimate: plain least squares (maximum a posteriori) over the same
/// measurements, started at the truth, with the true standard deviations, without the false detections and with the
/// true cables. What an estimate from the data alone lacks to it is what it did not find out, rather than noise.
/// Where the data fall apart into bodies of which each could be anywhere, the one with most modules.
/// Fails with Cancelled, NotConverged, TooFewPoints (no view shows enough) or DegeneratePoints (the data do not fix all
/// unknowns).
[[nodiscard]] tl::expected<TruthEstimate, CalibrationError> estimateFromTruth(const Measurements& measurements,
                                                                              const KnownTruth& truth,
                                                                              const RunContext& context = {});

}  // namespace skincal
