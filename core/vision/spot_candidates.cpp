#include "core/vision/spot_candidates.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

// Fixed point keeps the smoothing in 16 bits, where it is twice as fast as in floats, without losing the noise.
constexpr double kFixedPoint = 16;

// Of every fourth row and column, which is plenty for a spread.
double medianOf(const cv::Mat& map) {
    std::vector<double> values;
    values.reserve(map.total() / 16 + 1);
    for (int y = 0; y < map.rows; y += 4) {
        for (int x = 0; x < map.cols; x += 4)
            values.push_back(static_cast<double>(map.at<float>(y, x)));
    }
    return median(std::move(values));
}

// Local maxima that rise above their surroundings in a map of changes (16-bit fixed point).
void appendMaxima(const cv::Mat& map, const SpotCandidateOptions& options, std::vector<SpotCandidate>& found) {
    cv::Mat change;
    map.convertTo(change, CV_32F, 1 / kFixedPoint);
    // The median of the surroundings is what a lamp does to them; the spot itself hardly counts in it.
    cv::Mat surroundings;
    map.convertTo(surroundings, CV_8U, 1 / kFixedPoint);
    cv::medianBlur(surroundings, surroundings, options.surroundings_px);
    surroundings.convertTo(surroundings, CV_32F);
    const cv::Mat contrast = change - surroundings;
    const double middle = medianOf(contrast);
    const double spread = 1.4826 * medianOf(cv::abs(contrast - middle));
    const double threshold = std::max(options.minContrast, middle + options.noiseFactor * spread);

    cv::Mat highest;
    cv::dilate(change, highest, cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(5, 5)));
    for (int y = 0; y < change.rows; ++y) {
        const auto* value = contrast.ptr<float>(y);
        const auto* here = change.ptr<float>(y);
        const auto* top = highest.ptr<float>(y);
        for (int x = 0; x < change.cols; ++x) {
            if (static_cast<double>(value[x]) > threshold && here[x] >= top[x])
                found.push_back({x, y, static_cast<double>(value[x])});
        }
    }
}

}  // namespace

bool SpotCandidateOptions::validate() const {
    return minContrast > 0 && noiseFactor > 0 && smoothing_px > 0 && smoothing_px < 10 && minDistance_px >= 1 &&
           surroundings_px >= 5 && surroundings_px % 2 == 1;
}

SpotFinder::SpotFinder(const SpotCandidateOptions& options) : options_(options) {
    if (!options.validate())
        throw std::logic_error("SpotFinder: options out of range");
}

void SpotFinder::add(const FramePixels& frame, bool coloured) {
    const std::size_t channels = coloured ? 3 : 1;
    const int reach = 2 * static_cast<int>(std::ceil(1.7 * options_.smoothing_px)) + 1;
    const bool first = last_.empty();
    if (first) {
        last_.resize(channels);
        lastSmooth_.resize(channels);
        lastStep_.resize(channels);
        jump_ = cv::Mat::zeros(frame.size(), CV_16S);
        flash_ = cv::Mat::zeros(frame.size(), CV_16S);
    }
    cv::Mat smooth;
    cv::Mat local;
    cv::Mat step;
    cv::Mat back;
    for (std::size_t i = 0; i < channels; ++i) {
        const cv::Mat plane = frame.plane(coloured ? static_cast<int>(i) : -1);
        plane.convertTo(smooth, CV_16S, kFixedPoint);
        cv::GaussianBlur(smooth, smooth, cv::Size(reach, reach), options_.smoothing_px);
        // A lamp that flickers in step with the frames can cancel an LED's jump: compare what stands out locally.
        cv::blur(smooth, local, cv::Size(options_.surroundings_px, options_.surroundings_px));
        cv::subtract(smooth, local, smooth);
        if (!first) {
            noise_.add(plane, last_[i]);
            cv::subtract(smooth, lastSmooth_[i], step);
            cv::max(jump_, cv::abs(step), jump_);
            if (!lastStep_[i].empty()) {
                cv::subtract(cv::Scalar(0), step, back);
                cv::min(lastStep_[i], back, back);
                cv::max(flash_, back, flash_);
                cv::subtract(cv::Scalar(0), lastStep_[i], back);
                cv::min(back, step, back);
                cv::max(flash_, back, flash_);
            }
            cv::swap(lastStep_[i], step);
        }
        plane.copyTo(last_[i]);
        cv::swap(lastSmooth_[i], smooth);
    }
}

std::vector<SpotCandidate> SpotFinder::candidates(std::size_t most) const {
    if (jump_.empty())
        return {};
    std::vector<SpotCandidate> found;
    appendMaxima(jump_, options_, found);
    appendMaxima(flash_, options_, found);
    std::stable_sort(found.begin(), found.end(),
                     [](const SpotCandidate& a, const SpotCandidate& b) { return a.contrast > b.contrast; });

    // A plateau (a clipped spot) has many equal maxima: keep one of each neighbourhood.
    cv::Mat taken = cv::Mat::zeros(jump_.size(), CV_8U);
    const int reach = static_cast<int>(std::ceil(options_.minDistance_px)) - 1;
    std::vector<SpotCandidate> kept;
    for (const SpotCandidate& candidate : found) {
        if (kept.size() == most)
            break;
        if (taken.at<std::uint8_t>(candidate.y, candidate.x) != 0)
            continue;
        const cv::Rect around(candidate.x - reach, candidate.y - reach, 2 * reach + 1, 2 * reach + 1);
        taken(around & cv::Rect(0, 0, jump_.cols, jump_.rows)) = 1;
        kept.push_back(candidate);
    }
    return kept;
}

}  // namespace skincal
