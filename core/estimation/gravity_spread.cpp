#include "core/estimation/gravity_spread.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/geometry/statistics.h"

namespace skincal {

std::vector<Vector3d> evenDirections(std::size_t count) {
    const double golden = 180 * kDegree * (3 - std::sqrt(5.0));
    std::vector<Vector3d> directions;
    for (std::size_t i = 0; i < count; ++i) {
        const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
        const double r = std::sqrt(1 - z * z);
        const double angle = golden * static_cast<double>(i);
        directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    return directions;
}

Matrix3d gravityRotationCovariance(std::span<const Vector3d> up_u, double sigma, const AdjustmentOptions& weights) {
    constexpr double kUnknown = 1;  // rad
    using Matrix9 = Eigen::Matrix<double, 9, 9>;
    Eigen::Matrix<double, 9, 1> prior;
    prior << Vector3d::Constant(1 / (kUnknown * kUnknown)),
        Vector3d::Constant(1 / (weights.biasSigma * weights.biasSigma)),
        Vector3d::Constant(1 / (weights.scaleSigma * weights.scaleSigma));
    Matrix9 H = prior.asDiagonal();
    for (const Vector3d& up : up_u) {
        const Vector3d force = weights.gravity * up;
        Eigen::Matrix<double, 3, 9> J;
        J << -skew(force), Matrix3d::Identity(), Matrix3d(force.asDiagonal());
        H += J.transpose() * J / (sigma * sigma);
    }
    const Matrix3d C = H.llt().solve(Matrix9::Identity()).topLeftCorner<3, 3>();
    // Poses that are all alike differ by their noise, which looks like 2 g^2/sigma^2 (sigma/g)^2 of information each.
    const double fromNoise = 2 * static_cast<double>(up_u.size());
    const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(C);
    const Vector3d information = axes.eigenvalues().cwiseInverse().array() - fromNoise;
    const Vector3d variances = information.cwiseMax(1 / (kUnknown * kUnknown)).cwiseInverse();
    return axes.eigenvectors() * variances.asDiagonal() * axes.eigenvectors().transpose();
}

std::vector<Vector3d> upDirectionsOf(const AdjustmentInput& input, const BodyState& state, std::size_t u) {
    std::vector<Vector3d> up;
    for (const GravityTable::Entry& entry : input.gravity->of(u)) {
        const Vector3d force = state.accelerometers[u].specificForce(entry.acceleration);
        if (force.norm() > 0)
            up.push_back(force.normalized());
    }
    return up;
}

double typicalSigma(const AdjustmentInput& input, std::size_t u, const AdjustmentOptions& weights) {
    std::vector<double> sigmas;
    for (const GravityTable::Entry& entry : input.gravity->of(u))
        sigmas.push_back(input.sigmaOf(u, entry, weights));
    return sigmas.empty() ? weights.accelerometerSigma : median(std::move(sigmas));
}

double largestTilt(std::span<const Vector3d> up) {
    double cosine = 1;
    for (std::size_t i = 0; i < up.size(); ++i) {
        for (std::size_t j = i + 1; j < up.size(); ++j)
            cosine = std::min(cosine, std::abs(up[i].dot(up[j])));
    }
    return std::acos(std::clamp(cosine, 0.0, 1.0));
}

}  // namespace skincal
