#pragma once

#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "core/adjustment/accelerometer.h"
#include "core/adjustment/gravity_table.h"
#include "core/adjustment/measurements.h"
#include "core/geometry/error.h"
#include "core/geometry/run_context.h"

namespace skincal {

/// Everything that one body is described by while it is being estimated. Indexes are positions in Skin::modules and
/// in the list of views; nothing where a pose is unknown: what it belongs to then takes no part.
struct BodyState {
    std::vector<std::optional<Isometry3d>> T_r_u;          ///< per module
    std::vector<std::optional<Isometry3d>> T_r_v;          ///< per view
    std::vector<AccelerometerCalibration> accelerometers;  ///< per module
    /// Unit vector against gravity in the body frame, [group][pose]; see AdjustmentInput::gravityGroup.
    std::vector<std::vector<std::optional<Vector3d>>> up_r;
};

struct PixelObservation {
    std::size_t view = 0;
    std::size_t module = 0;
    Vector2d pixel = Vector2d::Zero();
    double sigma_px = 0.1;
};

struct PortPair {
    std::size_t a = 0;
    std::size_t b = 0;
    Vector3d port_a = Vector3d::Zero();
    Vector3d port_b = Vector3d::Zero();
    std::size_t link = 0;  ///< whose ports these are, in the order of whoever made the pairs
};

/// All detections of known modules, in the order of the views.
[[nodiscard]] std::vector<PixelObservation> flattenDetections(const Measurements& measurements);

struct AdjustmentOptions {
    double accelerometerSigma = 0.03;  ///< m/s^2 per axis, where the reading brings none
    double linkSigma = 0.5e-3;         ///< m, mechanical play of a link point
    double biasSigma = 0.5;            ///< m/s^2, prior
    double scaleSigma = 0.02;          ///< prior
    /// rad, prior on how the accelerometer sits askew on its board; 0 where that is not estimated.
    double misalignmentSigma = 0;
    double gravity = kStandardGravity;  ///< m/s^2 where the readings were taken
    double pixelSigmaFloor_px = 0.03;   ///< no detection is believed better than this
    /// What the standard deviations that come with detections and readings are multiplied with.
    double pixelSigmaFactor = 1;
    double accelerometerSigmaFactor = 1;
    /// Where a residual stops to count in full, in standard deviations (Cauchy); 0 for plain least squares.
    double pixelLoss = 3;
    double gravityLoss = 4;
    double linkLoss = 4;
    /// Up to so many standard deviations every residual counts in full whatever the loss: least squares where nothing
    /// is wrong, and no smooth transition for solvers that start far away.
    double lossBegins = 0;
    bool calibrateAccelerometers = true;
    int maxIterations = 100;
    /// Where the cost changes relatively by less, the solution stands. Where another adjustment follows that starts
    /// from it, more is enough.
    double tolerance = 1e-9;

    [[nodiscard]] bool validate() const;
};

/// The measurements in the form the adjustment wants them.
struct AdjustmentInput {
    const Skin* skin = nullptr;
    const CameraModel* camera = nullptr;  ///< may be null where there are no pixels
    const GravityTable* gravity = nullptr;
    std::vector<PixelObservation> pixels;
    std::vector<PortPair> links;
    /// Modules of one group hung from the same gravity direction in every pose: all of them where the body was posed
    /// as one rigid piece, each patch by itself where its joints moved between poses.
    std::vector<std::size_t> gravityGroup;
    /// How much worse than the others the readings of a pose, those of a module and the detections of a view are; empty
    /// where all are alike.
    std::vector<double> poseNoise{};
    std::vector<double> moduleNoise{};
    std::vector<double> viewNoise{};

    /// Standard deviation that a detection counts with, px per axis.
    [[nodiscard]] double sigmaOf(const PixelObservation& o, const AdjustmentOptions& options) const;
    /// Standard deviation that a reading of module u counts with, m/s^2 per axis.
    [[nodiscard]] double sigmaOf(std::size_t u, const GravityTable::Entry& reading,
                                 const AdjustmentOptions& options) const;
};

struct AdjustmentSummary {
    bool usable = false;
    int iterations = 0;
    double initialCost = 0;
    double finalCost = 0;
    std::size_t residuals = 0;
    std::size_t parameters = 0;
};

struct AdjustmentResult {
    BodyState state;
    AdjustmentSummary summary;
};

/// Poses that keep their value while the rest is estimated. Each connected part of the body needs one.
struct Gauge {
    std::vector<std::size_t> views{};
    std::vector<std::size_t> modules{};
};

/// Least squares over pixels, gravity and link points at once (Ceres, sparse Cholesky):
///   min  sum rho(|z - project(T_r_v^-1 T_r_u led)|^2/s^2) + sum rho(|a - (s g R_r_u^T up + b)|^2/s^2)
///      + sum rho(|T_r_a p_a - T_r_b p_b|^2/s^2) + priors on bias and scale
/// The scale comes from the ports and LED offsets of the modules. Up directions are those that some reading of a placed
/// module tells, and no others.
/// Fails with Cancelled, NotConverged (no usable step), TooFewPoints (nothing of the gauge takes part).
[[nodiscard]] tl::expected<AdjustmentResult, CalibrationError> adjustBody(const AdjustmentInput& input, BodyState start,
                                                                          const Gauge& gauge,
                                                                          const AdjustmentOptions& options = {},
                                                                          const RunContext& context = {});

/// Residual measured minus predicted of one detection, px; nothing where a pose is missing or the LED lies behind.
[[nodiscard]] std::optional<Vector2d> pixelResidual(const AdjustmentInput& input, const BodyState& state,
                                                    const PixelObservation& observation);

/// Residuals of all calibrated readings of module u whose pose has an up direction, m/s^2:
///   a - (s M g R_r_u^T up + b)
[[nodiscard]] std::vector<Vector3d> gravityResiduals(const AdjustmentInput& input, const BodyState& state,
                                                     std::size_t module, double gravity = kStandardGravity);

/// Up directions that fit the accelerometers best, given module rotations and calibrations: fills state.up_r.
void estimateUpDirections(const AdjustmentInput& input, BodyState& state);

}  // namespace skincal
