#include "core/adjustment/linearisation.h"

#include "core/adjustment/late_cauchy_loss.h"

namespace skincal {
namespace {

/// rho'(s) of the loss that the adjustment puts on a kind of measurement.
double lossWeight(MeasurementKind kind, double squares, const AdjustmentOptions& options) {
    const double scale = kind == MeasurementKind::Pixel     ? options.pixelLoss
                         : kind == MeasurementKind::Gravity ? options.gravityLoss
                         : kind == MeasurementKind::Link    ? options.linkLoss
                                                            : 0;
    return scale > 0 ? LateCauchyLoss(scale, options.lossBegins).weight(squares) : 1;
}

/// A pivot that is nothing but rounding against the unknown's own information: others take all of it.
bool isSingular(const SparseCholesky& factor, const Eigen::SparseMatrix<double>& H) {
    constexpr double kRounding = 1e-12;
    const Eigen::VectorXd pivots = Eigen::SparseMatrix<double>(factor.matrixL()).diagonal().cwiseAbs2();
    Eigen::VectorXd information = H.diagonal();
    if (factor.permutationP().indices().size() > 0)
        information = factor.permutationP() * information;
    return (pivots.array() < kRounding * information.array()).any();
}

}  // namespace

SmallMatrix forecastCovariance(const Linearisation& linear, const LinearisedBlock& block,
                               const SelectedInverse& inverse) {
    // A measurement depends on some sixteen unknowns.
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 24>;
    using RowIterator = Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator;
    std::array<Eigen::Index, 24> columns{};
    Eigen::Index count = 0;
    for (RowIterator it(linear.J, block.row); it; ++it)
        columns.at(static_cast<std::size_t>(count++)) = it.col();
    Rows J = Rows::Zero(block.size, count);
    for (Eigen::Index r = 0; r < block.size; ++r) {
        // Ceres writes all columns of a block in every row, in the same order.
        Eigen::Index c = 0;
        for (RowIterator it(linear.J, block.row + r); it; ++it)
            J(r, c++) = it.value();
    }
    Rows JC = Rows::Zero(block.size, count);
    for (Eigen::Index i = 0; i < count; ++i) {
        for (Eigen::Index j = 0; j <= i; ++j) {
            const double C = inverse(columns.at(static_cast<std::size_t>(i)), columns.at(static_cast<std::size_t>(j)));
            JC.col(i) += C * J.col(j);
            if (i != j)
                JC.col(j) += C * J.col(i);
        }
    }
    return JC * J.transpose();
}

std::optional<std::array<Eigen::Index, 6>> Linearisation::columnsOf(const PoseBlocks& pose) const {
    const auto q = column.find(pose.q.data());
    const auto t = column.find(pose.t.data());
    if (q == column.end() || t == column.end())
        return std::nullopt;
    return std::array{q->second, q->second + 1, q->second + 2, t->second, t->second + 1, t->second + 2};
}

bool linearise(AdjustmentProblem& problem, const AdjustmentOptions& options, Linearisation& result,
               const RunContext& context) {
    ceres::Problem::EvaluateOptions evaluate;
    evaluate.apply_loss_function = false;
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
    for (const MeasurementKind kind : kMeasurementKinds) {
        for (const ResidualOf& source : problem.residuals(kind)) {
            const Eigen::Index size = problem.ceres().GetCostFunctionForResidualBlock(source.id)->num_residuals();
            evaluate.residual_blocks.push_back(source.id);
            addColumns(source.id);
            result.blocks.push_back({kind, source, rows, size, 1});
            rows += size;
        }
    }
    std::vector<double> residuals;
    ceres::CRSMatrix crs;
    if (!problem.ceres().Evaluate(evaluate, nullptr, &residuals, nullptr, &crs))
        return false;
    if (context.isCancelled())
        return false;
    result.residuals = Eigen::Map<const Eigen::VectorXd>(residuals.data(), rows);
    result.J = Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor>>(
        crs.num_rows, crs.num_cols, static_cast<Eigen::Index>(crs.values.size()), crs.rows.data(), crs.cols.data(),
        crs.values.data());
    Eigen::VectorXd weights(rows);
    for (LinearisedBlock& block : result.blocks) {
        block.weight = lossWeight(block.kind, result.residuals.segment(block.row, block.size).squaredNorm(), options);
        weights.segment(block.row, block.size).setConstant(block.weight);
    }
    const Eigen::SparseMatrix<double> H =
        result.J.transpose() * Eigen::SparseMatrix<double>(weights.asDiagonal() * result.J);
    if (context.isCancelled())
        return false;
    result.factor.compute(H);
    return result.factor.info() == Eigen::Success && !isSingular(result.factor, H);
}

}  // namespace skincal
