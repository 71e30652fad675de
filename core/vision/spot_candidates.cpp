#include "core/vision/spot_candidates.h"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "core/geometry/statistics.h"
#include "core/vision/local_contrast.h"
#include "core/vision/parallel.h"

namespace skincal {
namespace {

// Jumps are looked for at half the size, which costs a quarter.
constexpr int kShrink = 2;
// Sums of absolute differences of that many pictures fit into 16 bits.
constexpr int kMostSummed = 256;

int oddHalf(int size_px) {
    return size_px / kShrink | 1;
}

// Of every second row and column, which is plenty for a spread.
double medianOf(const cv::Mat& map) {
    std::vector<double> values;
    values.reserve(map.total() / 4 + 1);
    for (int y = 0; y < map.rows; y += 2) {
        for (int x = 0; x < map.cols; x += 2)
            values.push_back(static_cast<double>(map.at<float>(y, x)));
    }
    return median(std::move(values));
}

// Which of two pixels of the picture: the one on the side of the brighter neighbour.
int fullSize(int at, int size, float before, float after) {
    return std::min(kShrink * at + (after > before ? 1 : 0), kShrink * size - 1);
}

SpotCandidate toPicture(const cv::Mat& map, const SpotCandidate& spot) {
    const auto value = [&](int x, int y) {
        return x < 0 || y < 0 || x >= map.cols || y >= map.rows ? 0.0F : map.at<float>(y, x);
    };
    return {fullSize(spot.x, map.cols, value(spot.x - 1, spot.y), value(spot.x + 1, spot.y)),
            fullSize(spot.y, map.rows, value(spot.x, spot.y - 1), value(spot.x, spot.y + 1)), spot.contrast};
}

// Median of the surroundings, of half as many pixels where the map is as large as the picture.
cv::Mat surroundingsOf(const cv::Mat& change, bool isHalf, int size_px) {
    cv::Mat small = change;
    if (!isHalf)
        cv::resize(change, small, cv::Size(), 0.5, 0.5, cv::INTER_AREA);
    small.convertTo(small, CV_8U);
    cv::medianBlur(small, small, oddHalf(size_px));
    if (!isHalf)
        cv::resize(small, small, change.size(), 0, 0, cv::INTER_LINEAR);
    small.convertTo(small, CV_32F);
    return small;
}

// Local maxima, in the picture, that rise above their surroundings in a map of changes (grey levels), strongest first.
std::vector<SpotCandidate> maximaOf(const cv::Mat& change, bool isHalf, const SpotCandidateOptions& options) {
    // The median of the surroundings is what a lamp does to them; the spot itself hardly counts in it.
    const cv::Mat contrast = change - surroundingsOf(change, isHalf, options.surroundings_px);
    const double middle = medianOf(contrast);
    const double spread = 1.4826 * medianOf(cv::abs(contrast - middle));
    const double threshold = std::max(options.minContrast, middle + options.noiseFactor * spread);

    cv::Mat highest;
    const cv::Mat around = isHalf ? cv::getStructuringElement(cv::MORPH_RECT, cv::Size(3, 3))
                                  : cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(5, 5));
    cv::dilate(change, highest, around);
    std::vector<SpotCandidate> found;
    for (int y = 0; y < change.rows; ++y) {
        const auto* value = contrast.ptr<float>(y);
        const auto* here = change.ptr<float>(y);
        const auto* top = highest.ptr<float>(y);
        for (int x = 0; x < change.cols; ++x) {
            if (static_cast<double>(value[x]) <= threshold || here[x] < top[x])
                continue;
            const SpotCandidate spot{x, y, static_cast<double>(value[x])};
            found.push_back(isHalf ? toPicture(change, spot) : spot);
        }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const SpotCandidate& a, const SpotCandidate& b) { return a.contrast > b.contrast; });
    return found;
}

// sum += |a - b|
void addDifference(const cv::Mat& a, const cv::Mat& b, cv::Mat& sum) {
    forBands(sum.rows, [&](int first, int last) {
        const int width = sum.cols;
        for (int y = first; y < last; ++y) {
            const auto* pa = a.ptr<std::uint8_t>(y);
            const auto* pb = b.ptr<std::uint8_t>(y);
            auto* to = sum.ptr<std::uint16_t>(y);
            for (int x = 0; x < width; ++x)
                to[x] = static_cast<std::uint16_t>(to[x] + (std::max(pa[x], pb[x]) - std::min(pa[x], pb[x])));
        }
    });
}

}  // namespace

bool SpotCandidateOptions::validate() const {
    return minContrast > 0 && noiseFactor > 0 && smoothing_px > 0 && smoothing_px < 6 && minDistance_px >= 1 &&
           surroundings_px >= 5 && surroundings_px % 2 == 1;
}

SpotFinder::SpotFinder(const SpotCandidateOptions& options) : options_(options) {
    if (!options.validate())
        throw std::logic_error("SpotFinder: options out of range");
}

void SpotFinder::add(const FramePixels& frame, bool coloured) {
    const std::size_t channels = coloured ? 3 : 1;
    const bool first = last_.empty();
    if (first) {
        last_.resize(channels);
        lastContrast_.resize(channels);
        lastStep_.resize(channels);
        sum_ = cv::Mat::zeros(frame.size(), CV_16U);
        const cv::Size half(frame.size().width / kShrink, frame.size().height / kShrink);
        jump_ = cv::Mat::zeros(half, CV_16S);
        flash_ = cv::Mat::zeros(half, CV_16S);
    }
    for (std::size_t i = 0; i < channels; ++i) {
        const cv::Mat plane = frame.plane(coloured ? static_cast<int>(i) : -1);
        // A lamp that flickers in step with the frames can cancel an LED's jump: compare what stands out locally.
        cv::Mat contrast;
        if (!jump_.empty())
            contrast = localContrast(plane, options_.smoothing_px / kShrink, oddHalf(options_.surroundings_px));
        if (!first) {
            noise_.add(plane, last_[i]);
            if (summed_++ < kMostSummed)
                addDifference(plane, last_[i], sum_);
            if (!jump_.empty())
                noteStep(contrast, lastContrast_[i], lastStep_[i]);
        }
        last_[i] = plane;
        lastContrast_[i] = contrast;
    }
}

void SpotFinder::noteStep(const cv::Mat& now, const cv::Mat& before, cv::Mat& lastStep) {
    if (lastStep.empty())
        lastStep = cv::Mat::zeros(now.size(), CV_16S);
    forBands(now.rows, [&](int first, int end) {
        const int width = now.cols;
        for (int y = first; y < end; ++y) {
            const auto* here = now.ptr<std::int16_t>(y);
            const auto* there = before.ptr<std::int16_t>(y);
            auto* last = lastStep.ptr<std::int16_t>(y);
            auto* jump = jump_.ptr<std::int16_t>(y);
            auto* flash = flash_.ptr<std::int16_t>(y);
            for (int x = 0; x < width; ++x) {
                const auto step = static_cast<std::int16_t>(here[x] - there[x]);
                const auto back = static_cast<std::int16_t>(-step);
                const auto forth = static_cast<std::int16_t>(-last[x]);
                jump[x] = std::max(jump[x], std::max(step, back));
                // No step before this one is none that this one could take back.
                flash[x] = std::max(flash[x], std::max(std::min(last[x], back), std::min(forth, step)));
                last[x] = step;
            }
        }
    });
}

std::vector<SpotCandidate> SpotFinder::candidates(std::size_t most) const {
    if (last_.empty())
        return {};
    struct Change {
        cv::Mat map;
        bool isHalf = false;
        std::vector<SpotCandidate> maxima{};
    };
    std::vector<Change> changes;
    if (summed_ > 0 && summed_ <= kMostSummed)
        changes.push_back({sum_, false});
    if (!jump_.empty()) {
        changes.push_back({jump_, true});
        changes.push_back({flash_, true});
    }
    (void)forEach(changes.size(), {}, [&](std::size_t i) {
        Change& change = changes[i];
        cv::Mat levels;
        // What blinks changes in about half of the steps.
        change.map.convertTo(levels, CV_32F, change.isHalf ? 1 / kContrastUnits : 2.0 / summed_);
        // The mean over all steps has little noise left: spots that nearly touch must stay apart.
        if (!change.isHalf)
            cv::GaussianBlur(levels, levels, cv::Size(), 0.5 * options_.smoothing_px);
        change.maxima = maximaOf(levels, change.isHalf, options_);
    });
    std::vector<SpotCandidate> found;
    for (const Change& change : changes)
        found.insert(found.end(), change.maxima.begin(), change.maxima.end());

    // A plateau (a clipped spot) has many equal maxima: keep one of each neighbourhood.
    cv::Mat taken = cv::Mat::zeros(sum_.size(), CV_8U);
    const cv::Rect inside({}, taken.size());
    const int reach = static_cast<int>(std::ceil(options_.minDistance_px)) - 1;
    std::vector<SpotCandidate> kept;
    for (const SpotCandidate& candidate : found) {
        if (kept.size() == most)
            break;
        if (!inside.contains({candidate.x, candidate.y}) || taken.at<std::uint8_t>(candidate.y, candidate.x) != 0)
            continue;
        const cv::Rect around(candidate.x - reach, candidate.y - reach, 2 * reach + 1, 2 * reach + 1);
        taken(around & inside) = 1;
        kept.push_back(candidate);
    }
    std::stable_sort(kept.begin(), kept.end(),
                     [](const SpotCandidate& a, const SpotCandidate& b) { return a.contrast > b.contrast; });
    return kept;
}

}  // namespace skincal
