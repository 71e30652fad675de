#pragma once

/// Rigid transforms on Eigen. The one place where the convention is stated:
///
///   T_a_b maps coordinates in frame b into frame a:  p_a = T_a_b * p_b,  T_a_c = T_a_b * T_b_c
///
/// Letters: r body, v camera view (x right, y down, z forward), o patch origin, u, c, n modules.
/// Lengths in m, angles in rad; any other unit is a suffix (_mm, _deg, _px, _ms).

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace skincal {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Standard gravity, m/s^2: what an accelerometer at rest reads along its up axis.
inline constexpr double kStandardGravity = 9.80665;
inline constexpr double kDegree = 0.017453292519943295;

[[nodiscard]] Matrix3d skew(const Vector3d& v);

/// Rotation vector (axis times angle, |w| <= pi) to rotation and back.
[[nodiscard]] Matrix3d so3Exp(const Vector3d& w);
[[nodiscard]] Vector3d so3Log(const Matrix3d& R);

/// The rotation nearest to M in the Frobenius norm (SVD, det = +1).
[[nodiscard]] Matrix3d nearestRotation(const Matrix3d& M);

/// Angle of R in [0, pi].
[[nodiscard]] double rotationAngle(const Matrix3d& R);

[[nodiscard]] Isometry3d makeIsometry(const Matrix3d& R, const Vector3d& t);

/// Angle (rad) and distance (m) between two poses of the same frame pair.
struct PoseDifference {
    double angle = 0;
    double distance = 0;
};
[[nodiscard]] PoseDifference poseDifference(const Isometry3d& a, const Isometry3d& b);

/// True where every entry of both is finite and R is a rotation within `tolerance`.
[[nodiscard]] bool isRigid(const Isometry3d& T, double tolerance = 1e-6);

}  // namespace skincal
