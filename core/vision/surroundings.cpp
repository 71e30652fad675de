#include "core/vision/surroundings.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

/// Ground follows its surroundings by a share of what they do; skin and boards differ by half from what is around them.
constexpr double kMostShare = 0.5;

}  // namespace

Ambient ambientOf(const Codebook& codebook, const Eigen::VectorXf& around, std::span<const double> gains,
                  double sigma) {
    Ambient ambient;
    if (around.size() == 0 || codebook.coloured)
        return ambient;
    ambient.light = around.cast<double>();
    for (Eigen::Index k = 0; k < ambient.light.size(); ++k)
        ambient.light[k] /= gains[static_cast<std::size_t>(k)];
    ambient.ridge = std::pow(sigma / kMostShare, 2);
    return ambient;
}

std::vector<std::uint8_t> calmPlanes(const Eigen::VectorXf& around, std::span<const double> gains,
                                     std::span<const std::uint8_t> used) {
    constexpr double kLevels = 8;
    constexpr double kSpreads = 6;  // of a median absolute deviation
    const auto levelAt = [&](std::size_t k) {
        return static_cast<double>(around[static_cast<Eigen::Index>(k)]) / gains[k];
    };
    std::vector<double> levels;
    for (std::size_t k = 0; k < used.size(); ++k) {
        if (used[k] != 0)
            levels.push_back(levelAt(k));
    }
    const double usual = median(levels);
    for (double& level : levels)
        level = std::abs(level - usual);
    const double most = std::max(kLevels, kSpreads * median(std::move(levels)));
    std::vector<std::uint8_t> calm(used.begin(), used.end());
    for (std::size_t k = 0; k < calm.size(); ++k) {
        if (std::abs(levelAt(k) - usual) > most)
            calm[k] = 0;
    }
    return calm;
}

}  // namespace skincal
