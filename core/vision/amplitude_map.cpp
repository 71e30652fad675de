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
    const Eigen::Index pixels = rect_.area();
    Eigen::Index columns = kNoise;
    if (filter_.doubtful) {
        calm_ = calmPlanes(filter_.around, filter_.gains, filter_.used);
        space_ = explainedSpace(codebook, filter_.words, calm_, ambient).cast<float>();
        columns = kExplained + space_.cols();
        squares_ = Eigen::ArrayXf::Zero(pixels);
        clippedLit_ = squares_;
        clippedDark_ = squares_;
    }
    sums_ = Eigen::MatrixXf::Zero(pixels, columns);
}

void AmplitudeMap::add(std::span<const FramePlane> planes, const ImageNoise& noise) {
    read_ = static_cast<float>(noise.read);
    shot_ = static_cast<float>(noise.gain);
    std::vector<const FramePlane*> used;
    for (const FramePlane& one : planes) {
        if (filter_.used[one.plane] == 0)
            continue;
        used.push_back(&one);
        const auto gain = static_cast<float>(filter_.gains[one.plane]);
        const auto at = static_cast<Eigen::Index>(one.plane);
        const float around = filter_.around[at];
        const float weight = weights_[at] / gain;
        squaredWeights_ += weight * weight;
        varianceOffset_ += weight * weight * around;
        if (isCalm(one.plane)) {
            const auto common = static_cast<float>(surroundingsVariance(noise, static_cast<double>(around), radius_));
            noiseOffset_ += (read_ + common + shot_ * around) / (gain * gain);
        }
    }
    if (used.empty())
        return;
    const Eigen::MatrixXf light = lightIn(used);
    sums_.noalias() += light * factorsOf(used);
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (isCalm(used[i]->plane))
            squares_ += light.col(static_cast<Eigen::Index>(i)).array().square();
    }
}

Eigen::MatrixXf AmplitudeMap::lightIn(std::span<const FramePlane* const> planes) {
    Eigen::MatrixXf light(sums_.rows(), static_cast<Eigen::Index>(planes.size()));
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const FramePlane& plane = *planes[i];
        auto here = light.col(static_cast<Eigen::Index>(i)).array();
        for (int y = 0; y < rect_.height; ++y)
            plane.frame.values(rect_.x, rect_.y + y, rect_.width, plane.channel,
                               here.data() + static_cast<std::ptrdiff_t>(y) * rect_.width);
        if (filter_.doubtful)
            noteClipped(plane, here);
        here = (here - filter_.around[static_cast<Eigen::Index>(plane.plane)]) *
               static_cast<float>(1 / filter_.gains[plane.plane]);
    }
    return light;
}

Eigen::MatrixXf AmplitudeMap::factorsOf(std::span<const FramePlane* const> planes) const {
    Eigen::MatrixXf factors(static_cast<Eigen::Index>(planes.size()), sums_.cols());
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(planes[i]->plane);
        const auto gain = static_cast<float>(filter_.gains[planes[i]->plane]);
        auto row = factors.row(static_cast<Eigen::Index>(i));
        row[kValue] = weights_[at];
        row[kVariance] = weights_[at] * weights_[at] / gain;
        if (!filter_.doubtful)
            continue;
        row[kNoise] = isCalm(planes[i]->plane) ? 1 / gain : 0.0F;
        row.tail(space_.cols()) = space_.row(at);  // zero where it is not calm
    }
    return factors;
}

void AmplitudeMap::noteClipped(const FramePlane& plane, const Eigen::Ref<const Eigen::ArrayXf>& values) {
    Eigen::ArrayXf& clipped = lit_[plane.plane] != 0 ? clippedLit_ : clippedDark_;
    constexpr float kTop = FramePixels::kTop;
    if (!plane.frame.isMean(plane.channel)) {
        for (Eigen::Index i = 0; i < values.size(); ++i)
            clipped[i] += values[i] >= kTop ? 1.0F : 0.0F;
        return;
    }
    // Of three channels one may be clipped where their mean is dark.
    if (values.maxCoeff() < kTop / 3)
        return;
    Eigen::Index i = 0;
    for (int y = rect_.y; y < rect_.y + rect_.height; ++y) {
        for (int x = rect_.x; x < rect_.x + rect_.width; ++x)
            clipped[i++] += plane.frame.saturated(x, y, plane.channel) ? 1.0F : 0.0F;
    }
}

SpotWindow AmplitudeMap::window() const {
    using Image = Eigen::Array<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const auto imageOf = [&](Column column) {
        return Eigen::Map<const Image>(sums_.col(column).data(), rect_.height, rect_.width);
    };
    SpotWindow window;
    window.x0 = rect_.x;
    window.y0 = rect_.y;
    window.value = imageOf(kValue).cast<double>();
    window.variance = (read_ * squaredWeights_ + shot_ * (varianceOffset_ + imageOf(kVariance))).cast<double>();
    window.state.setConstant(rect_.height, rect_.width, PixelState::Good);
    if (!filter_.doubtful)
        return window;
    float litPlanes = 0;
    for (std::size_t k = 0; k < lit_.size(); ++k)
        litPlanes += lit_[k] != 0 && filter_.used[k] != 0 ? 1.0F : 0.0F;
    const bool alone = filter_.words.size() == 1;
    Eigen::Index i = 0;
    for (Eigen::Index y = 0; y < rect_.height; ++y) {
        for (Eigen::Index x = 0; x < rect_.width; ++x, ++i) {
            if (clippedDark_[i] > 0)
                window.state(y, x) = PixelState::Excluded;
            else if (clippedLit_[i] > 0)
                window.state(y, x) = alone || (!filter_.shared && clippedLit_[i] == litPlanes) ? PixelState::Saturated
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
    for (Eigen::Index i = 0; i < squares_.size(); ++i) {
        const Vector2d pixel(static_cast<double>(rect_.x + i % rect_.width),
                             static_cast<double>(rect_.y + i / rect_.width));
        if (clippedLit_[i] + clippedDark_[i] > 0 || (pixel - centre).norm() > radius_px)
            continue;
        const auto value = static_cast<double>(sums_(i, kValue));
        light += energy * value * value;
        const double noise = static_cast<double>(noiseOffset_ + shot_ * sums_(i, kNoise)) / planes;
        stray += static_cast<double>(squares_[i]) - noise * freedom -
                 static_cast<double>(sums_.row(i).tail(space_.cols()).squaredNorm());
        squaredNoise += noise * noise;
    }
    // A word of one plane in a hundred has little light, and a hundred planes have much noise.
    constexpr double kSigmas = 3;
    stray -= kSigmas * std::sqrt(2 * freedom * squaredNoise);
    return light > 0 ? stray / light : 0.0;
}

}  // namespace skincal
