#include "core/vision/spot_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/core/utility.hpp>
#include <stdexcept>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

constexpr int kCore = 2;
// exp(-r^2 / 2 s^2) with s = 1.2 at r = 0, 1, 2.
constexpr std::array<double, 3> kTap{1.0, 0.70665, 0.24935};
constexpr int kLargestRadius = 30;
constexpr int kLevels = 3 * 255 + 1;  // of three channels together

/// @param pixel  grey level of a place times some whole number, as an int
template <class Pixel>
SpotBrightness brightness(cv::Size size, const SpotCandidate& spot, int radius, double scale, const Pixel& pixel) {
    double sum = 0;
    double weights = 0;
    SpotBrightness result;
    for (int dy = -kCore; dy <= kCore; ++dy) {
        const int y = spot.y + dy;
        if (y < 0 || y >= size.height)
            continue;
        for (int dx = -kCore; dx <= kCore; ++dx) {
            const int x = spot.x + dx;
            if (x < 0 || x >= size.width)
                continue;
            const double weight =
                kTap[static_cast<std::size_t>(std::abs(dx))] * kTap[static_cast<std::size_t>(std::abs(dy))];
            sum += weight * pixel(x, y);
            weights += weight;
        }
    }
    std::array<int, std::size_t{8} * kLargestRadius> edge{};
    std::size_t count = 0;
    const auto visit = [&](int x, int y) {
        if (x >= 0 && y >= 0 && x < size.width && y < size.height)
            edge[count++] = pixel(x, y);
    };
    for (int i = -radius; i < radius; ++i) {
        visit(spot.x + i, spot.y - radius);
        visit(spot.x + radius, spot.y + i);
        visit(spot.x - i, spot.y + radius);
        visit(spot.x - radius, spot.y - i);
    }
    if (count > 0) {
        // The darker half by counting: there are few levels, and this is done for every spot in every plane.
        const std::size_t half = (count + 1) / 2;
        std::array<std::uint8_t, kLevels> counts{};
        int level = kLevels;
        for (std::size_t i = 0; i < count; ++i) {
            ++counts[static_cast<std::size_t>(edge[i])];
            level = std::min(level, edge[i]);
        }
        int darker = 0;
        for (std::size_t left = half; left > 0; ++level) {
            const auto here = std::min<std::size_t>(left, counts[static_cast<std::size_t>(level)]);
            darker += level * static_cast<int>(here);
            left -= here;
        }
        result.around = scale * darker / static_cast<double>(half);
    }
    result.level = scale * sum / weights;
    result.value = result.level - result.around;
    return result;
}

}  // namespace

SpotBrightness spotBrightness(const FramePixels& frame, const SpotCandidate& spot, int radius, int channel) {
    if (radius > kLargestRadius)
        throw std::logic_error("spotBrightness: the window is too large");
    const cv::Mat& picture = frame.picture();
    SpotBrightness result;
    if (picture.channels() == 1) {
        result = brightness(picture.size(), spot, radius, 1, [&](int x, int y) { return int{picture.ptr(y)[x]}; });
    } else if (channel >= 0) {
        result = brightness(picture.size(), spot, radius, 1,
                            [&](int x, int y) { return int{picture.ptr(y)[3 * x + channel]}; });
    } else {
        result = brightness(picture.size(), spot, radius, 1.0 / 3, [&](int x, int y) {
            const std::uint8_t* pixel = picture.ptr(y) + static_cast<std::ptrdiff_t>(3) * x;
            return int{pixel[0]} + pixel[1] + pixel[2];
        });
    }
    return result;
}

bool isClippedNear(const FramePixels& frame, const SpotCandidate& spot, int radius, int channel) {
    const cv::Rect window =
        cv::Rect(spot.x - radius, spot.y - radius, 2 * radius + 1, 2 * radius + 1) & cv::Rect({}, frame.size());
    for (int y = window.y; y < window.y + window.height; ++y) {
        for (int x = window.x; x < window.x + window.width; ++x) {
            if (frame.saturated(x, y, channel))
                return true;
        }
    }
    return false;
}

double spotBrightnessSigma(const ImageNoise& noise, double level, int radius) {
    const double sum = kTap[0] + 2 * (kTap[1] + kTap[2]);
    const double squares = kTap[0] * kTap[0] + 2 * (kTap[1] * kTap[1] + kTap[2] * kTap[2]);
    const double core = std::pow(squares / (sum * sum), 2);
    return std::sqrt(noise.variance(level) * core + surroundingsVariance(noise, level, radius));
}

double surroundingsVariance(const ImageNoise& noise, double around, int radius) {
    // The mean of a darker half is less sharp than that of all by about pi / 2, as a median is.
    return noise.variance(around) * std::numbers::pi / 2 / (8 * radius);
}

SpotSeries::SpotSeries(std::size_t planes, std::size_t spots)
    : light(static_cast<Eigen::Index>(planes), static_cast<Eigen::Index>(spots)),
      around(light.rows(), light.cols()),
      level(Eigen::VectorXd::Zero(light.cols())),
      clipped(spots, 0) {}

void SpotSeries::read(const FramePixels& frame, std::span<const SpotCandidate> spots, int radius, std::size_t plane,
                      int channel) {
    const auto row = static_cast<Eigen::Index>(plane);
    cv::parallel_for_(cv::Range(0, static_cast<int>(spots.size())), [&](const cv::Range& range) {
        for (int i = range.start; i < range.end; ++i) {
            const SpotBrightness read = spotBrightness(frame, spots[static_cast<std::size_t>(i)], radius, channel);
            light(row, i) = static_cast<float>(read.value);
            around(row, i) = static_cast<float>(read.around);
            level[i] = std::max(level[i], read.level);
            const auto spot = static_cast<std::size_t>(i);
            if (clipped[spot] == 0 && isClippedNear(frame, spots[spot], radius, channel))
                clipped[spot] = 1;
        }
    });
}

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
