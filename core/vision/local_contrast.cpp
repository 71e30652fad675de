#include "core/vision/local_contrast.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/vision/parallel.h"

namespace skincal {
namespace {

constexpr int kSum = 16;  // of the weights along an axis; sums of four pixels times that twice just fit into 16 bits

/// The weights from the middle outwards.
std::vector<std::uint16_t> gaussianWeights(double sigma) {
    std::vector<double> exact;
    double sum = 0;
    for (int i = 0; i <= static_cast<int>(std::ceil(2.5 * sigma)); ++i) {
        exact.push_back(std::exp(-0.5 * std::pow(i / sigma, 2)));
        sum += (i == 0 ? 1 : 2) * exact.back();
    }
    std::vector<std::uint16_t> weights;
    int left = kSum;
    for (std::size_t i = 1; i < exact.size(); ++i) {
        weights.push_back(static_cast<std::uint16_t>(std::lround(kSum * exact[i] / sum)));
        left -= 2 * weights.back();
    }
    weights.insert(weights.begin(), static_cast<std::uint16_t>(std::max(0, left)));
    while (weights.size() > 1 && weights.back() == 0)
        weights.pop_back();
    return weights;
}

/// to[x] = sum of weights times a row shifted both ways; `row` goes on for as long as the weights before and after.
void weigh(const std::uint16_t* row, const std::vector<std::uint16_t>& weights, int width, std::uint16_t* to) {
    for (int x = 0; x < width; ++x)
        to[x] = static_cast<std::uint16_t>(weights[0] * row[x]);
    for (int k = 1; k < static_cast<int>(weights.size()); ++k) {
        const std::uint16_t weight = weights[static_cast<std::size_t>(k)];
        for (int x = 0; x < width; ++x)
            to[x] = static_cast<std::uint16_t>(to[x] + weight * (row[x - k] + row[x + k]));
    }
}

cv::Mat smoothRows(const cv::Mat& plane, cv::Size size, const std::vector<std::uint16_t>& weights) {
    const int reach = static_cast<int>(weights.size()) - 1;
    cv::Mat result(size, CV_16U);
    forBands(size.height, [&](int first, int last) {
        const int width = size.width;
        std::vector<std::uint16_t> padded(static_cast<std::size_t>(width + 2 * reach));
        for (int y = first; y < last; ++y) {
            const auto* upper = plane.ptr<std::uint8_t>(2 * y);
            const auto* lower = plane.ptr<std::uint8_t>(2 * y + 1);
            std::uint16_t* row = padded.data() + reach;
            for (int x = 0; x < width; ++x)
                row[x] = static_cast<std::uint16_t>(upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1]);
            std::fill(padded.begin(), padded.begin() + reach, row[0]);
            std::fill(padded.end() - reach, padded.end(), row[width - 1]);
            auto* to = result.ptr<std::uint16_t>(y);
            weigh(row, weights, width, to);
            for (int x = 0; x < width; ++x)
                to[x] = static_cast<std::uint16_t>(to[x] >> 2);
        }
    });
    return result;
}

cv::Mat smoothColumns(const cv::Mat& rows, const std::vector<std::uint16_t>& weights) {
    cv::Mat result(rows.size(), CV_16S);
    const auto rowAt = [&](int y) { return rows.ptr<std::uint16_t>(std::clamp(y, 0, rows.rows - 1)); };
    forBands(rows.rows, [&](int first, int last) {
        const int width = rows.cols;
        std::vector<std::uint16_t> sum(static_cast<std::size_t>(width));
        for (int y = first; y < last; ++y) {
            const std::uint16_t* middle = rowAt(y);
            for (int x = 0; x < width; ++x)
                sum[static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(weights[0] * middle[x]);
            for (int k = 1; k < static_cast<int>(weights.size()); ++k) {
                const std::uint16_t* above = rowAt(y - k);
                const std::uint16_t* below = rowAt(y + k);
                const std::uint16_t weight = weights[static_cast<std::size_t>(k)];
                for (int x = 0; x < width; ++x)
                    sum[static_cast<std::size_t>(x)] =
                        static_cast<std::uint16_t>(sum[static_cast<std::size_t>(x)] + weight * (above[x] + below[x]));
            }
            auto* to = result.ptr<std::int16_t>(y);
            for (int x = 0; x < width; ++x)
                to[x] = static_cast<std::int16_t>(sum[static_cast<std::size_t>(x)] >> 2);
        }
    });
    return result;
}

/// `smooth` less its mean over squares.
cv::Mat lessSurroundings(const cv::Mat& smooth, int side) {
    const int reach = side / 2;
    const float share = 1.0F / static_cast<float>(side * side);
    cv::Mat result(smooth.size(), CV_16S);
    const auto rowAt = [&](int y) { return smooth.ptr<std::int16_t>(std::clamp(y, 0, smooth.rows - 1)); };
    forBands(smooth.rows, [&](int first, int last) {
        const int width = smooth.cols;  // of its own, or the compiler reads it anew after every sum
        // Sums over columns, kept from row to row.
        std::vector<std::int32_t> padded(static_cast<std::size_t>(width + 2 * reach), 0);
        std::vector<std::int32_t> sum(static_cast<std::size_t>(width));
        std::int32_t* column = padded.data() + reach;
        for (int k = -reach - 1; k < reach; ++k) {
            const std::int16_t* row = rowAt(first + k);
            for (int x = 0; x < width; ++x)
                column[x] += row[x];
        }
        for (int y = first; y < last; ++y) {
            const std::int16_t* enters = rowAt(y + reach);
            const std::int16_t* leaves = rowAt(y - reach - 1);
            for (int x = 0; x < width; ++x)
                column[x] += enters[x] - leaves[x];
            std::fill(padded.begin(), padded.begin() + reach, column[0]);
            std::fill(padded.end() - reach, padded.end(), column[width - 1]);
            std::fill(sum.begin(), sum.end(), 0);
            for (int k = -reach; k <= reach; ++k) {
                for (int x = 0; x < width; ++x)
                    sum[static_cast<std::size_t>(x)] += column[x + k];
            }
            const auto* here = smooth.ptr<std::int16_t>(y);
            auto* to = result.ptr<std::int16_t>(y);
            for (int x = 0; x < width; ++x)
                to[x] = static_cast<std::int16_t>(
                    here[x] -
                    static_cast<std::int32_t>(share * static_cast<float>(sum[static_cast<std::size_t>(x)]) + 0.5F));
        }
    });
    return result;
}

}  // namespace

cv::Mat localContrast(const cv::Mat& plane, double smoothing_px, int surroundings) {
    const std::vector<std::uint16_t> weights = gaussianWeights(smoothing_px);
    const cv::Size half(plane.cols / 2, plane.rows / 2);
    return lessSurroundings(smoothColumns(smoothRows(plane, half, weights), weights), surroundings);
}

}  // namespace skincal
