#include "core/vision/image_noise.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numeric>

namespace skincal {
namespace {

// One pixel of so many is looked at.
constexpr int kColumns = 4;
constexpr int kRows = 8;

// Two neighbours that change by no more together, grey levels, are still. The sum of normal numbers says nothing of
// their difference: to choose by it makes noise neither more nor less.
constexpr int kStill = 12;

// Half-width that holds 68.27 % of |difference|, as a continuous number: a difference of j stands for j ± 0.5.
double centralSpread(const std::uint32_t* counts, int size, double total) {
    const double wanted = 0.6827 * total;
    double below = 0;
    for (int j = 0; j < size; ++j) {
        const double here = counts[j];
        if (below + here >= wanted) {
            const double low = j == 0 ? 0.0 : j - 0.5;
            return low + (j + 0.5 - low) * (wanted - below) / here;
        }
        below += here;
    }
    return size - 0.5;
}

template <class Histogram>
double totalOf(const Histogram& histogram) {
    double total = 0;
    for (const auto& counts : histogram)
        total += std::accumulate(counts.begin(), counts.end(), 0.0);
    return total;
}

}  // namespace

void ImageNoiseEstimator::add(const cv::Mat& a, const cv::Mat& b) {
    for (int y = kRows / 2; y < a.rows; y += kRows) {
        const auto* pa = a.ptr<std::uint8_t>(y);
        const auto* pb = b.ptr<std::uint8_t>(y);
        for (int x = kColumns / 2; x + 1 < a.cols; x += kColumns) {
            // Clipped values have lost their noise. Who left out the darkest of a grey level alone would see less of it
            // than there is: sums, which say nothing of differences, leave out the levels of which any are clipped.
            constexpr int kClearOfBlack = 14;
            if (std::max({pa[x], pb[x], pa[x + 1], pb[x + 1]}) >= 250) {
                ++white_;
                continue;
            }
            if (std::min(pa[x] + pb[x], pa[x + 1] + pb[x + 1]) < kClearOfBlack ||
                std::min({pa[x], pb[x], pa[x + 1], pb[x + 1]}) <= 3) {
                ++black_;
                continue;
            }
            const int level = (pa[x] + pb[x]) / 2 * kClasses / 256;
            const int here = pa[x] - pb[x];
            const int beside = pa[x + 1] - pb[x + 1];
            const int difference = std::min(std::abs(here - beside), kDifferences - 1);
            ++(std::abs(here + beside) <= kStill
                   ? still_
                   : changed_)[static_cast<std::size_t>(level)][static_cast<std::size_t>(difference)];
        }
    }
}

ImageNoise ImageNoiseEstimator::estimate() const {
    constexpr double kFewest = 200;
    // Where a lamp flickers hardly any pixel is still; elsewhere those that are not are LEDs and people.
    constexpr double kLamp = 0.5;
    const bool isFlickering = totalOf(changed_) > kLamp * (totalOf(still_) + totalOf(changed_));
    Eigen::Matrix2d H = Eigen::Matrix2d::Zero();
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
    double weights = 0;
    double mean = 0;
    int classes = 0;
    for (int level = 0; level < kClasses; ++level) {
        Counts counts = still_[static_cast<std::size_t>(level)];
        if (isFlickering) {
            const Counts& changed = changed_[static_cast<std::size_t>(level)];
            std::transform(counts.begin(), counts.end(), changed.begin(), counts.begin(), std::plus<>());
        }
        const double total = std::accumulate(counts.begin(), counts.end(), 0.0);
        if (total < kFewest)
            continue;
        const double spread = centralSpread(counts.data(), kDifferences, total);
        // Two pixels in two pictures: four independent draws.
        const double variance = spread * spread / 4;
        const Eigen::Vector2d row(1.0, (level + 0.5) * 256.0 / kClasses);
        const double weight = total / (variance * variance + 1e-3);
        H += weight * row * row.transpose();
        g += weight * variance * row;
        weights += weight;
        mean += weight * variance;
        ++classes;
    }
    // Of a room that is wholly dark a webcam's, at least: all the light there is comes from LEDs, and has shot noise.
    constexpr double kWebcamGain = 0.01;
    if (classes == 0)
        return {ImageNoise{}.read, black_ > white_ ? kWebcamGain : 0.0};
    constexpr double kQuantisation = 1.0 / 12;
    ImageNoise noise{std::max(mean / weights, kQuantisation), 0.0};
    if (classes == 1)
        return noise;
    const Eigen::Vector2d line = H.ldlt().solve(g);
    if (line[1] <= 0)
        return noise;
    if (line[0] >= kQuantisation)
        return {line[0], line[1]};
    return {kQuantisation, std::max(0.0, (g[1] - kQuantisation * H(0, 1)) / H(1, 1))};
}

}  // namespace skincal
