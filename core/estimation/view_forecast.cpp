#include "core/estimation/view_forecast.h"

#include <algorithm>
#include <cmath>

namespace skincal {
namespace {

struct Board {
    Isometry3d T_r_u = Isometry3d::Identity();
    double radius = 0;
};

std::vector<Board> boardsOf(const AdviceBasis& basis) {
    std::vector<Board> boards;
    for (std::size_t u = 0; u < basis.state.T_r_u.size(); ++u) {
        if (basis.isPlaced(u))
            boards.push_back({*basis.state.T_r_u[u], basis.used.skin->templateOf(u).portRadius()});
    }
    return boards;
}

/// Whether a board is in the way; those round about the LED lie in the same skin and are not.
bool isHidden(const Vector3d& led, const Vector3d& camera, const std::vector<Board>& boards) {
    const Vector3d ray = camera - led;
    for (const Board& board : boards) {
        const Vector3d to = board.T_r_u.translation() - led;
        const auto normal = board.T_r_u.linear().col(2);
        constexpr double kNearby = 4;
        if (to.squaredNorm() < kNearby * kNearby * board.radius * board.radius)
            continue;
        const double along = to.dot(normal) / ray.dot(normal);
        if (along > 0 && along < 1 && (along * ray - to).squaredNorm() < board.radius * board.radius)
            return true;
    }
    return false;
}

}  // namespace

bool UnseenModules::isHidden(std::size_t module) const {
    return std::binary_search(hidden.begin(), hidden.end(), module);
}

UnseenModules unseenModules(const AdviceBasis& basis, const ViewLimits& limits) {
    std::vector<bool> seen(basis.state.T_r_u.size(), false);
    for (const PixelObservation& o : basis.used.pixels)
        seen[o.module] = true;
    std::vector<int> expected(seen.size(), 0);
    for (const auto& T_r_v : basis.state.T_r_v) {
        if (!T_r_v || basis.used.camera == nullptr)
            continue;
        const auto pixels = forecastPixels(basis, *T_r_v, limits);
        for (std::size_t u = 0; u < seen.size(); ++u)
            expected[u] += pixels[u] ? 1 : 0;
    }
    // One view may miss an LED for many a reason.
    constexpr int kEnough = 2;
    UnseenModules modules;
    for (std::size_t u = 0; u < seen.size(); ++u) {
        if (basis.isPlaced(u) && !seen[u])
            (expected[u] >= kEnough ? modules.hidden : modules.unseen).push_back(u);
    }
    return modules;
}

std::vector<std::optional<Vector2d>> forecastPixels(const AdviceBasis& basis, const Isometry3d& T_r_v,
                                                    const ViewLimits& limits) {
    const CameraModel& camera = *basis.used.camera;
    const Isometry3d T_v_r = T_r_v.inverse();
    const std::vector<Board> boards = boardsOf(basis);
    std::vector<std::optional<Vector2d>> pixels(basis.state.T_r_u.size());
    for (std::size_t u = 0; u < pixels.size(); ++u) {
        if (!basis.isPlaced(u))
            continue;
        const Isometry3d& T_r_u = *basis.state.T_r_u[u];
        const Vector3d led = T_r_u * basis.used.skin->templateOf(u).led;
        const Vector3d ray = (T_r_v.translation() - led).normalized();
        const Vector3d led_v = T_v_r * led;
        const auto pixel = camera.project(led_v);
        if (T_r_u.linear().col(2).dot(ray) < std::cos(limits.maxAngle) || !pixel || pixel->x() < limits.margin_px ||
            pixel->y() < limits.margin_px || pixel->x() > camera.width - 1 - limits.margin_px ||
            pixel->y() > camera.height - 1 - limits.margin_px)
            continue;
        // Far out of the picture a lens polynomial may fold back into it.
        const Vector2d straight = led_v.head<2>() / led_v.z();
        constexpr double kSame = 1e-3;
        if ((camera.unproject(*pixel) - straight).norm() > kSame || isHidden(led, T_r_v.translation(), boards))
            continue;
        pixels[u] = *pixel;
    }
    return pixels;
}

}  // namespace skincal
