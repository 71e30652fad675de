#include "core/study/scan_score.h"

#include <algorithm>
#include <cmath>

#include "core/simulation/renderer.h"
#include "core/study/scan_world.h"

namespace skincal {
namespace {

// Where a module's LED shows: one place, two in a view whose camera is knocked, or none where it is out of sight.
std::vector<Vector2d> placesOf(const World& world, std::size_t module) {
    if (!visiblePixel(world, world.T_r_v[kScanView], kScanView, module, visibilityOfLight()))
        return {};
    std::vector<Isometry3d> poses{world.T_r_v[kScanView]};
    if (world.scenario.disturbances.bump_px > 0)
        poses.push_back(poses.front() * makeIsometry(bumpOf(world.scenario), Vector3d::Zero()));
    std::vector<Vector2d> places;
    for (const Isometry3d& T_r_v : poses) {
        const Vector3d led_v = T_r_v.inverse() * (world.T_r_u[module] * world.trueTemplate(module).led);
        if (const auto pixel = world.scenario.camera.project(led_v))
            places.push_back(*pixel);
    }
    return places;
}

double distanceTo(const std::vector<Vector2d>& places, const Vector2d& pixel) {
    double nearest = 1e9;
    for (const Vector2d& place : places)
        nearest = std::min(nearest, (place - pixel).norm());
    return nearest;
}

}  // namespace

double ScanScore::foundShare() const {
    return visible > 0 ? static_cast<double>(found + settled) / static_cast<double>(visible) : 1;
}

double ScanScore::rms_px() const {
    return found > 0 ? std::sqrt(squaredError / (2 * static_cast<double>(found))) : 0;
}

double ScanScore::rmsSigmas() const {
    return found > 0 ? std::sqrt(squaredSigmas / (2 * static_cast<double>(found))) : 0;
}

double ScanScore::rmsBounds() const {
    return sharp > 0 ? std::sqrt(squaredBounds / (2 * static_cast<double>(sharp))) : 0;
}

void ScanScore::add(const ScanScore& other) {
    views += other.views;
    refused += other.refused;
    frames += other.frames;
    visible += other.visible;
    found += other.found;
    choices += other.choices;
    settled += other.settled;
    wrong += other.wrong;
    squaredError += other.squaredError;
    squaredSigmas += other.squaredSigmas;
    sharp += other.sharp;
    squaredBounds += other.squaredBounds;
    sharpSigmas += other.sharpSigmas;
    seconds += other.seconds;
}

ScanScore scoreOf(const World& world, const ViewDetections& view, std::span<const LedDetection> taken,
                  std::span<const std::optional<double>> bounds) {
    const auto index = world.skin.indexById();
    ScanScore result;
    result.views = 1;
    std::vector<bool> visible(world.T_r_u.size());
    std::vector<std::vector<Vector2d>> placesOfAll(world.T_r_u.size());
    for (std::size_t u = 0; u < visible.size(); ++u) {
        visible[u] = visiblePixel(world, kScanView, u).has_value();
        result.visible += visible[u] ? 1U : 0U;
        placesOfAll[u] = placesOf(world, u);
    }
    const auto isNearerToAnother = [&](std::size_t own, const Vector2d& pixel, double error) {
        for (std::size_t u = 0; u < placesOfAll.size(); ++u) {
            if (u != own && distanceTo(placesOfAll[u], pixel) < error)
                return true;
        }
        return false;
    };
    const auto isWrong = [&](std::size_t u, const Vector2d& pixel) {
        // Where they are a few pixels apart, that is little; errors are hundredths elsewhere.
        constexpr double kNear_px = 0.5;
        const double error = distanceTo(placesOfAll[u], pixel);
        return error > ScanScore::kElsewhere_px || (error > kNear_px && isNearerToAnother(u, pixel, error));
    };
    std::vector<bool> isTaken(visible.size(), false);
    for (const LedDetection& one : taken) {
        const std::size_t u = index.at(one.module);
        isTaken[u] = true;
        if (isWrong(u, one.pixel))
            ++result.wrong;
        else if (visible[u])
            ++result.settled;
    }
    for (const LedDetection& found : view.found) {
        const std::size_t u = index.at(found.module);
        const double error = distanceTo(placesOfAll[u], found.pixel);
        if (isWrong(u, found.pixel)) {
            ++result.wrong;
        } else if (visible[u]) {
            ++result.found;
            result.squaredError += error * error;
            result.squaredSigmas += error * error / (found.sigma_px * found.sigma_px);
            if (!bounds.empty() && bounds[u]) {
                ++result.sharp;
                result.squaredBounds += error * error / (*bounds[u] * *bounds[u]);
                result.sharpSigmas += error * error / (found.sigma_px * found.sigma_px);
            }
        }
    }
    for (const Undetected& missing : view.undetected) {
        const std::size_t u = index.at(missing.module);
        const bool handedOn = std::any_of(missing.spots.begin(), missing.spots.end(), [&](const SpotChoice& spot) {
            return distanceTo(placesOfAll[u], spot.pixel) <= ScanScore::kElsewhere_px;
        });
        result.choices += visible[u] && handedOn && !isTaken[u] ? 1U : 0U;
    }
    return result;
}

}  // namespace skincal
