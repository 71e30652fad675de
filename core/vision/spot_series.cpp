#include "core/vision/spot_series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

constexpr int kCore = 2;
// exp(-r^2 / 2 s^2) with s = 1.2 at r = 0, 1, 2.
constexpr std::array<double, 3> kTap{1.0, 0.70665, 0.24935};

// Median of the window's edge: what lamps and exposure do to it in this frame. Neighbouring spots hardly count.
double edgeLevel(const FramePixels& frame, const SpotCandidate& spot, int radius, int channel) {
    const cv::Size size = frame.size();
    std::vector<double> edge;
    edge.reserve(8 * static_cast<std::size_t>(radius));
    const auto visit = [&](int x, int y) {
        if (x >= 0 && y >= 0 && x < size.width && y < size.height)
            edge.push_back(frame.value(x, y, channel));
    };
    for (int i = -radius; i < radius; ++i) {
        visit(spot.x + i, spot.y - radius);
        visit(spot.x + radius, spot.y + i);
        visit(spot.x - i, spot.y + radius);
        visit(spot.x - radius, spot.y - i);
    }
    if (edge.empty())
        return 0;
    return median(std::move(edge));
}

Eigen::RowVectorXd weightsOf(const Codebook& codebook, std::span<const std::size_t> words, std::size_t index,
                             std::span<const std::uint8_t> used) {
    const Eigen::MatrixXd weights = amplitudeWeights(codebook, words, used);
    if (static_cast<Eigen::Index>(index) >= weights.rows())
        throw std::logic_error("AmplitudeMap: words that can't be separated");
    return weights.row(static_cast<Eigen::Index>(index));
}

}  // namespace

SpotBrightness spotBrightness(const FramePixels& frame, const SpotCandidate& spot, int radius, int channel) {
    const cv::Size size = frame.size();
    double sum = 0;
    double weights = 0;
    for (int dy = -kCore; dy <= kCore; ++dy) {
        for (int dx = -kCore; dx <= kCore; ++dx) {
            const int x = spot.x + dx;
            const int y = spot.y + dy;
            if (x < 0 || y < 0 || x >= size.width || y >= size.height)
                continue;
            const double weight =
                kTap[static_cast<std::size_t>(std::abs(dx))] * kTap[static_cast<std::size_t>(std::abs(dy))];
            sum += weight * frame.value(x, y, channel);
            weights += weight;
        }
    }
    const double level = sum / weights;
    return {level - edgeLevel(frame, spot, radius, channel), level};
}

double spotBrightnessSigma(const ImageNoise& noise, double level, int radius) {
    const double sum = kTap[0] + 2 * (kTap[1] + kTap[2]);
    const double squares = kTap[0] * kTap[0] + 2 * (kTap[1] * kTap[1] + kTap[2] * kTap[2]);
    const double core = std::pow(squares / (sum * sum), 2);
    // A median is less sharp than a mean by pi / 2.
    const double edge = std::numbers::pi / 2 / (8 * radius);
    return std::sqrt(noise.variance(level) * (core + edge));
}

AmplitudeMap::AmplitudeMap(const SpotCandidate& spot, int radius, cv::Size picture, const Codebook& codebook,
                           std::span<const std::size_t> words, std::size_t index, std::span<const std::uint8_t> used)
    : spot_(spot),
      radius_(radius),
      weights_(weightsOf(codebook, words, index, used)),
      space_(explainedSpace(codebook, words, used)),
      lit_(codebook.planes(), 0),
      used_(used.begin(), used.end()),
      alone_(words.size() == 1) {
    const cv::Rect rect = cv::Rect(spot.x - radius, spot.y - radius, 2 * radius + 1, 2 * radius + 1) &
                          cv::Rect(0, 0, picture.width, picture.height);
    const Eigen::ArrayXXd zero = Eigen::ArrayXXd::Zero(rect.height, rect.width);
    window_ = {rect.x, rect.y, zero, zero, {}};
    window_.state.setConstant(rect.height, rect.width, PixelState::Good);
    moments_.assign(static_cast<std::size_t>(space_.cols()), zero);
    squares_ = zero;
    noise_ = zero;
    for (const std::size_t plane : codebook.lit[words[index]])
        lit_[plane] = 1;
}

void AmplitudeMap::add(const FramePixels& frame, std::size_t plane, int channel, const ImageNoise& noise) {
    if (used_[plane] == 0)
        return;
    const auto at = static_cast<Eigen::Index>(plane);
    const double weight = weights_[at];
    const double edge = edgeLevel(frame, spot_, radius_, channel);
    for (Eigen::Index row = 0; row < window_.value.rows(); ++row) {
        for (Eigen::Index col = 0; col < window_.value.cols(); ++col) {
            const int x = window_.x0 + static_cast<int>(col);
            const int y = window_.y0 + static_cast<int>(row);
            const double value = frame.value(x, y, channel);
            const double variance = noise.variance(value);
            const double light = value - edge;
            window_.value(row, col) += weight * light;
            window_.variance(row, col) += weight * weight * variance;
            squares_(row, col) += light * light;
            noise_(row, col) += variance;
            for (std::size_t j = 0; j < moments_.size(); ++j)
                moments_[j](row, col) += space_(at, static_cast<Eigen::Index>(j)) * light;
            if (!frame.saturated(x, y, channel))
                continue;
            PixelState& state = window_.state(row, col);
            state = alone_ && lit_[plane] != 0 && state != PixelState::Excluded ? PixelState::Saturated
                                                                                : PixelState::Excluded;
        }
    }
}

double AmplitudeMap::distance(Eigen::Index row, Eigen::Index col, const Vector2d& centre) const {
    return std::hypot(static_cast<double>(window_.x0 + col) - centre.x(),
                      static_cast<double>(window_.y0 + row) - centre.y());
}

double AmplitudeMap::strayShare(const Vector2d& centre, double radius_px) const {
    const auto planes = static_cast<double>(std::count(used_.begin(), used_.end(), 1));
    const double freedom = std::max(0.0, planes - static_cast<double>(space_.cols()));
    // |w|^2 off the drift is the inverse of the amplitude's variance for unit noise.
    const double energy = 1 / weights_.squaredNorm();
    double light = 0;
    double stray = 0;
    for (Eigen::Index row = 0; row < window_.state.rows(); ++row) {
        for (Eigen::Index col = 0; col < window_.state.cols(); ++col) {
            if (window_.state(row, col) != PixelState::Good || distance(row, col, centre) > radius_px)
                continue;
            light += energy * window_.value(row, col) * window_.value(row, col);
            stray += squares_(row, col) - noise_(row, col) * freedom / planes;
            for (const Eigen::ArrayXXd& moment : moments_)
                stray -= moment(row, col) * moment(row, col);
        }
    }
    return light > 0 ? stray / light : 0.0;
}

bool AmplitudeMap::blindNear(const Vector2d& centre, double radius_px) const {
    for (Eigen::Index row = 0; row < window_.state.rows(); ++row) {
        for (Eigen::Index col = 0; col < window_.state.cols(); ++col) {
            if (window_.state(row, col) == PixelState::Excluded && distance(row, col, centre) <= radius_px)
                return true;
        }
    }
    return false;
}

}  // namespace skincal
