#include "core/study/centre_bound.h"

#include <Eigen/Dense>
#include <cmath>

namespace skincal {
namespace {

constexpr int kRadius = 8;
constexpr double kRounding = 1.0 / 12;

cv::Mat lightAround(const LedSpot& spot, const Vector2d& shift, cv::Point corner, const RenderOptions& options) {
    cv::Mat light = cv::Mat::zeros(2 * kRadius + 1, 2 * kRadius + 1, CV_32F);
    drawLed(light, {spot.pixel + shift - Vector2d(corner.x, corner.y), spot.peak}, options);
    return light;
}

std::optional<double> boundOf(const LedSpot& spot, const std::vector<bool>& isLit, std::span<const cv::Mat> pictures,
                              const RenderOptions& options) {
    constexpr double kStep_px = 0.02;
    constexpr int kTop = 254;
    const cv::Point corner(static_cast<int>(std::lround(spot.pixel.x())) - kRadius,
                           static_cast<int>(std::lround(spot.pixel.y())) - kRadius);
    const auto slope = [&](const Vector2d& axis) {
        cv::Mat difference =
            lightAround(spot, kStep_px * axis, corner, options) - lightAround(spot, -kStep_px * axis, corner, options);
        return cv::Mat(difference / (2 * kStep_px));
    };
    const cv::Mat alongX = slope(Vector2d::UnitX());
    const cv::Mat alongY = slope(Vector2d::UnitY());
    const auto lit = static_cast<double>(std::count(isLit.begin(), isLit.end(), true));
    const double dark = static_cast<double>(isLit.size()) - lit;
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    for (int y = 0; y <= 2 * kRadius; ++y) {
        for (int x = 0; x <= 2 * kRadius; ++x) {
            const cv::Point at = corner + cv::Point(x, y);
            if (!cv::Rect({}, pictures.front().size()).contains(at))
                continue;
            double variance = 0;
            for (std::size_t k = 0; k < isLit.size(); ++k) {
                const int level = pictures[k].at<unsigned char>(at);
                if (level >= kTop)
                    return std::nullopt;
                const double count = isLit[k] ? lit : dark;
                variance +=
                    (options.readNoise * options.readNoise + kRounding + options.shotNoise * level) / (count * count);
            }
            const Vector2d g(static_cast<double>(alongX.at<float>(y, x)), static_cast<double>(alongY.at<float>(y, x)));
            information += g * g.transpose() / variance;
        }
    }
    // A centre that may lie anywhere in the window is not seen.
    if (!(information.determinant() > 1))
        return std::nullopt;
    return std::sqrt(0.5 * information.inverse().trace());
}

}  // namespace

std::vector<std::optional<double>> centreBounds(const World& world, std::span<const LedSpot> spots,
                                                std::span<const FrameInfo> frames, std::span<const cv::Mat> pictures) {
    std::vector<std::vector<bool>> isLit(spots.size(), std::vector<bool>(frames.size(), false));
    const auto index = world.skin.indexById();
    for (std::size_t k = 0; k < frames.size(); ++k) {
        for (const LitModule& lit : frames[k].lit)
            isLit[index.at(lit.module)][k] = true;
    }
    std::vector<std::optional<double>> bounds(spots.size());
    for (std::size_t u = 0; u < spots.size(); ++u) {
        const auto lit = static_cast<std::size_t>(std::count(isLit[u].begin(), isLit[u].end(), true));
        if (spots[u].peak > 0 && lit > 0 && lit < frames.size())
            bounds[u] = boundOf(spots[u], isLit[u], pictures, world.scenario.pictures);
    }
    return bounds;
}

}  // namespace skincal
