#pragma once

/// The problem at its solution as a linear one: shared by what forecasts and what reviews. Not for other rooms.

#include <Eigen/SparseCore>
#include <optional>
#include <unordered_map>
#include <vector>

#include "core/adjustment/adjustment_problem.h"
#include "core/adjustment/selected_inverse.h"

namespace skincal {

/// Rows of one measurement.
struct LinearisedBlock {
    MeasurementKind kind = MeasurementKind::Pixel;
    ResidualOf source;
    Eigen::Index row = 0;
    Eigen::Index size = 0;
    double weight = 1;  ///< what the loss leaves of it, rho'(|r|^2)
};

/// Residuals and their derivatives in tangent coordinates of all unknowns that are free; H = sum_i weight_i J_i^T J_i.
struct Linearisation {
    std::vector<LinearisedBlock> blocks;
    Eigen::VectorXd residuals;
    Eigen::SparseMatrix<double, Eigen::RowMajor> J;
    std::unordered_map<const double*, Eigen::Index> column;  ///< of each free parameter block
    SparseCholesky factor;                                   ///< of H

    /// Columns of a pose, rotation then translation; nothing where it is held or takes no part.
    [[nodiscard]] std::optional<std::array<Eigen::Index, 6>> columnsOf(const PoseBlocks& pose) const;
};

/// Small and dense: a measurement has at most three numbers.
using SmallMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;

/// J C J^T of one measurement, C = H^-1: covariance of what the solution forecasts for it, in its own variances.
[[nodiscard]] SmallMatrix forecastCovariance(const Linearisation& linear, const LinearisedBlock& block,
                                             const SelectedInverse& inverse);

/// The quaternion manifold's tangent is half the rotation vector, applied from the left: q' = exp(delta) q.
inline constexpr double tangentFactor(Eigen::Index axis) {
    return axis % 6 < 3 ? 2.0 : 1.0;
}

/// False where the data do not fix all unknowns, or cancelled.
[[nodiscard]] bool linearise(AdjustmentProblem& problem, const AdjustmentOptions& options, Linearisation& result,
                             const RunContext& context = {});

}  // namespace skincal
