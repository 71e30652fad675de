#include <algorithm>
#include <cmath>

#include "core/geometry/random.h"
#include "core/simulation/world.h"

namespace skincal {
namespace {

/// Least distance between the segment a-b and a tube's axis, with how far along the segment it is (0 to 1).
bool crosses(const Tube& tube, const Vector3d& a, const Vector3d& b) {
    const Vector3d d1 = b - a;
    const Vector3d d2 = tube.to - tube.from;
    const Vector3d r = a - tube.from;
    const double aa = d1.squaredNorm();
    const double ee = d2.squaredNorm();
    const double f = d2.dot(r);
    const double c = d1.dot(r);
    const double bb = d1.dot(d2);
    const double denominator = aa * ee - bb * bb;
    double s = denominator > 1e-12 ? std::clamp((bb * f - c * ee) / denominator, 0.0, 1.0) : 0.0;
    const double t = std::clamp((bb * s + f) / ee, 0.0, 1.0);
    s = std::clamp((bb * t - c) / aa, 0.0, 1.0);
    return (a + s * d1 - tube.from - t * d2).norm() < tube.radius;
}

bool crosses(const Card& card, const Vector3d& a, const Vector3d& b) {
    const Isometry3d T_k_r = card.T_r_k.inverse();
    const Vector3d p = T_k_r * a;
    const Vector3d q = T_k_r * b;
    if (p.z() * q.z() >= 0)
        return false;
    const Vector3d hit = p + p.z() / (p.z() - q.z()) * (q - p);
    return std::abs(hit.x()) < 0.5 * card.width && std::abs(hit.y()) < 0.5 * card.height;
}

/// From an LED, where a tube does not hide the skin that lies on it, a millimetre below.
bool isBlocked(const World& world, const Vector3d& led_r, const Vector3d& axis_r, const Vector3d& to_r) {
    const Vector3d start = led_r + 0.001 * axis_r;
    return std::any_of(world.tubes.begin(), world.tubes.end(),
                       [&](const Tube& tube) { return crosses(tube, start, to_r); }) ||
           std::any_of(world.cards.begin(), world.cards.end(),
                       [&](const Card& card) { return crosses(card, led_r, to_r); });
}

/// Pixel of a module's LED, module and camera being where they are said to be. What stands in the way is put there
/// for another pose of the camera, the one before it was knocked.
std::optional<Vector2d> pixelFrom(const World& world, std::size_t view, const Isometry3d& occluded_T_r_v,
                                  const Isometry3d& T_r_v, std::size_t module, const Isometry3d& T_r_u,
                                  const Visibility& visibility) {
    const Vector3d led_r = T_r_u * world.trueTemplate(module).led;
    const Vector3d camera_r = T_r_v.translation();
    const Vector3d ray = (camera_r - led_r).normalized();
    if (T_r_u.linear().col(2).dot(ray) < std::cos(visibility.maxAngle))
        return std::nullopt;
    const auto pixel = world.scenario.camera.project(T_r_v.inverse() * led_r);
    const CameraModel& camera = world.scenario.camera;
    if (!pixel || pixel->x() < visibility.margin_px || pixel->y() < visibility.margin_px ||
        pixel->x() > camera.width - 1 - visibility.margin_px || pixel->y() > camera.height - 1 - visibility.margin_px)
        return std::nullopt;
    if (isBlocked(world, led_r, T_r_u.linear().col(2), camera_r) || isOccluded(world, occluded_T_r_v, view, *pixel))
        return std::nullopt;
    return pixel;
}

/// Where a module would be at the scan if no fault had moved it by itself.
const Isometry3d& poseAsLaid(const World& world, std::size_t module) {
    const auto& moved = world.faults.movedModules;
    const bool isMoved = std::binary_search(moved.begin(), moved.end(), module);
    return isMoved ? world.faults.T_r_u_before[module] : world.T_r_u[module];
}

Visibility limitsOf(const World& world) {
    Visibility visibility;
    visibility.maxAngle = world.scenario.views.maxAngle;
    return visibility;
}

const BumpedView* bumpOf(const World& world, std::size_t view) {
    for (const BumpedView& bump : world.faults.bumpedViews) {
        if (bump.view == view)
            return &bump;
    }
    return nullptr;
}

Vector2d detect(const Vector2d& pixel, const ViewOptions& options, Random& random) {
    Vector2d found = pixel + options.pixelNoise * Vector2d(random.normal(), random.normal());
    if (random.uniform() < options.outliers)
        found = pixel + Vector2d(random.uniform(-250, 250), random.uniform(-250, 250));
    return found;
}

}  // namespace

Eigen::Vector4d occluderOf(const World& world, std::size_t view) {
    return occluderOf(world, world.T_r_v[view], view);
}

Eigen::Vector4d occluderOf(const World& world, const Isometry3d& T_r_v, std::size_t view) {
    if (!world.scenario.disturbances.occluder)
        return Eigen::Vector4d::Zero();
    // Round the place where some module's LED would be, so that it hides something.
    Random random(world.seed + view, "occluder");
    const std::size_t module = random.index(world.T_r_u.size());
    const Vector3d led_v = T_r_v.inverse() * (poseAsLaid(world, module) * world.trueTemplate(module).led);
    const auto pixel = world.scenario.camera.project(led_v);
    const Vector2d middle = pixel.value_or(Vector2d(world.scenario.camera.cx, world.scenario.camera.cy));
    const double size = 0.075 * world.scenario.camera.fx / std::max(0.1, led_v.z());
    return {middle.x() - 0.5 * size, middle.y() - 0.35 * size, size, 0.7 * size};
}

bool isOccluded(const World& world, const Isometry3d& T_r_v, std::size_t view, const Vector2d& pixel) {
    const Eigen::Vector4d hidden = occluderOf(world, T_r_v, view);
    return hidden[2] > 0 && pixel.x() > hidden[0] && pixel.x() < hidden[0] + hidden[2] && pixel.y() > hidden[1] &&
           pixel.y() < hidden[1] + hidden[3];
}

bool isBlocked(const World& world, const Vector3d& from_r, const Vector3d& to_r) {
    return isBlocked(world, from_r, Vector3d::Zero(), to_r);
}

bool isBlocked(const World& world, std::size_t module, const Vector3d& to_r) {
    const Isometry3d& T_r_u = world.T_r_u[module];
    return isBlocked(world, T_r_u * world.trueTemplate(module).led, T_r_u.linear().col(2), to_r);
}

std::optional<Vector2d> visiblePixel(const World& world, std::size_t view, std::size_t module,
                                     const Visibility& visibility) {
    return visiblePixel(world, world.T_r_v[view], view, module, visibility);
}

std::optional<Vector2d> visiblePixel(const World& world, const Isometry3d& T_r_v, std::size_t view, std::size_t module,
                                     const Visibility& visibility) {
    return pixelFrom(world, view, T_r_v, T_r_v, module, world.T_r_u[module], visibility);
}

std::optional<Vector2d> visiblePixel(const World& world, std::size_t view, std::size_t module) {
    return visiblePixel(world, view, module, limitsOf(world));
}

bool scannedAfterBump(const World& world, std::size_t module) {
    return 2 * module >= world.T_r_u.size();
}

std::vector<ViewDetections> simulateDetections(const World& world) {
    const ViewOptions& options = world.scenario.views;
    const Visibility limits = limitsOf(world);
    Random random(world.seed, "detections");
    Random strays(world.seed, "detections that faults bring about");
    std::vector<ViewDetections> views;
    for (std::size_t v = 0; v < world.T_r_v.size(); ++v) {
        ViewDetections view{viewName(v), {}, {}};
        const BumpedView* bump = bumpOf(world, v);
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            const Isometry3d& asLaid = poseAsLaid(world, u);
            const bool isMoved = &asLaid != &world.T_r_u[u];
            const bool isBumped = bump != nullptr && scannedAfterBump(world, u);
            const Isometry3d& T_r_v = isBumped ? bump->T_r_v_after : world.T_r_v[v];
            const auto pixel = pixelFrom(world, v, world.T_r_v[v], T_r_v, u, world.T_r_u[u], limits);
            // What comes into sight or goes out of it by a fault must not shift the noise of all that follows.
            bool usual = pixel.has_value();
            if (isMoved || isBumped)
                usual = pixelFrom(world, v, world.T_r_v[v], world.T_r_v[v], u, asLaid, limits).has_value();
            if (!pixel && !usual)
                continue;
            const Vector2d found = detect(pixel.value_or(Vector2d::Zero()), options, usual ? random : strays);
            if (pixel && world.scenario.camera.contains(found))
                view.found.push_back({world.skin.modules[u].id, found, std::max(1e-3, options.pixelNoise)});
        }
        views.push_back(std::move(view));
    }
    return views;
}

Truth truthOf(const World& world) {
    Truth truth;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
        truth.modules.push_back({world.skin.modules[u].id, world.patchOf[u], world.T_r_u[u]});
    for (std::size_t v = 0; v < world.T_r_v.size(); ++v) {
        truth.views.push_back({viewName(v), world.T_r_v[v]});
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            if (const auto pixel = visiblePixel(world, v, u))
                truth.pixels.push_back({viewName(v), world.skin.modules[u].id, *pixel});
        }
    }
    return truth;
}

}  // namespace skincal
