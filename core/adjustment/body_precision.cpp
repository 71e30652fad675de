#include "core/adjustment/body_precision.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/adjustment/linearisation.h"

namespace skincal {
namespace {

struct Position {
    std::size_t module = 0;
    std::optional<Eigen::Index> column;  ///< of its x; none where it is held
};

std::vector<Position> positionsOf(AdjustmentProblem& problem, const BodyState& state, const Linearisation& linear) {
    std::vector<Position> positions;
    for (std::size_t u = 0; u < state.T_r_u.size(); ++u) {
        const PoseBlocks& pose = problem.module(u);
        if (!state.T_r_u[u] || !problem.ceres().HasParameterBlock(pose.t.data()))
            continue;
        const auto columns = linear.columnsOf(pose);
        positions.push_back({u, columns ? std::optional((*columns)[3]) : std::nullopt});
    }
    return positions;
}

/// The motions that do not change the body (shifts and turns), and its growth: one column each, rows per position.
Eigen::Matrix<double, Eigen::Dynamic, 7> motionsOf(const std::vector<Position>& positions, const BodyState& state) {
    Vector3d mean = Vector3d::Zero();
    for (const Position& position : positions)
        mean += state.T_r_u[position.module]->translation() / static_cast<double>(positions.size());
    Eigen::Matrix<double, Eigen::Dynamic, 7> motions(3 * positions.size(), 7);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Vector3d p = state.T_r_u[positions[i].module]->translation() - mean;
        const auto row = static_cast<Eigen::Index>(3 * i);
        motions.block<3, 3>(row, 0).setIdentity();
        motions.block<3, 3>(row, 3) = -skew(p);
        motions.block<3, 1>(row, 6) = p;
    }
    return motions;
}

/// C times the motions, C the covariance of the positions.
Eigen::MatrixXd covarianceTimes(const Eigen::MatrixXd& motions, const std::vector<Position>& positions,
                                const Linearisation& linear) {
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(linear.J.cols(), motions.cols());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (positions[i].column)
            right.middleRows(*positions[i].column, 3) = motions.middleRows(static_cast<Eigen::Index>(3 * i), 3);
    }
    const Eigen::MatrixXd solved = linear.factor.solve(right);
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(motions.rows(), motions.cols());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        if (positions[i].column)
            result.middleRows(static_cast<Eigen::Index>(3 * i), 3) = solved.middleRows(*positions[i].column, 3);
    }
    return result;
}

/// (G^T G)^-1; modules on a line can't tell a turn about it, which is left out.
Eigen::Matrix<double, 6, 6> pseudoInverse(const Eigen::Matrix<double, 6, 6>& M) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(M);
    constexpr double kNothing = 1e-12;
    Vector6d inverse = Vector6d::Zero();
    for (Eigen::Index i = 0; i < 6; ++i) {
        if (solver.eigenvalues()[i] > kNothing * solver.eigenvalues()[5])
            inverse[i] = 1 / solver.eigenvalues()[i];
    }
    return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

double BodyPrecision::sigma(std::size_t u) const {
    return positions[u] ? std::sqrt(std::max(0.0, positions[u]->trace())) : 0;
}

std::optional<std::size_t> BodyPrecision::worst() const {
    std::optional<std::size_t> worst;
    for (std::size_t u = 0; u < positions.size(); ++u) {
        if (positions[u] && (!worst || sigma(u) > sigma(*worst)))
            worst = u;
    }
    return worst;
}

double BodyPrecision::worstSigma() const {
    const auto u = worst();
    return u ? sigma(*u) : 0;
}

double BodyPrecision::rmsSigma() const {
    double squares = 0;
    std::size_t count = 0;
    for (const auto& C : positions) {
        squares += C ? std::max(0.0, C->trace()) : 0;
        count += C ? 1 : 0;
    }
    return count > 0 ? std::sqrt(squares / static_cast<double>(count)) : 0;
}

tl::expected<BodyPrecision, CalibrationError> bodyPrecision(const AdjustmentInput& input, const BodyState& state,
                                                            const Gauge& gauge, const AdjustmentOptions& options) {
    AdjustmentProblem::requireConsistent(input, state, options);
    const BodyState complete = AdjustmentProblem::withUpDirections(input, state);
    AdjustmentProblem problem(input, complete, options);
    Linearisation linear;
    if (!problem.fix(gauge) || !linearise(problem, options, linear))
        return tl::unexpected(CalibrationError{ErrorCode::DegeneratePoints, {}});

    BodyPrecision precision;
    precision.positions.resize(state.T_r_u.size());
    precision.size.resize(state.T_r_u.size(), 0);
    const auto positions = positionsOf(problem, state, linear);
    if (positions.empty())
        return precision;
    const Eigen::MatrixXd motions = motionsOf(positions, state);
    const Eigen::MatrixXd CM = covarianceTimes(motions, positions, linear);
    const auto G = motions.leftCols<6>();
    const Eigen::MatrixXd GN = G * pseudoInverse(G.transpose() * G);
    const Matrix6d GCG = G.transpose() * CM.leftCols<6>();
    const SelectedInverse inverse(linear.factor);
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(3 * i);
        Matrix3d C = Matrix3d::Zero();
        for (Eigen::Index a = 0; positions[i].column && a < 3; ++a) {
            for (Eigen::Index b = 0; b < 3; ++b)
                C(a, b) = inverse(*positions[i].column + a, *positions[i].column + b);
        }
        const Eigen::Matrix<double, 3, 6> N = GN.middleRows<3>(row);
        const Matrix3d half = N * CM.block<3, 6>(row, 0).transpose();
        precision.positions[positions[i].module] = C - half - half.transpose() + N * GCG * N.transpose();
    }
    const Eigen::VectorXd growth = motions.col(6);
    const double size = growth.squaredNorm();
    if (size > 0)
        precision.scale = std::sqrt(std::max(0.0, growth.dot(CM.col(6)))) / size;
    for (std::size_t i = 0; i < positions.size(); ++i)
        precision.size[positions[i].module] =
            precision.scale * growth.segment<3>(static_cast<Eigen::Index>(3 * i)).norm();
    return precision;
}

}  // namespace skincal
