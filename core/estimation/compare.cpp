#include "core/estimation/compare.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace skincal {
namespace {

struct Pair {
    ModuleId id;
    Isometry3d body;
    Isometry3d truth;
};

/// Kabsch on the positions; where they leave a turn open, on the modules' axes a centimetre long as well.
Isometry3d align(const std::vector<Pair>& pairs) {
    std::vector<Vector3d> from;
    std::vector<Vector3d> to;
    for (const Pair& pair : pairs) {
        from.emplace_back(pair.body.translation());
        to.emplace_back(pair.truth.translation());
    }
    const auto centre = [](const std::vector<Vector3d>& points) {
        Vector3d sum = Vector3d::Zero();
        for (const Vector3d& p : points)
            sum += p;
        return Vector3d(sum / static_cast<double>(points.size()));
    };
    const auto correlate = [&](const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
        const Vector3d ca = centre(a);
        const Vector3d cb = centre(b);
        Matrix3d M = Matrix3d::Zero();
        for (std::size_t i = 0; i < a.size(); ++i)
            M += (b[i] - cb) * (a[i] - ca).transpose();
        return M;
    };
    const Vector3d spread = Eigen::SelfAdjointEigenSolver<Matrix3d>(correlate(to, to)).eigenvalues();
    Matrix3d M = correlate(from, to);
    if (spread[1] < 1e-4 * spread[2] || spread[2] < 1e-12) {
        for (const Pair& pair : pairs)
            M += 1e-4 * pair.truth.linear() * pair.body.linear().transpose();
    }
    const Matrix3d R = nearestRotation(M);
    return makeIsometry(R, centre(to) - R * centre(from));
}

}  // namespace

tl::expected<BodyComparison, CalibrationError> compareBodies(const std::vector<NamedPose>& body,
                                                             const std::vector<NamedPose>& truth) {
    std::unordered_map<ModuleId, Isometry3d> byId;
    for (const NamedPose& pose : truth)
        byId[pose.id] = pose.T_body_module;
    std::vector<Pair> pairs;
    for (const NamedPose& pose : body) {
        const auto found = byId.find(pose.id);
        if (found != byId.end())
            pairs.push_back({pose.id, pose.T_body_module, found->second});
    }
    if (pairs.empty())
        return tl::unexpected(CalibrationError{ErrorCode::TooFewPoints, {{"found", 0}, {"needed", 1}}});

    BodyComparison result;
    result.compared = pairs.size();
    result.T_truth_body = align(pairs);
    for (const Pair& pair : pairs) {
        const PoseDifference d = poseDifference(result.T_truth_body * pair.body, pair.truth);
        result.positionRms += d.distance * d.distance;
        result.rotationRms += d.angle * d.angle;
        result.rotationMax = std::max(result.rotationMax, d.angle);
        if (d.distance >= result.positionMax) {
            result.positionMax = d.distance;
            result.worst = pair.id;
        }
    }
    result.positionRms = std::sqrt(result.positionRms / static_cast<double>(pairs.size()));
    result.rotationRms = std::sqrt(result.rotationRms / static_cast<double>(pairs.size()));
    return result;
}

}  // namespace skincal
