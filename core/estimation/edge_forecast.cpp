#include "core/estimation/edge_forecast.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

namespace skincal {

std::optional<double> expectedEdgeSigma(std::span<const Vector3d> gravity, const AccelerometerPrior& prior) {
    if (!prior.validate())
        throw std::logic_error("AccelerometerPrior out of range");
    using Matrix9d = Eigen::Matrix<double, 9, 9>;
    using Rows = Eigen::Matrix<double, 3, 9>;
    // Two sensors differ by root two of what each is off; a sensor without bias has an infinitely strong prior.
    constexpr double kTiny = 1e-9;
    Matrix9d H = Matrix9d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
        H(3 + axis, 3 + axis) = 0.5 / (prior.bias * prior.bias + kTiny);
        H(6 + axis, 6 + axis) = 0.5 / (prior.scale * prior.scale + kTiny);
    }
    for (const Vector3d& g : gravity) {
        Rows J;
        J << -skew(g), Matrix3d::Identity(), Matrix3d(g.asDiagonal());
        H += J.transpose() * J * (0.5 / (prior.noise * prior.noise));
    }
    // What is left for the rotation once bias and scale have taken their share.
    const Matrix3d S = H.topLeftCorner<3, 3>() -
                       H.topRightCorner<3, 6>() * H.bottomRightCorner<6, 6>().inverse() * H.bottomLeftCorner<6, 3>();
    const double weakest = Eigen::SelfAdjointEigenSolver<Matrix3d>(S).eigenvalues()[0];
    // A rotation known to worse than a radian is not known; S of one pose is singular but for rounding.
    if (!(weakest > 1))
        return std::nullopt;
    return 1 / std::sqrt(weakest);
}

}  // namespace skincal
