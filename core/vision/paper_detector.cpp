#include "core/vision/paper_detector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <set>
#include <stdexcept>

namespace skincal {
namespace {

/// A frame with the background that is nearest in the order in which they were taken.
struct FramePair {
    std::size_t foreground = 0;
    std::size_t background = 0;
};

std::optional<std::size_t> nearestBackground(std::span<const FrameInfo> frames, std::size_t k) {
    for (std::size_t distance = 1; distance < frames.size(); ++distance) {
        if (k >= distance && frames[k - distance].lit.empty())
            return k - distance;
        if (k + distance < frames.size() && frames[k + distance].lit.empty())
            return k + distance;
    }
    return std::nullopt;
}

bool isColoured(const FrameInfo& frame) {
    return !frame.lit.empty() &&
           std::all_of(frame.lit.begin(), frame.lit.end(), [](const LitModule& lit) { return lit.colour.has_value(); });
}

cv::Mat blurredDifference(const cv::Mat& foreground, const cv::Mat& background, const PaperDetectorOptions& options) {
    cv::Mat difference;
    cv::subtract(toGrey(foreground), toGrey(background), difference);  // saturates at 0 (eq. 11a)
    cv::Mat blurred;
    cv::GaussianBlur(difference, blurred, cv::Size(options.blurSize, options.blurSize), options.blurSigma);
    return blurred;
}

cv::Mat binary(const cv::Mat& blurred, const PaperDetectorOptions& options) {
    double top = 0;
    cv::minMaxLoc(blurred, nullptr, &top);
    cv::Mat result;
    cv::threshold(blurred, result, std::max(top * options.thresholdShare, options.minThreshold), 255,
                  cv::THRESH_BINARY);
    return result;
}

std::vector<cv::KeyPoint> blobs(const cv::Mat& picture, const PaperDetectorOptions& options) {
    cv::SimpleBlobDetector::Params params;
    params.minThreshold = 100;
    params.maxThreshold = 200;
    params.thresholdStep = 50;
    params.minRepeatability = 1;
    params.minDistBetweenBlobs = 1;
    params.filterByColor = true;
    params.blobColor = 255;
    params.filterByArea = true;
    params.minArea = options.minArea;
    params.maxArea = options.maxArea;
    params.filterByCircularity = params.filterByConvexity = params.filterByInertia = false;
    std::vector<cv::KeyPoint> keypoints;
    cv::SimpleBlobDetector::create(params)->detect(picture, keypoints);
    return keypoints;
}

double hueOf(double r, double g, double b) {
    return std::atan2(std::sqrt(3.0) * (g - b), 2 * r - g - b);
}

/// Which of the lit colours a spot has: the nearest hue, white where there is hardly any.
std::size_t nearestColour(const cv::Vec3d& bgr, const std::vector<LitModule>& lit, double minSaturation) {
    const double top = std::max({bgr[0], bgr[1], bgr[2], 1e-6});
    const double low = std::min({bgr[0], bgr[1], bgr[2]});
    const bool grey = (top - low) / top < minSaturation;
    std::size_t best = 0;
    double bestDistance = 1e9;
    for (std::size_t i = 0; i < lit.size(); ++i) {
        const auto& c = *lit[i].colour;
        const bool white = c[0] == c[1] && c[1] == c[2];
        double distance = 10;
        if (white != grey)
            distance = 5;
        else if (white)
            distance = 0;
        else
            distance = std::abs(
                std::remainder(hueOf(c[0], c[1], c[2]) - hueOf(bgr[2], bgr[1], bgr[0]), 2 * 3.14159265358979323846));
        if (distance < bestDistance) {
            bestDistance = distance;
            best = i;
        }
    }
    return best;
}

struct Outcome {
    std::optional<Vector2d> pixel;
    std::string reason = "lit only together with others: the paper's detector needs it alone in a frame";
};

class Detector {
  public:
    Detector(std::span<const FrameInfo> frames, const FrameLoader& load, const PaperDetectorOptions& options)
        : frames_(frames), load_(load), options_(options) {}

    tl::expected<Outcome, ScanError> alone(const std::vector<FramePair>& pairs) {
        cv::Mat overlay;
        for (const FramePair& pair : pairs) {
            const auto pictures = loadPair(pair);
            if (!pictures)
                return tl::unexpected(pictures.error());
            const cv::Mat b = binary(blurredDifference(pictures->first, pictures->second, options_), options_);
            if (overlay.empty())
                overlay = b;
            else
                cv::bitwise_and(overlay, b, overlay);  // binary images multiplied (eq. 12)
        }
        const auto found = blobs(overlay, options_);
        if (found.size() == 1)
            return Outcome{Vector2d(static_cast<double>(found[0].pt.x), static_cast<double>(found[0].pt.y)), ""};
        return Outcome{std::nullopt, found.empty() ? "no blob" : fmt::format("{} blobs instead of one", found.size())};
    }

    /// Outcome of every module lit in one coloured frame, in its order.
    tl::expected<std::vector<Outcome>, ScanError> coloured(const FramePair& pair) {
        const auto pictures = loadPair(pair);
        if (!pictures)
            return tl::unexpected(pictures.error());
        const auto& lit = frames_[pair.foreground].lit;
        std::vector<Outcome> outcomes(lit.size(), Outcome{std::nullopt, "no blob of its colour"});
        if (pictures->first.channels() != 3 || pictures->second.channels() != 3)
            return std::vector<Outcome>(lit.size(), Outcome{std::nullopt, "the frame has no colour"});
        cv::Mat difference;
        cv::subtract(pictures->first, pictures->second, difference);
        cv::GaussianBlur(difference, difference, cv::Size(options_.blurSize, options_.blurSize), options_.blurSigma);
        // The brightest channel instead of grey, in which blue would hardly show.
        std::vector<cv::Mat> channels;
        cv::split(difference, channels);
        cv::Mat top;
        cv::max(channels[0], channels[1], top);
        cv::max(top, channels[2], top);
        cv::Mat mask;
        cv::threshold(top, mask, options_.minThreshold, 255, cv::THRESH_BINARY);
        std::vector<int> count(lit.size(), 0);
        for (const cv::KeyPoint& blob : blobs(mask, options_)) {
            const cv::Point at(cvRound(blob.pt.x), cvRound(blob.pt.y));
            const cv::Vec3b c = difference.at<cv::Vec3b>(at);
            const std::size_t i = nearestColour(cv::Vec3d(c[0], c[1], c[2]), lit, options_.minSaturation);
            outcomes[i] = ++count[i] == 1
                              ? Outcome{Vector2d(static_cast<double>(blob.pt.x), static_cast<double>(blob.pt.y)), ""}
                              : Outcome{std::nullopt, "more than one blob of its colour"};
        }
        return outcomes;
    }

  private:
    tl::expected<std::pair<cv::Mat, cv::Mat>, ScanError> loadPair(const FramePair& pair) {
        const auto foreground = load_(pair.foreground);
        if (!foreground)
            return tl::unexpected(ScanError{foreground.error(), false});
        const auto background = load_(pair.background);
        if (!background)
            return tl::unexpected(ScanError{background.error(), false});
        if (foreground->size() != background->size() || foreground->type() != background->type())
            return tl::unexpected(ScanError{fmt::format("{}: expected the size and kind of {}",
                                                        frames_[pair.foreground].file, frames_[pair.background].file),
                                            false});
        return std::pair(*foreground, *background);
    }

    std::span<const FrameInfo> frames_;
    const FrameLoader& load_;
    const PaperDetectorOptions& options_;
};

}  // namespace

bool PaperDetectorOptions::validate() const {
    return blurSize > 0 && blurSize % 2 == 1 && blurSigma > 0 && thresholdShare > 0 && thresholdShare < 1 &&
           minThreshold >= 0 && binaryImages > 0 && minArea >= 0 && maxArea > minArea && sigma_px > 0;
}

bool suitsPaperDetector(std::span<const FrameInfo> frames) {
    return std::any_of(frames.begin(), frames.end(), [](const FrameInfo& frame) {
        return frame.lit.size() == 1 || (isColoured(frame) && frame.lit.size() <= 7);
    });
}

tl::expected<ViewDetections, ScanError> detectPaper(std::string name, std::span<const ModuleId> modules,
                                                    std::span<const FrameInfo> frames, const FrameLoader& load,
                                                    const PaperDetectorOptions& options, const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("PaperDetectorOptions out of range");
    std::map<ModuleId, std::vector<FramePair>> alone;
    std::vector<FramePair> coloured;
    for (std::size_t k = 0; k < frames.size(); ++k) {
        const auto background = nearestBackground(frames, k);
        if (!background)
            continue;
        if (frames[k].lit.size() == 1)
            alone[frames[k].lit[0].module].push_back({k, *background});
        else if (isColoured(frames[k]) && frames[k].lit.size() <= 7)
            coloured.push_back({k, *background});
    }

    Detector detector(frames, load, options);
    std::map<ModuleId, Outcome> outcomes;
    const auto steps = static_cast<double>(alone.size() + coloured.size());
    double step = 0;
    for (auto& [id, pairs] : alone) {
        if (context.isCancelled())
            return tl::unexpected(ScanError{"cancelled", true});
        context.report("detecting LEDs", step++ / steps);
        if (pairs.size() > static_cast<std::size_t>(options.binaryImages))
            pairs.resize(static_cast<std::size_t>(options.binaryImages));
        auto outcome = detector.alone(pairs);
        if (!outcome)
            return tl::unexpected(outcome.error());
        outcomes[id] = std::move(*outcome);
    }
    for (const FramePair& pair : coloured) {
        if (context.isCancelled())
            return tl::unexpected(ScanError{"cancelled", true});
        context.report("detecting LEDs", step++ / steps);
        auto found = detector.coloured(pair);
        if (!found)
            return tl::unexpected(found.error());
        for (std::size_t i = 0; i < found->size(); ++i) {
            Outcome& known = outcomes[frames[pair.foreground].lit[i].module];
            if (!known.pixel)
                known = std::move((*found)[i]);
        }
    }

    ViewDetections view{std::move(name), {}, {}};
    for (const ModuleId id : modules) {
        const auto outcome = outcomes.find(id);
        if (outcome != outcomes.end() && outcome->second.pixel)
            view.found.push_back({id, *outcome->second.pixel, options.sigma_px});
        else
            view.undetected.push_back({id, DetectionVerdict::NotFound,
                                       outcome != outcomes.end() ? outcome->second.reason : Outcome{}.reason});
    }
    return view;
}

}  // namespace skincal
