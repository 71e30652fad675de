#include "core/estimation/edge_rotation.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

namespace skincal {

double gravitySpread(std::span<const Vector3d> g) {
    Matrix3d S = Matrix3d::Zero();
    for (const Vector3d& v : g) {
        if (v.norm() > 1e-9)
            S += v.normalized() * v.normalized().transpose();
    }
    const Vector3d eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix3d>(S).eigenvalues();
    if (eigenvalues[2] <= 0)
        return 0;
    return std::asin(std::sqrt(std::max(0.0, eigenvalues[1] / eigenvalues[2])));
}

tl::expected<RelativeRotation, CalibrationError> estimateRelativeRotation(std::span<const Vector3d> g_c,
                                                                          std::span<const Vector3d> g_n,
                                                                          const RelativeRotationOptions& options) {
    if (!options.validate())
        throw std::logic_error("RelativeRotationOptions out of range");
    if (g_c.size() != g_n.size())
        return tl::unexpected(CalibrationError{ErrorCode::SizeMismatch, {{"c", g_c.size()}, {"n", g_n.size()}}});
    if (g_c.size() < 2)
        return tl::unexpected(CalibrationError{ErrorCode::TooFewPoses, {{"found", g_c.size()}, {"needed", 2}}});

    Matrix3d correlation = Matrix3d::Zero();
    for (std::size_t p = 0; p < g_c.size(); ++p) {
        if (!g_c[p].allFinite() || !g_n[p].allFinite())
            return tl::unexpected(CalibrationError{ErrorCode::NotFinite, {{"pose", static_cast<double>(p)}}});
        correlation += g_c[p] * g_n[p].transpose();
    }
    const double spread = std::min(gravitySpread(g_c), gravitySpread(g_n));
    if (spread < options.minSpread_rad)
        return tl::unexpected(
            CalibrationError{ErrorCode::ParallelGravity,
                             {{"spread_deg", spread / kDegree}, {"needed_deg", options.minSpread_rad / kDegree}}});

    RelativeRotation result;
    result.spread_rad = spread;
    result.R_c_n = nearestRotation(correlation);
    double sum = 0;
    for (std::size_t p = 0; p < g_c.size(); ++p)
        sum += (result.R_c_n * g_n[p] - g_c[p]).squaredNorm();
    result.residual_rms = std::sqrt(sum / static_cast<double>(g_c.size()));
    return result;
}

}  // namespace skincal
