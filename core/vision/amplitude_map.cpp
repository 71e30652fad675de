#include "core/vision/amplitude_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

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

AmplitudeMap::AmplitudeMap(const SpotCandidate& spot, int radius, cv::Size picture, const Codebook& codebook,
                           LightFilter filter)
    : rect_(cv::Rect(spot.x - radius, spot.y - radius, 2 * radius + 1, 2 * radius + 1) &
            cv::Rect(0, 0, picture.width, picture.height)),
      filter_(std::move(filter)),
      lit_(codebook.planes(), 0) {
    if (filter_.used.size() != codebook.planes() || filter_.gains.size() != codebook.planes() ||
        filter_.around.size() != static_cast<Eigen::Index>(codebook.planes()))
        throw std::logic_error("AmplitudeMap: the filter does not belong to this codebook");
    const Ambient ambient = ambientOf(codebook, filter_.around, filter_.gains, filter_.sigma);
    Eigen::MatrixXd weights;
    while (weights.size() == 0) {
        if (filter_.words.empty())
            throw std::logic_error("AmplitudeMap: a word that can't be separated");
        weights = amplitudeWeights(codebook, filter_.words, filter_.used, ambient);
        if (weights.size() == 0)
            filter_.words.pop_back();
    }
    weights_ = weights.row(0).cast<float>();
    for (const std::size_t plane : codebook.lit[filter_.words.front()])
        lit_[plane] = 1;
    const Image zero = Image::Zero(rect_.height, rect_.width);
    value_ = variance_ = clippedLit_ = clippedDark_ = zero;
    if (filter_.clipped) {
        space_ = explainedSpace(codebook, filter_.words, filter_.used, ambient).cast<float>();
        squares_ = noise_ = zero;
        moments_.assign(static_cast<std::size_t>(space_.cols()), zero);
    }
}

void AmplitudeMap::add(const FramePixels& frame, std::size_t plane, int channel, const ImageNoise& noise) {
    if (filter_.used[plane] == 0)
        return;
    const auto at = static_cast<Eigen::Index>(plane);
    const auto gain = static_cast<float>(filter_.gains[plane]);
    const float weight = weights_[at] / gain;
    const float around = filter_.around[at];
    const auto read = static_cast<float>(noise.read);
    const auto shot = static_cast<float>(noise.gain);
    Image& clipped = lit_[plane] != 0 ? clippedLit_ : clippedDark_;
    for (Eigen::Index row = 0; row < value_.rows(); ++row) {
        for (Eigen::Index col = 0; col < value_.cols(); ++col) {
            const int x = rect_.x + static_cast<int>(col);
            const int y = rect_.y + static_cast<int>(row);
            const auto value = static_cast<float>(frame.value(x, y, channel));
            const float variance = read + shot * value;
            value_(row, col) += weight * (value - around);
            variance_(row, col) += weight * weight * variance;
            if (frame.saturated(x, y, channel))
                clipped(row, col) += 1;
            if (!filter_.clipped)
                continue;
            const float light = (value - around) / gain;
            squares_(row, col) += light * light;
            noise_(row, col) += variance / (gain * gain);
            for (std::size_t j = 0; j < moments_.size(); ++j)
                moments_[j](row, col) += space_(at, static_cast<Eigen::Index>(j)) * light;
        }
    }
}

SpotWindow AmplitudeMap::window() const {
    SpotWindow window{rect_.x, rect_.y, value_.cast<double>(), variance_.cast<double>(), {}};
    window.state.setConstant(value_.rows(), value_.cols(), PixelState::Good);
    float litPlanes = 0;
    for (std::size_t k = 0; k < lit_.size(); ++k)
        litPlanes += lit_[k] != 0 && filter_.used[k] != 0 ? 1.0F : 0.0F;
    for (Eigen::Index row = 0; row < value_.rows(); ++row) {
        for (Eigen::Index col = 0; col < value_.cols(); ++col) {
            const bool alone = filter_.words.size() == 1;
            if (clippedDark_(row, col) > 0)
                window.state(row, col) = PixelState::Excluded;
            else if (clippedLit_(row, col) > 0)
                window.state(row, col) = alone || (!filter_.shared && clippedLit_(row, col) == litPlanes)
                                             ? PixelState::Saturated
                                             : PixelState::Excluded;
        }
    }
    return window;
}

double AmplitudeMap::distance(Eigen::Index row, Eigen::Index col, const Vector2d& centre) const {
    return std::hypot(static_cast<double>(rect_.x + col) - centre.x(), static_cast<double>(rect_.y + row) - centre.y());
}

double AmplitudeMap::strayShare(const Vector2d& centre, double radius_px) const {
    const auto planes = static_cast<double>(std::count(filter_.used.begin(), filter_.used.end(), 1));
    const double freedom = std::max(0.0, planes - static_cast<double>(space_.cols()));
    // |w|^2 off the rest is the inverse of the amplitude's variance for unit noise.
    const double energy = 1 / static_cast<double>(weights_.squaredNorm());
    double light = 0;
    double stray = 0;
    for (Eigen::Index row = 0; row < squares_.rows(); ++row) {
        for (Eigen::Index col = 0; col < squares_.cols(); ++col) {
            if (clippedLit_(row, col) + clippedDark_(row, col) > 0 || distance(row, col, centre) > radius_px)
                continue;
            const auto value = static_cast<double>(value_(row, col));
            light += energy * value * value;
            stray += static_cast<double>(squares_(row, col)) - static_cast<double>(noise_(row, col)) * freedom / planes;
            for (const Image& moment : moments_)
                stray -= static_cast<double>(moment(row, col) * moment(row, col));
        }
    }
    return light > 0 ? stray / light : 0.0;
}

}  // namespace skincal
