#include "core/vision/exposure_gains.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/statistics.h"

namespace skincal {

std::vector<double> exposureGains(const SpotSeries& series, std::span<const double> sigma,
                                  std::span<const std::size_t> litCount) {
    constexpr double kStrong = 3;
    constexpr double kGround = 0.4;
    constexpr std::size_t kFewest = 3;
    constexpr double kLeastStep = 0.05;
    constexpr double kLeastPart = 0.3;
    const Eigen::Index planes = series.light.rows();
    std::vector<double> gains(static_cast<std::size_t>(planes), 1);
    std::vector<Eigen::Index> spots;
    std::vector<double> strongest;
    std::vector<double> highest(series.clipped.size());  // level
    std::vector<float> values(static_cast<std::size_t>(planes));
    for (Eigen::Index i = 0; i < series.light.cols(); ++i) {
        // But for the top tenth, which a flash may have.
        Eigen::Map<Eigen::VectorXf>(values.data(), planes) = series.light.col(i);
        const auto high = values.begin() + static_cast<std::ptrdiff_t>(9 * (values.size() - 1) / 10);
        std::nth_element(values.begin(), high, values.end());
        const auto low = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 10);
        std::nth_element(values.begin(), low, high);
        // A spot on ground that is brighter than its surroundings looks lit at a shorter exposure where it is dark.
        if (static_cast<double>(*high) > kStrong * sigma[static_cast<std::size_t>(i)] &&
            static_cast<double>(*low) < kGround * static_cast<double>(*high)) {
            spots.push_back(i);
            strongest.push_back(static_cast<double>(*high));
            Eigen::Map<Eigen::VectorXf>(values.data(), planes) = series.light.col(i) + series.around.col(i);
            std::nth_element(values.begin(), high, values.end());
            highest[static_cast<std::size_t>(i)] = static_cast<double>(*high);
        }
    }
    // Skirts and reflections shine with several LEDs at once, and tell nothing.
    constexpr double kOfStrong = 0.2;
    if (!strongest.empty()) {
        std::vector<double> sorted = strongest;
        std::sort(sorted.begin(), sorted.end());
        const double least = kOfStrong * sorted[9 * (sorted.size() - 1) / 10];
        std::size_t kept = 0;
        for (std::size_t i = 0; i < spots.size(); ++i) {
            if (strongest[i] < least)
                continue;
            spots[kept] = spots[i];
            strongest[kept++] = strongest[i];
        }
        spots.resize(kept);
        strongest.resize(kept);
    }
    std::vector<std::size_t> told;
    std::vector<std::pair<double, Eigen::Index>> shares;
    std::vector<double> levels(gains.size(), 1);
    const auto levelAt = [&](Eigen::Index k, Eigen::Index spot) {
        return static_cast<double>(series.light(k, spot) + series.around(k, spot));
    };
    for (std::size_t k = 0; k < gains.size(); ++k) {
        if (litCount[k] < kFewest || spots.size() < kFewest)
            continue;
        shares.clear();
        for (std::size_t i = 0; i < spots.size(); ++i) {
            const auto light = static_cast<double>(series.light(static_cast<Eigen::Index>(k), spots[i]));
            if (light > kStrong * sigma[static_cast<std::size_t>(spots[i])])
                shares.emplace_back(light / strongest[i], spots[i]);
        }
        if (shares.size() < kFewest)
            continue;
        std::sort(shares.begin(), shares.end());
        const double top = shares[9 * (shares.size() - 1) / 10].first;
        const auto shining =
            std::partition_point(shares.begin(), shares.end(), [&](const auto& s) { return s.first < 0.5 * top; });
        const auto count = static_cast<std::size_t>(shares.end() - shining);
        // Less than that is what stray light makes of LEDs that nobody sees.
        constexpr double kLeastShare = 0.1;
        if (top < kLeastShare || count < kFewest)
            continue;
        // A lamp leaves less of its range to a clipped LED; then the spots are brighter, as a shorter exposure makes
        // none.
        std::vector<double> here;
        for (auto spot = shining; spot != shares.end(); ++spot)
            here.push_back(levelAt(static_cast<Eigen::Index>(k), spot->second) /
                           highest[static_cast<std::size_t>(spot->second)]);
        gains[k] = (shining + static_cast<std::ptrdiff_t>(count / 2))->first;
        levels[k] = median(std::move(here));
        told.push_back(k);
    }
    std::vector<double> all;
    for (const std::size_t k : told)
        all.push_back(gains[k]);
    if (all.empty())
        return gains;
    const double usual = median(std::move(all));
    all.clear();
    for (const std::size_t k : told)
        all.push_back(levels[k]);
    const double usualLevel = median(std::move(all));
    for (const std::size_t k : told) {
        gains[k] /= usual;
        if (std::abs(gains[k] - 1) < kLeastStep || std::log(levels[k] / usualLevel) / std::log(gains[k]) < kLeastPart)
            gains[k] = 1;
    }
    return gains;
}

}  // namespace skincal
