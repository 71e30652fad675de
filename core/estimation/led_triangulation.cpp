#include "core/estimation/led_triangulation.h"

#include <Eigen/Eigenvalues>
#include <set>

namespace skincal {
namespace {

/// Rays more parallel than this leave the depth open.
constexpr double kLeastParallax = 0.02;  // rad

std::optional<Vector3d> meetingPoint(const BodySolution& solution, const std::vector<PixelObservation>& seen) {
    const CameraModel& camera = *solution.input.camera;
    Matrix3d H = Matrix3d::Zero();
    Vector3d g = Vector3d::Zero();
    double total = 0;
    for (const PixelObservation& o : seen) {
        const Isometry3d& T_r_v = *solution.solved.T_r_v[o.view];
        const Vector2d n = camera.unproject(o.pixel);
        const Vector3d d = T_r_v.linear() * Vector3d(n.x(), n.y(), 1).normalized();
        const double sigma = solution.input.sigmaOf(o, solution.weights);
        const double weight = 1 / (sigma * sigma);
        const Matrix3d across = weight * (Matrix3d::Identity() - d * d.transpose());
        H += across;
        g += across * T_r_v.translation();
        total += weight;
    }
    const double least = Eigen::SelfAdjointEigenSolver<Matrix3d>(H).eigenvalues()[0];
    if (least < total * kLeastParallax * kLeastParallax / 4)
        return std::nullopt;
    return Vector3d(H.ldlt().solve(g));
}

}  // namespace

std::optional<Vector3d> triangulateLed(const BodySolution& solution, const std::vector<PixelObservation>& detections,
                                       std::size_t module, double limit) {
    std::vector<PixelObservation> seen;
    std::set<std::size_t> views;
    for (const PixelObservation& o : detections) {
        if (o.module == module && solution.solved.T_r_v[o.view]) {
            seen.push_back(o);
            views.insert(o.view);
        }
    }
    if (views.size() < 2)
        return std::nullopt;
    const auto p = meetingPoint(solution, seen);
    if (!p)
        return std::nullopt;
    for (const PixelObservation& o : seen) {
        const auto pixel = solution.input.camera->project(solution.solved.T_r_v[o.view]->inverse() * *p);
        if (!pixel || (*pixel - o.pixel).norm() > limit * solution.input.sigmaOf(o, solution.weights))
            return std::nullopt;
    }
    return p;
}

std::vector<std::optional<Vector3d>> ledsSeenElsewhere(const BodySolution& solution) {
    const std::size_t modules = solution.solved.T_r_u.size();
    std::vector<std::vector<PixelObservation>> rejected(modules);
    std::vector<std::size_t> used(modules, 0);
    for (std::size_t i = 0; i < solution.input.pixels.size(); ++i) {
        const PixelObservation& o = solution.input.pixels[i];
        if (!solution.estimate.setAside[i].empty() || !solution.solved.T_r_u[o.module])
            continue;
        if (solution.estimate.rejected[i])
            rejected[o.module].push_back(o);
        else
            ++used[o.module];
    }
    std::vector<std::optional<Vector3d>> elsewhere(modules);
    for (std::size_t u = 0; u < modules; ++u) {
        if (rejected[u].size() >= 2 && rejected[u].size() > used[u])
            elsewhere[u] = triangulateLed(solution, rejected[u], u);
    }
    return elsewhere;
}

}  // namespace skincal
