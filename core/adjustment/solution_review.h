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

/// One kind of measurement (priors are one, too) taken together.
struct VarianceComponent {
    double squares = 0;     ///< sum over the kind
    double redundancy = 0;  ///< likewise

    /// By how much the standard deviation assumed is too small (> 1) or too large. Repeated with the new weights it
    /// converges to the restricted maximum likelihood estimate.
    ///   factor^2 = (squares + n (sigma_0 / sigma)^2) / (redundancy + n)
    /// @param n      what is known beforehand counts as so many measurements,
    /// @param ratio  and says sigma_0 / sigma.
    [[nodiscard]] double factor(double n = 0, double ratio = 1) const;
};

struct NoiseComponents {
    VarianceComponent pixel;
    VarianceComponent gravity;
    VarianceComponent link;
    VarianceComponent bias;
    VarianceComponent scale;
    VarianceComponent misalignment;
};

/// A least-squares solution in numbers.
struct SolutionReview {
    std::vector<std::optional<MeasurementReview>> pixels;                ///< per entry of AdjustmentInput::pixels
    std::vector<std::optional<MeasurementReview>> links;                 ///< per entry of AdjustmentInput::links
    std::vector<std::vector<std::optional<MeasurementReview>>> gravity;  ///< [module][reading of GravityTable::of]
    NoiseComponents noise;
    /// Per module (rotation vector in the body frame, then translation; rad, m), relative to the gauge; nothing for
    /// modules that take no part, zero for those of the gauge itself.
    std::vector<std::optional<Matrix6d>> covariances;
};

/// Reviews the solution `state`, in time and memory linear in the size of the body: all covariances that are needed
/// belong to unknowns that some measurement ties together (SelectedInverse).
/// Fails with DegeneratePoints where the data do not fix all unknowns, and with Cancelled.
/// Ref: Baarda, A testing procedure for use in geodetic networks, 1968; Foerstner, ZfV 104, 1979.
[[nodiscard]] tl::expected<SolutionReview, CalibrationError> reviewSolution(const AdjustmentInput& input,
                                                                            const BodyState& state, const Gauge& gauge,
                                                                            const AdjustmentOptions& options,
                                                                            const RunContext& context = {});

}  // namespace skincal
