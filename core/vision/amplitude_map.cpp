#include "core/vision/amplitude_map.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/vision/spot_series.h"
#include "core/vision/surroundings.h"

namespace skincal {
namespace {

/// Weights of the words where the surroundings do no more than noise does, and than the words shine on them; else none.
/// To let a spot follow them would cost much where its own light reaches that far, and gain nothing.
Eigen::MatrixXd steadyWeights(const Codebook& codebook, const LightFilter& filter, const Ambient& ambient) {
    const Eigen::MatrixXd X = designMatrix(codebook, filter.words);
    const auto inverse = inverseNormalMatrix(X, filter.used, codebook);
    if (!inverse)
        return {};
    Eigen::VectorXd light = centred(ambient, filter.used).light;
    double freedom = -static_cast<double>(X.cols());
    for (std::size_t k = 0; k < filter.used.size(); ++k) {
        if (filter.used[k] == 0)
            light[static_cast<Eigen::Index>(k)] = 0;
        else
            ++freedom;
    }
    // What is left of a least-squares fit, over the used planes: a^2 - (X^T a)^T N^-1 (X^T a).
    const Eigen::VectorXd moment = X.transpose() * light;
    const double left = light.squaredNorm() - moment.dot(*inverse * moment);
    return left <= filter.sigma * filter.sigma * std::max(1.0, freedom)
               ? amplitudeWeights(X, *inverse, filter.words.size(), filter.used)
               : Eigen::MatrixXd();
}

}  // namespace

AmplitudeMap::AmplitudeMap(const SpotCandidate& spot, int radius, cv::Size picture, const Codebook& codebook,
                           LightFilter filter)
    : rect_(cv::Rect(spot.x - radius, spot.y - radius, 2 * radius + 1, 2 * radius + 1) &
            cv::Rect(0, 0, picture.width, picture.height)),
      radius_(radius),
      filter_(std::move(filter)),
      lit_(codebook.planes(), 0) {
    if (filter_.used.size() != codebook.planes() || filter_.gains.size() != codebook.planes() ||
        filter_.around.size() != static_cast<Eigen::Index>(codebook.planes()))
        throw std::logic_error("AmplitudeMap: the filter does not belong to this codebook");
    Ambient ambient = ambientOf(codebook, filter_.around, filter_.gains, filter_.sigma);
    Eigen::MatrixXd weights;
    if (ambient.light.size() > 0)
        weights = steadyWeights(codebook, filter_, ambient);
    if (weights.size() > 0)
        ambient = {};
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
    const Image zero = Image::Zero(rect_.width, rect_.height);
    value_ = zero;
    variance_ = zero;
    if (filter_.clipped) {
        clippedLit_ = zero;
        clippedDark_ = zero;
        calm_ = calmPlanes(filter_.around, filter_.gains, filter_.used);
        space_ = explainedSpace(codebook, filter_.words, calm_, ambient).cast<float>();
        squares_ = zero;
        noise_ = zero;
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
    read_ = static_cast<float>(noise.read);
    shot_ = static_cast<float>(noise.gain);
    offset_ += weight * around;
    squaredWeights_ += weight * weight;
    const bool isCalm = filter_.clipped && calm_[plane] != 0;
    if (isCalm) {
        const auto common = static_cast<float>(surroundingsVariance(noise, static_cast<double>(around), radius_));
        noiseOffset_ += (read_ + common) / (gain * gain);
    }
    Image& clipped = lit_[plane] != 0 ? clippedLit_ : clippedDark_;
    // Every pixel of some ten thousand windows in every plane: written so that compilers make vectors of it.
    constexpr int kWidest = 61;
    Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, 0, kWidest, kWidest> light(value_.rows(), value_.cols());
    for (Eigen::Index y = 0; y < light.cols(); ++y)
        frame.values(rect_.x, rect_.y + static_cast<int>(y), rect_.width, channel, light.col(y).data());
    value_ += weight * light;
    variance_ += weight * weight * light;
    if (!filter_.clipped)
        return;
    // Of three channels one may be clipped where their mean is dark.
    constexpr float kMayBeClipped = 254.0F / 3;
    if (light.maxCoeff() >= kMayBeClipped) {
        for (Eigen::Index y = 0; y < light.cols(); ++y) {
            for (Eigen::Index x = 0; x < light.rows(); ++x)
                clipped(x, y) += frame.saturated(rect_.x + static_cast<int>(x), rect_.y + static_cast<int>(y), channel)
                                     ? 1.0F
                                     : 0.0F;
        }
    }
    if (!isCalm)
        return;
    noise_ += light / (gain * gain);
    light = (light - around) / gain;
    squares_ += light.square();
    for (std::size_t j = 0; j < moments_.size(); ++j)
        moments_[j] += space_(at, static_cast<Eigen::Index>(j)) * light;
}

SpotWindow AmplitudeMap::window() const {
    SpotWindow window;
    window.x0 = rect_.x;
    window.y0 = rect_.y;
    window.value = (value_.transpose() - offset_).cast<double>();
    window.variance = (read_ * squaredWeights_ + shot_ * variance_.transpose()).cast<double>();
    window.state.setConstant(value_.cols(), value_.rows(), PixelState::Good);
    if (!filter_.clipped)
        return window;
    float litPlanes = 0;
    for (std::size_t k = 0; k < lit_.size(); ++k)
        litPlanes += lit_[k] != 0 && filter_.used[k] != 0 ? 1.0F : 0.0F;
    const bool alone = filter_.words.size() == 1;
    for (Eigen::Index y = 0; y < value_.cols(); ++y) {
        for (Eigen::Index x = 0; x < value_.rows(); ++x) {
            if (clippedDark_(x, y) > 0)
                window.state(y, x) = PixelState::Excluded;
            else if (clippedLit_(x, y) > 0)
                window.state(y, x) = alone || (!filter_.shared && clippedLit_(x, y) == litPlanes)
                                         ? PixelState::Saturated
                                         : PixelState::Excluded;
        }
    }
    return window;
}

double AmplitudeMap::strayShare(const Vector2d& centre, double radius_px) const {
    const auto planes = static_cast<double>(std::count(calm_.begin(), calm_.end(), 1));
    const double freedom = std::max(0.0, planes - static_cast<double>(space_.cols()));
    // |w|^2 off the rest is the inverse of the amplitude's variance for unit noise.
    const double energy = 1 / static_cast<double>(weights_.squaredNorm());
    double light = 0;
    double stray = 0;
    double squaredNoise = 0;
    for (Eigen::Index y = 0; y < squares_.cols(); ++y) {
        for (Eigen::Index x = 0; x < squares_.rows(); ++x) {
            const Vector2d pixel(static_cast<double>(rect_.x + x), static_cast<double>(rect_.y + y));
            if (clippedLit_(x, y) + clippedDark_(x, y) > 0 || (pixel - centre).norm() > radius_px)
                continue;
            const auto value = static_cast<double>(value_(x, y) - offset_);
            light += energy * value * value;
            const double noise = static_cast<double>(noiseOffset_ + shot_ * noise_(x, y)) / planes;
            stray += static_cast<double>(squares_(x, y)) - noise * freedom;
            squaredNoise += noise * noise;
            for (const Image& moment : moments_)
                stray -= static_cast<double>(moment(x, y) * moment(x, y));
        }
    }
    // A word of one plane in a hundred has little light, and a hundred planes have much noise.
    constexpr double kSigmas = 3;
    stray -= kSigmas * std::sqrt(2 * freedom * squaredNoise);
    return light > 0 ? stray / light : 0.0;
}

}  // namespace skincal
