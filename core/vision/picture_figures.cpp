#include "core/vision/picture_figures.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace skincal {
namespace {

constexpr double kPixelsLookedAt = 100'000;
constexpr double kFlat = 2;

struct Sums {
    std::int64_t laplacian = 0;
    std::int64_t laplacian2 = 0;
    std::int64_t inner = 0;
    std::uint32_t dark = 0;
    std::uint32_t bright = 0;
};

template <int kChannels>
void addRow(const cv::Mat& picture, int y, int step, PictureFigures& figures, Sums& sums) {
    constexpr int kGreen = kChannels == 1 ? 0 : 1;
    const std::uint8_t* row = picture.ptr<std::uint8_t>(y);
    const bool innerRow = y > 0 && y + 1 < picture.rows;
    const std::uint8_t* above = innerRow ? picture.ptr<std::uint8_t>(y - 1) : nullptr;
    const std::uint8_t* below = innerRow ? picture.ptr<std::uint8_t>(y + 1) : nullptr;
    for (int x = 0; x < picture.cols; x += step) {
        const std::ptrdiff_t i = static_cast<std::ptrdiff_t>(x) * kChannels + kGreen;
        const int value = row[i];
        ++figures.histogram[static_cast<std::size_t>(value)];
        int most = value;
        if constexpr (kChannels > 1)
            most = std::max({value, static_cast<int>(row[i - 1]), static_cast<int>(row[i + 1])});
        sums.dark += most <= kDarkLevel ? 1U : 0U;
        sums.bright += most >= kBrightLevel ? 1U : 0U;
        if (innerRow && x > 0 && x + 1 < picture.cols) {
            const int laplacian = row[i - kChannels] + row[i + kChannels] + above[i] + below[i] - 4 * value;
            sums.laplacian += laplacian;
            sums.laplacian2 += static_cast<std::int64_t>(laplacian) * laplacian;
            ++sums.inner;
        }
    }
}

double variance(double sum, double sum2, double count) {
    return count > 0 ? std::max(0.0, sum2 / count - (sum / count) * (sum / count)) : 0.0;
}

}  // namespace

PictureFigures figuresOf(const cv::Mat& picture) {
    PictureFigures figures;
    if (picture.empty())
        return figures;
    const int channels = picture.channels();
    if (picture.depth() != CV_8U || picture.dims != 2 || (channels != 1 && channels != 3 && channels != 4))
        throw std::logic_error("figuresOf: a picture of 8 bits and 1, 3 or 4 channels");
    const double total = static_cast<double>(picture.rows) * picture.cols;
    const int step = std::max(1, static_cast<int>(std::sqrt(total / kPixelsLookedAt)));
    Sums sums;
    for (int y = 0; y < picture.rows; y += step) {
        if (channels == 1)
            addRow<1>(picture, y, step, figures, sums);
        else if (channels == 3)
            addRow<3>(picture, y, step, figures, sums);
        else
            addRow<4>(picture, y, step, figures, sums);
    }
    double sum = 0;
    double sum2 = 0;
    for (std::size_t i = 0; i < figures.histogram.size(); ++i) {
        const double level = static_cast<double>(i);
        const double count = figures.histogram[i];
        figures.pixels += figures.histogram[i];
        sum += level * count;
        sum2 += level * level * count;
    }
    figures.dark = static_cast<double>(sums.dark) / figures.pixels;
    figures.bright = static_cast<double>(sums.bright) / figures.pixels;
    const double spread = variance(sum, sum2, figures.pixels);
    if (spread >= kFlat * kFlat)
        figures.sharpness = variance(static_cast<double>(sums.laplacian), static_cast<double>(sums.laplacian2),
                                     static_cast<double>(sums.inner)) /
                            spread;
    return figures;
}

}  // namespace skincal
