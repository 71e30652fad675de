#pragma once

#include <Eigen/Core>
#include <tl/expected.hpp>
#include <vector>

#include "core/adjustment/body_adjustment.h"

namespace skincal {

enum class PosesOf { Modules, Views };

/// Covariance (rotation vector in the body frame, then translation; rad, m) of the poses of any modules or views
/// together, in the order given, 6 by 6 blocks of one matrix; zero for those of the gauge. Same gauge rules as
/// adjustBody. At the truth and without losses it is the Cramer-Rao bound.
/// Fails with DegeneratePoints where the data do not fix all unknowns, or nothing was measured of one of the poses.
[[nodiscard]] tl::expected<Eigen::MatrixXd, CalibrationError> poseCovariance(const AdjustmentInput& input,
                                                                             const BodyState& state, PosesOf kind,
                                                                             const std::vector<std::size_t>& which,
                                                                             const Gauge& gauge,
                                                                             const AdjustmentOptions& options = {});

/// Covariance of T_a_b (rotation vector in a's frame, then translation) from that of T_r_a and T_r_b together:
/// how well module b is known from module a, whatever the body frame.
[[nodiscard]] Matrix6d relativeCovariance(const Isometry3d& T_r_a, const Isometry3d& T_r_b,
                                          const Eigen::Matrix<double, 12, 12>& covariance);

}  // namespace skincal
