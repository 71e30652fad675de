#pragma once

#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "core/adjustment/body_adjustment.h"

namespace skincal {

/// How well a body is known in itself, wherever it stands: what is left of the errors of all module positions p_u
/// after the body was fitted onto the true one, rigidly and without scale (as compareBodies does), to first order.
///   C' = (I - P) C (I - P)^T,  P = G (G^T G)^-1 G^T,  rows of G for module u: [ I, -skew(p_u - mean p) ]
/// The same whatever view or module the gauge holds: how far away the first camera stood is no property of the body.
/// Ref: Baarda, S-transformations and criterion matrices, 1973.
struct BodyPrecision {
    /// Per module, covariance of its position, axes of the body frame, m^2; nothing where it takes no part.
    std::vector<std::optional<Matrix3d>> positions;
    /// Relative standard deviation of the body's size: of the scale of the similarity that fits it onto the true one,
    ///   s = sum_u (p_u - mean p) . dp_u / sum_u |p_u - mean p|^2;  0 where fewer than two modules take part.
    double scale = 0;
    /// Per module, the part of its sigma that is the body's size, m: scale |p_u - mean p|.
    std::vector<double> size;

    /// Root mean square distance of module u from where it should be, m; 0 where it takes no part.
    [[nodiscard]] double sigma(std::size_t u) const;
    /// The module with the largest sigma, the first of equals; nothing where none takes part.
    [[nodiscard]] std::optional<std::size_t> worst() const;
    [[nodiscard]] double worstSigma() const;  ///< m
    [[nodiscard]] double rmsSigma() const;    ///< over the modules that take part, m
};

/// Precision of the solution `state` under these measurements, which may hold forecast ones. One factorisation, one
/// selected inversion and seven solves: time linear in the size of the body.
/// Fails with DegeneratePoints where the data do not fix all unknowns, or nothing of the gauge takes part.
[[nodiscard]] tl::expected<BodyPrecision, CalibrationError> bodyPrecision(const AdjustmentInput& input,
                                                                          const BodyState& state, const Gauge& gauge,
                                                                          const AdjustmentOptions& options);

}  // namespace skincal
