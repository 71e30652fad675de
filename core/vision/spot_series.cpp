#include "core/vision/spot_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/core/utility.hpp>
#include <stdexcept>

namespace skincal {
namespace {

constexpr int kCore = 2;
constexpr int kMiddle = 0;
// exp(-r^2 / 2 s^2) with s = 1.2 at r = 0, 1, 2.
constexpr std::array<double, 3> kTap{1.0, 0.70665, 0.24935};
constexpr int kLargestRadius = 30;
constexpr std::size_t kLevels = 256;
constexpr std::size_t kLevelsOfSum = 3 * 255 + 1;  // of three channels together

/// Mean of the darker half of `count` values, by counting: there are few levels, and this is done for every spot in
/// every plane.
template <std::size_t levels>
double darkerHalf(const int* values, std::size_t count) {
    const std::size_t half = (count + 1) / 2;
    std::array<std::uint8_t, levels> counts{};
    int level = static_cast<int>(levels);
    for (std::size_t i = 0; i < count; ++i) {
        ++counts[static_cast<std::size_t>(values[i])];
        level = std::min(level, values[i]);
    }
    int darker = 0;
    for (std::size_t left = half; left > 0; ++level) {
        const auto here = std::min<std::size_t>(left, counts[static_cast<std::size_t>(level)]);
        darker += level * static_cast<int>(here);
        left -= here;
    }
    return darker / static_cast<double>(half);
}

/// @param pixel  grey level of a place times some whole number, as an int below `levels`
template <std::size_t levels, class Pixel>
SpotBrightness brightness(cv::Size size, const SpotCandidate& spot, int radius, double scale, const Pixel& pixel) {
    const cv::Rect picture({}, size);
    const auto around = [&](int reach) {
        return cv::Rect(spot.x - reach, spot.y - reach, 2 * reach + 1, 2 * reach + 1);
    };
    double sum = 0;
    double weights = 0;
    const cv::Rect core = around(kCore) & picture;
    for (int y = core.y; y < core.y + core.height; ++y) {
        const double tap = kTap[static_cast<std::size_t>(std::abs(y - spot.y))];
        for (int x = core.x; x < core.x + core.width; ++x) {
            const double weight = tap * kTap[static_cast<std::size_t>(std::abs(x - spot.x))];
            sum += weight * pixel(x, y);
            weights += weight;
        }
    }
    std::array<int, std::size_t{8} * kLargestRadius> edge;
    std::size_t count = 0;
    const bool isInside = (around(radius) & picture) == around(radius);
    const auto visit = [&](int x, int y) {
        if (isInside || picture.contains({x, y}))
            edge[count++] = pixel(x, y);
    };
    for (int i = -radius; i < radius; ++i) {
        visit(spot.x + i, spot.y - radius);
        visit(spot.x + radius, spot.y + i);
        visit(spot.x - i, spot.y + radius);
        visit(spot.x - radius, spot.y - i);
    }
    SpotBrightness result;
    if (count > 0)
        result.around = scale * darkerHalf<levels>(edge.data(), count);
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
        result = brightness<kLevels>(
            picture.size(), spot, radius, 1, [data = picture.data, step = picture.step[0]](int x, int y) {
                return int{data[static_cast<std::size_t>(y) * step + static_cast<std::size_t>(x)]};
            });
    } else if (channel >= 0) {
        result = brightness<kLevels>(picture.size(), spot, radius, 1,
                                     [&](int x, int y) { return int{picture.ptr(y)[3 * x + channel]}; });
    } else {
        result = brightness<kLevelsOfSum>(picture.size(), spot, radius, 1.0 / 3, [&](int x, int y) {
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
      clipped(spots, 0),
      isFull(Eigen::Array<std::uint8_t, Eigen::Dynamic, Eigen::Dynamic>::Zero(light.rows(), light.cols())) {}

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
            isFull(row, i) = isClippedNear(frame, spots[spot], kMiddle, channel) ? 1 : 0;
            if (clipped[spot] == 0 && isClippedNear(frame, spots[spot], radius, channel))
                clipped[spot] = 1;
        }
    });
}

}  // namespace skincal
