#include "core/adjustment/pose_covariance.h"

#include "core/adjustment/linearisation.h"

namespace skincal {

tl::expected<Eigen::MatrixXd, CalibrationError> poseCovariance(const AdjustmentInput& input, const BodyState& state,
                                                               PosesOf kind, const std::vector<std::size_t>& which,
                                                               const Gauge& gauge, const AdjustmentOptions& options) {
    AdjustmentProblem::requireConsistent(input, state, options);
    const BodyState complete = AdjustmentProblem::withUpDirections(input, state);
    AdjustmentProblem problem(input, complete, options);
    const tl::unexpected<CalibrationError> degenerate(CalibrationError{ErrorCode::DegeneratePoints, {}});
    Linearisation linear;
    if (!problem.fix(gauge) || !linearise(problem, options, linear))
        return degenerate;

    const auto size = static_cast<Eigen::Index>(6 * which.size());
    std::vector<Eigen::Index> column(static_cast<std::size_t>(size), -1);  // of each row; none where held
    for (std::size_t i = 0; i < which.size(); ++i) {
        const PoseBlocks& pose = kind == PosesOf::Views ? problem.view(which[i]) : problem.module(which[i]);
        if (!problem.ceres().HasParameterBlock(pose.q.data()) || !problem.ceres().HasParameterBlock(pose.t.data()))
            return degenerate;  // nothing was measured of it
        if (const auto columns = linear.columnsOf(pose))
            std::copy(columns->begin(), columns->end(), column.begin() + static_cast<std::ptrdiff_t>(6 * i));
    }
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
        if (column[static_cast<std::size_t>(i)] < 0)
            continue;
        const Eigen::VectorXd unit = Eigen::VectorXd::Unit(linear.J.cols(), column[static_cast<std::size_t>(i)]);
        const Eigen::VectorXd solved = linear.factor.solve(unit);
        for (Eigen::Index j = 0; j < size; ++j) {
            if (column[static_cast<std::size_t>(j)] >= 0)
                covariance(j, i) = tangentFactor(i) * tangentFactor(j) * solved[column[static_cast<std::size_t>(j)]];
        }
    }
    return Eigen::MatrixXd((covariance + covariance.transpose()) / 2);
}

Matrix6d relativeCovariance(const Isometry3d& T_r_a, const Isometry3d& T_r_b,
                            const Eigen::Matrix<double, 12, 12>& covariance) {
    // Small turns w and shifts t of both move b against a by
    //   R_a^T (w_b - w_a),  R_a^T (t_b - t_a - w_a x (p_b - p_a))
    const Matrix3d R_a_r = T_r_a.linear().transpose();
    Eigen::Matrix<double, 6, 12> J = Eigen::Matrix<double, 6, 12>::Zero();
    J.block<3, 3>(0, 0) = -R_a_r;
    J.block<3, 3>(0, 6) = R_a_r;
    J.block<3, 3>(3, 0) = R_a_r * skew(T_r_b.translation() - T_r_a.translation());
    J.block<3, 3>(3, 3) = -R_a_r;
    J.block<3, 3>(3, 9) = R_a_r;
    return J * covariance * J.transpose();
}

}  // namespace skincal
