#include "core/simulation/mirror.h"

#include <cmath>

#include "core/geometry/statistics.h"
#include "core/simulation/scene.h"

namespace skincal {
namespace {

double depthOf(const World& world, const Isometry3d& T_r_v) {
    std::vector<double> depths;
    for (const Isometry3d& T_r_u : world.T_r_u)
        depths.push_back((T_r_v.inverse() * T_r_u.translation()).z());
    return std::max(0.01, median(std::move(depths)));
}

}  // namespace

// Of what is as far away as the body, the image is the picture turned upside down at the edge: as the scene is painted.
Mirror::Mirror(const World& world, const Isometry3d& T_r_v)
    : world_(world),
      T_r_v_(T_r_v),
      height_((mirrorEdge(world.scenario.camera) - world.scenario.camera.cy) / world.scenario.camera.fy *
              depthOf(world, T_r_v)),
      image_r_(reflected(T_r_v.translation())) {}

Vector3d Mirror::reflected(const Vector3d& p_r) const {
    Vector3d p_v = T_r_v_.inverse() * p_r;
    p_v.y() = 2 * height_ - p_v.y();
    return T_r_v_ * p_v;
}

std::optional<Vector2d> Mirror::pixelOf(const Isometry3d& T_r_v, std::size_t view, std::size_t module,
                                        double maxAngle) const {
    const Vector3d led_r = world_.T_r_u[module] * world_.trueTemplate(module).led;
    const double above = height_ - (T_r_v_.inverse() * led_r).y();
    const Vector3d axis = world_.T_r_u[module].linear().col(2);
    if (above <= 0 || axis.dot((image_r_ - led_r).normalized()) < std::cos(maxAngle))
        return std::nullopt;
    const CameraModel& camera = world_.scenario.camera;
    const Vector3d behind_r = reflected(led_r);
    const auto inMirror = camera.project(T_r_v_.inverse() * behind_r);
    const auto pixel = camera.project(T_r_v.inverse() * behind_r);
    if (!inMirror || inMirror->y() <= mirrorEdge(camera) || !pixel || !camera.contains(*pixel))
        return std::nullopt;
    const Vector3d there_r = led_r + above / (above + height_) * (image_r_ - led_r);
    if (isBlocked(world_, module, there_r) || isBlocked(world_, there_r, T_r_v_.translation()) ||
        isOccluded(world_, T_r_v_, view, *pixel))
        return std::nullopt;
    return pixel;
}

}  // namespace skincal
