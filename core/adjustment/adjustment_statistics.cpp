#include "core/adjustment/adjustment_statistics.h"

#include <ceres/ceres.h>

#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "core/adjustment/adjustment_problem.h"
#include "core/adjustment/selected_inverse.h"
#include "core/geometry/random.h"

namespace skincal {
namespace {

tl::expected<Eigen::MatrixXd, CalibrationError> poseBound(const AdjustmentInput& input, const BodyState& truth,
                                                          const std::vector<std::size_t>& which, bool ofViews,
                                                          const Gauge& gauge, AdjustmentOptions options) {
    options.pixelLoss = options.gravityLoss = options.linkLoss = 0;
    AdjustmentProblem::requireConsistent(input, truth, options);
    const BodyState state = AdjustmentProblem::withUpDirections(input, truth);
    AdjustmentProblem problem(input, state, options);
    const tl::unexpected<CalibrationError> degenerate(CalibrationError{ErrorCode::DegeneratePoints, {}});
    if (!problem.fix(gauge))
        return degenerate;

    std::vector<const double*> blocks;
    for (const std::size_t i : which) {
        PoseBlocks& pose = ofViews ? problem.view(i) : problem.module(i);
        if (!problem.ceres().HasParameterBlock(pose.q.data()) || !problem.ceres().HasParameterBlock(pose.t.data()))
            return degenerate;  // nothing was measured of it
        blocks.push_back(pose.q.data());
        blocks.push_back(pose.t.data());
    }
    ceres::Covariance::Options covarianceOptions;
    covarianceOptions.algorithm_type = ceres::SPARSE_QR;
    ceres::Covariance covariance(covarianceOptions);
    if (!covariance.Compute(blocks, &problem.ceres()))
        return degenerate;
    const auto size = static_cast<Eigen::Index>(3 * blocks.size());
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> bound(size, size);
    if (!covariance.GetCovarianceMatrixInTangentSpace(blocks, bound.data()))
        return degenerate;
    // The quaternion manifold's tangent is half the rotation vector, applied from the left: q' = exp(delta) q.
    for (std::size_t i = 0; i < which.size(); ++i) {
        bound.middleRows<3>(static_cast<Eigen::Index>(6 * i)) *= 2;
        bound.middleCols<3>(static_cast<Eigen::Index>(6 * i)) *= 2;
    }
    return Eigen::MatrixXd(bound);
}

using Sparse = Eigen::SparseMatrix<double>;

/// The problem linearised at its state, in tangent coordinates of all unknowns that are free.
struct Linearised {
    Eigen::VectorXd residuals;
    Sparse J;
    std::array<Eigen::Index, kMeasurementKinds.size() + 1> firstOfKind{};  ///< rows
    std::unordered_map<const double*, Eigen::Index> column;                ///< of each free parameter block
    SparseCholesky factor;                                                 ///< of J^T J
};

/// False where the data do not fix all unknowns.
bool linearise(AdjustmentProblem& problem, Linearised& result) {
    ceres::Problem::EvaluateOptions evaluate;
    // Weighted as the losses have it: what counts less tells less about the noise, too.
    evaluate.apply_loss_function = true;
    // Columns in the order in which the residuals first need them: Ceres lists its blocks by address, which would round
    // the same sums differently from run to run.
    Eigen::Index columns = 0;
    std::vector<double*> blocks;
    const auto addColumns = [&](ceres::ResidualBlockId id) {
        problem.ceres().GetParameterBlocksForResidualBlock(id, &blocks);
        for (double* block : blocks) {
            if (problem.ceres().IsParameterBlockConstant(block) || !result.column.emplace(block, columns).second)
                continue;
            evaluate.parameter_blocks.push_back(block);
            columns += problem.ceres().ParameterBlockTangentSize(block);
        }
    };
    Eigen::Index rows = 0;
    for (std::size_t k = 0; k < kMeasurementKinds.size(); ++k) {
        result.firstOfKind.at(k) = rows;
        for (const ceres::ResidualBlockId id : problem.residuals(kMeasurementKinds.at(k))) {
            evaluate.residual_blocks.push_back(id);
            addColumns(id);
            rows += problem.ceres().GetCostFunctionForResidualBlock(id)->num_residuals();
        }
    }
    result.firstOfKind.back() = rows;
    std::vector<double> residuals;
    ceres::CRSMatrix crs;
    if (!problem.ceres().Evaluate(evaluate, nullptr, &residuals, nullptr, &crs))
        return false;
    result.residuals = Eigen::Map<const Eigen::VectorXd>(residuals.data(), static_cast<Eigen::Index>(residuals.size()));
    result.J = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
        crs.num_rows, crs.num_cols, static_cast<Eigen::Index>(crs.values.size()), crs.rows.data(), crs.cols.data(),
        crs.values.data());
    const Sparse H = result.J.transpose() * result.J;
    result.factor.compute(H);
    return result.factor.info() == Eigen::Success;
}

}  // namespace

tl::expected<Eigen::MatrixXd, CalibrationError> viewPoseBound(const AdjustmentInput& input, const BodyState& truth,
                                                              const std::vector<std::size_t>& views, const Gauge& gauge,
                                                              AdjustmentOptions options) {
    return poseBound(input, truth, views, true, gauge, options);
}

tl::expected<Eigen::MatrixXd, CalibrationError> modulePoseBound(const AdjustmentInput& input, const BodyState& truth,
                                                                const std::vector<std::size_t>& modules,
                                                                const Gauge& gauge, AdjustmentOptions options) {
    return poseBound(input, truth, modules, false, gauge, options);
}

tl::expected<NoiseFactors, CalibrationError> estimateNoise(const AdjustmentInput& input, const BodyState& state,
                                                           const Gauge& gauge, const AdjustmentOptions& options,
                                                           const NoiseEstimateOptions& noise) {
    if (!noise.validate())
        throw std::logic_error("NoiseEstimateOptions out of range");
    AdjustmentProblem::requireConsistent(input, state, options);
    const BodyState complete = AdjustmentProblem::withUpDirections(input, state);
    AdjustmentProblem problem(input, complete, options);
    Linearised linear;
    if (!problem.fix(gauge) || !linearise(problem, linear))
        return tl::unexpected(CalibrationError{ErrorCode::DegeneratePoints, {}});

    constexpr std::size_t kKinds = kMeasurementKinds.size();
    std::array<double, kKinds> trace{};
    Random random(linear.J.rows(), "noise probes");
    for (int probe = 0; probe < noise.probes; ++probe) {
        Eigen::VectorXd signs(linear.J.rows());
        for (double& sign : signs)
            sign = (random.bits() & 1U) != 0 ? 1 : -1;
        for (std::size_t k = 0; k < kKinds; ++k) {
            const Eigen::Index first = linear.firstOfKind.at(k);
            const Eigen::Index count = linear.firstOfKind.at(k + 1) - first;
            if (count == 0)
                continue;
            Eigen::VectorXd own = Eigen::VectorXd::Zero(signs.size());
            own.segment(first, count) = signs.segment(first, count);
            const Eigen::VectorXd b = linear.J.transpose() * own;
            trace.at(k) += b.dot(linear.factor.solve(b)) / noise.probes;
        }
    }
    std::array<double, kKinds> factor{};
    for (std::size_t k = 0; k < kKinds; ++k) {
        const Eigen::Index first = linear.firstOfKind.at(k);
        const Eigen::Index count = linear.firstOfKind.at(k + 1) - first;
        const double redundancy = std::max(0.0, static_cast<double>(count) - trace.at(k));
        const double squares = linear.residuals.segment(first, count).squaredNorm();
        factor.at(k) = std::sqrt((squares + noise.priorMeasurements) / (redundancy + noise.priorMeasurements));
    }
    return NoiseFactors{factor[0], factor[1], factor[2], factor[3], factor[4]};
}

tl::expected<std::vector<std::optional<Matrix6d>>, CalibrationError> moduleCovariances(
    const AdjustmentInput& input, const BodyState& state, const Gauge& gauge, const AdjustmentOptions& options) {
    AdjustmentProblem::requireConsistent(input, state, options);
    const BodyState complete = AdjustmentProblem::withUpDirections(input, state);
    AdjustmentProblem problem(input, complete, options);
    Linearised linear;
    if (!problem.fix(gauge) || !linearise(problem, linear))
        return tl::unexpected(CalibrationError{ErrorCode::DegeneratePoints, {}});
    const SelectedInverse inverse(linear.factor);

    std::vector<std::optional<Matrix6d>> covariances(state.T_r_u.size());
    for (std::size_t u = 0; u < covariances.size(); ++u) {
        if (!state.T_r_u[u])
            continue;
        PoseBlocks& pose = problem.module(u);
        const auto q = linear.column.find(pose.q.data());
        const auto t = linear.column.find(pose.t.data());
        if (q == linear.column.end() || t == linear.column.end()) {
            const bool fixed =
                problem.ceres().HasParameterBlock(pose.q.data()) && problem.ceres().HasParameterBlock(pose.t.data());
            if (fixed)
                covariances[u] = Matrix6d::Zero();
            continue;
        }
        Matrix6d C;
        for (Eigen::Index i = 0; i < 6; ++i) {
            for (Eigen::Index j = 0; j < 6; ++j)
                C(i, j) = inverse(i < 3 ? q->second + i : t->second + i - 3, j < 3 ? q->second + j : t->second + j - 3);
        }
        // The quaternion manifold's tangent is half the rotation vector.
        C.topRows<3>() *= 2;
        C.leftCols<3>() *= 2;
        covariances[u] = C;
    }
    return covariances;
}

}  // namespace skincal
