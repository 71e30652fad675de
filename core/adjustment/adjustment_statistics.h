#pragma once

#include <Eigen/Core>
#include <tl/expected.hpp>
#include <vector>

#include "core/adjustment/body_adjustment.h"

namespace skincal {

/// Cramer-Rao bound at `truth`: covariance (rotation vector in the body frame, then translation; rad, m) of the poses
/// of the given views, in the order given, as one matrix. Plain least squares, same gauge rules as adjustBody.
/// Fails with DegeneratePoints where the data do not fix all unknowns.
[[nodiscard]] tl::expected<Eigen::MatrixXd, CalibrationError> viewPoseBound(const AdjustmentInput& input,
                                                                            const BodyState& truth,
                                                                            const std::vector<std::size_t>& views,
                                                                            const Gauge& gauge,
                                                                            AdjustmentOptions options = {});

/// The same for modules.
[[nodiscard]] tl::expected<Eigen::MatrixXd, CalibrationError> modulePoseBound(const AdjustmentInput& input,
                                                                              const BodyState& truth,
                                                                              const std::vector<std::size_t>& modules,
                                                                              const Gauge& gauge,
                                                                              AdjustmentOptions options = {});

/// By how much the standard deviations assumed for each kind of measurement are too small (> 1) or too large.
struct NoiseFactors {
    double pixel = 1;
    double accelerometer = 1;
    double link = 1;
    double bias = 1;
    double scale = 1;
};

struct NoiseEstimateOptions {
    int probes = 16;  ///< random vectors that estimate the redundancies
    /// What is assumed counts as so many measurements of each kind: where few are redundant, it stands.
    double priorMeasurements = 12;

    [[nodiscard]] bool validate() const { return probes > 0 && priorMeasurements > 0; }
};

/// Variance component estimation at a least-squares solution: for the kinds k of measurements (priors are one, too)
///   factor_k^2 = r_k^T r_k / (n_k - tr(J_k H^-1 J_k^T)),  H = sum_k J_k^T J_k
/// with normalised residuals r_k. Repeated with the new weights it converges to the restricted maximum likelihood
/// estimate. The traces come from random signs (Hutchinson), one sparse factorisation serves all; deterministic.
/// Fails with DegeneratePoints where the data do not fix all unknowns.
/// Ref: Foerstner, ZfV 104, 1979; Hutchinson, Comm. Stat. 19, 1990.
[[nodiscard]] tl::expected<NoiseFactors, CalibrationError> estimateNoise(const AdjustmentInput& input,
                                                                         const BodyState& state, const Gauge& gauge,
                                                                         const AdjustmentOptions& options,
                                                                         const NoiseEstimateOptions& noise = {});

/// Covariance of every module that takes part (rotation vector in the body frame, then translation; rad, m), relative
/// to the gauge; nothing for the others, zero for those of the gauge itself. Linear in the size of the body. Fails with
/// DegeneratePoints where the data do not fix all unknowns.
[[nodiscard]] tl::expected<std::vector<std::optional<Matrix6d>>, CalibrationError> moduleCovariances(
    const AdjustmentInput& input, const BodyState& state, const Gauge& gauge, const AdjustmentOptions& options);

}  // namespace skincal
