#include "core/estimation/edge_rotation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace skincal {

double gravitySpread(std::span<const Vector3d> g) {
    double largest = 0;
    for (std::size_t i = 0; i < g.size(); ++i) {
        for (std::size_t k = i + 1; k < g.size(); ++k)
            largest = std::max(largest, std::atan2(g[i].cross(g[k]).norm(), std::abs(g[i].dot(g[k]))));
    }
    return largest;
}

tl::expected<RelativeRotation, CalibrationError> estimateRelativeRotation(std::span<const Vector3d> g_c,
                                                                          std::span<const Vector3d> g_n,
                                                                          const RelativeRotationOptions& options) {
    if (!options.validate())
        throw std::logic_error("RelativeRotationOptions out of range");
    if (g_c.size() != g_n.size())
        return tl::unexpected(CalibrationError{ErrorCode::SizeMismatch, {{"c", g_c.size()}, {"n", g_n.size()}}});
    if (g_c.size() < static_cast<std::size_t>(options.minPoses))
        return tl::unexpected(
            CalibrationError{ErrorCode::TooFewPoses, {{"found", g_c.size()}, {"needed", options.minPoses}}});

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

tl::expected<RelativeRotation, CalibrationError> relativeRotation(const GravityTable& table, std::size_t a,
                                                                  std::size_t b,
                                                                  const RelativeRotationOptions& options) {
    std::vector<Vector3d> g_a;
    std::vector<Vector3d> g_b;
    const auto ofA = table.of(a);
    const auto ofB = table.of(b);
    auto i = ofA.begin();
    auto k = ofB.begin();
    while (i != ofA.end() && k != ofB.end()) {
        if (i->pose < k->pose) {
            ++i;
        } else if (k->pose < i->pose) {
            ++k;
        } else {
            g_a.push_back((i++)->acceleration);
            g_b.push_back((k++)->acceleration);
        }
    }
    return estimateRelativeRotation(g_a, g_b, options);
}

}  // namespace skincal
