#pragma once

#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "core/adjustment/body_adjustment.h"

namespace skincal {

/// What the rest of the data thinks of one measurement of n numbers with normalised residual r, Jacobian J and, after
/// the loss, weight w, where C = H^-1 is the covariance of all unknowns and P = J C J^T:
struct MeasurementReview {
    double squares = 0;     ///< w r^T r
    double redundancy = 0;  ///< w (n - w tr P): how many of its numbers the others check, 0 … n
    /// Squared distance from what all the others forecast, in standard deviations of that difference: chi-squared with
    /// n degrees of freedom where the measurement is as good as it claims (Baarda's and Pope's test, leave-one-out).
    ///   r^T (I + (1 - w) P)^-1 (I - w P)^-1 r
    double disagreement = 0;
};

/// By how much the standard deviations assumed for each kind of measurement are too small (> 1) or too large.
struct NoiseFactors {
    double pixel = 1;
    double accelerometer = 1;
    double link = 1;
    double bias = 1;
    double scale = 1;
    double misalignment = 1;
};

struct ReviewOptions {
    /// What is assumed counts as so many measurements of each kind: where few are redundant, it stands.
    double priorMeasurements = 12;

    [[nodiscard]] bool validate() const { return priorMeasurements > 0; }
};

/// A least-squares solution in numbers.
struct SolutionReview {
    std::vector<std::optional<MeasurementReview>> pixels;                ///< per entry of AdjustmentInput::pixels
    std::vector<std::optional<MeasurementReview>> links;                 ///< per entry of AdjustmentInput::links
    std::vector<std::vector<std::optional<MeasurementReview>>> gravity;  ///< [module][reading of GravityTable::of]
    /// Variance components: for the kinds k of measurements (priors are one, too)
    ///   factor_k^2 = sum squares / sum redundancy
    /// Repeated with the new weights it converges to the restricted maximum likelihood estimate.
    NoiseFactors noise;
    /// Per module (rotation vector in the body frame, then translation; rad, m), relative to the gauge; nothing for
    /// modules that take no part, zero for those of the gauge itself.
    std::vector<std::optional<Matrix6d>> covariances;
};

/// Reviews the solution `state`, in time and memory linear in the size of the body: all covariances that are needed
/// belong to unknowns that some measurement ties together (SelectedInverse).
/// Fails with DegeneratePoints where the data do not fix all unknowns.
/// Ref: Baarda, A testing procedure for use in geodetic networks, 1968; Foerstner, ZfV 104, 1979.
[[nodiscard]] tl::expected<SolutionReview, CalibrationError> reviewSolution(const AdjustmentInput& input,
                                                                            const BodyState& state, const Gauge& gauge,
                                                                            const AdjustmentOptions& options,
                                                                            const ReviewOptions& review = {});

}  // namespace skincal
