#include "core/estimation/body_attachment.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace skincal {

std::optional<Isometry3d> resectView(const std::vector<PatchSighting>& sightings, std::size_t view,
                                     const GrowingBody& body, const CameraModel& camera,
                                     const PatchPoseOptions& options, double decisiveCostRatio) {
    std::vector<LedCorrespondence> leds;
    for (const PatchSighting& sighting : sightings) {
        if (sighting.view != view || !body.T_r_o[sighting.patch])
            continue;
        const Isometry3d& T_r_o = *body.T_r_o[sighting.patch];
        for (LedCorrespondence led : sighting.leds) {
            led.led_o = T_r_o * led.led_o;
            led.normal_o = T_r_o.linear() * led.normal_o;
            leds.push_back(led);
        }
    }
    const auto poses = estimatePatchPoses(leds, camera, options);
    if (!poses)
        return std::nullopt;
    if (poses->size() > 1 && (*poses)[1].cost < decisiveCostRatio * (*poses)[0].cost)
        return std::nullopt;
    return poses->front().T_v_o.inverse();
}

std::optional<Isometry3d> triangulatePatch(const std::vector<PatchSighting>& sightings, std::size_t patch,
                                           const Matrix3d& R_r_o, const GrowingBody& body, const CameraModel& camera,
                                           double maxResidual_px) {
    struct Ray {
        Vector3d centre, direction, led_r;
    };
    std::vector<Ray> rays;
    for (const PatchSighting& sighting : sightings) {
        if (sighting.patch != patch || !body.T_r_v[sighting.view])
            continue;
        const Isometry3d& T_r_v = *body.T_r_v[sighting.view];
        for (const LedCorrespondence& led : sighting.leds) {
            const Vector2d n = camera.unproject(led.pixel);
            rays.push_back(
                {T_r_v.translation(), T_r_v.linear() * Vector3d(n.x(), n.y(), 1).normalized(), R_r_o * led.led_o});
        }
    }
    if (rays.size() < 2)
        return std::nullopt;

    const auto distance = [](const Ray& ray, const Vector3d& t) {
        const Vector3d p = t + ray.led_r - ray.centre;
        const double along = p.dot(ray.direction);
        return along > 0 ? p.cross(ray.direction).norm() / along : 1e9;  // tangent of the angle between them
    };
    const double unit = maxResidual_px / (0.5 * (camera.fx + camera.fy));
    std::vector<double> weights(rays.size(), 1);
    Vector3d t = Vector3d::Zero();
    for (int iteration = 0; iteration < 20; ++iteration) {
        Matrix3d H = Matrix3d::Zero();
        Vector3d g = Vector3d::Zero();
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Matrix3d across = Matrix3d::Identity() - rays[i].direction * rays[i].direction.transpose();
            H += weights[i] * across;
            g += weights[i] * across * (rays[i].centre - rays[i].led_r);
        }
        const Vector3d eigenvalues = Eigen::SelfAdjointEigenSolver<Matrix3d>(H).eigenvalues();
        if (eigenvalues[0] < 1e-4 * eigenvalues[2])
            return std::nullopt;  // all rays parallel: the depth is open
        t = H.ldlt().solve(g);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const double r = distance(rays[i], t) / unit;
            weights[i] = 1 / (1 + r * r);
        }
    }
    std::vector<double> residuals;
    for (const Ray& ray : rays)
        residuals.push_back(distance(ray, t));
    std::nth_element(residuals.begin(), residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2),
                     residuals.end());
    if (residuals[residuals.size() / 2] > unit)
        return std::nullopt;
    return makeIsometry(R_r_o, t);
}

}  // namespace skincal
