#include "core/vision/paper_detector.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <set>
#include <stdexcept>

#include "core/vision/decoder.h"
#include "core/vision/frame_pixels.h"
#include "core/vision/paper_frames.h"

namespace skincal {
namespace {

using Cause = Undetected::Cause;

struct Miss {
    Cause cause = Cause::OutOfSight;
    Sentence reason;
};

/// Pixel, or why there is none.
using Outcome = tl::expected<Vector2d, Miss>;

cv::Mat blurred(const cv::Mat& foreground, const cv::Mat& background, const PaperDetectorOptions& options) {
    cv::Mat difference;
    cv::subtract(foreground, background, difference);  // saturates at 0 (eq. 11a)
    cv::GaussianBlur(difference, difference, cv::Size(options.blurSize, options.blurSize), options.blurSigma);
    return difference;
}

cv::Mat brightestChannel(const cv::Mat& picture) {
    std::vector<cv::Mat> channels;
    cv::split(picture, channels);
    cv::Mat top = channels[0];
    for (const cv::Mat& channel : channels)
        cv::max(top, channel, top);
    return top;
}

cv::Mat binary(const cv::Mat& difference, const PaperDetectorOptions& options) {
    double top = 0;
    cv::minMaxLoc(difference, nullptr, &top);
    cv::Mat result;
    cv::threshold(difference, result, std::max(top * options.thresholdShare, options.minThreshold), 255,
                  cv::THRESH_BINARY);
    return result;
}

/// Multiplies binary pictures (eq. 12).
void multiply(cv::Mat& overlay, const cv::Mat& picture) {
    if (overlay.empty())
        overlay = picture;
    else
        cv::bitwise_and(overlay, picture, overlay);
}

/// Largest first.
std::vector<cv::KeyPoint> blobs(const cv::Mat& overlay, const PaperDetectorOptions& options) {
    cv::SimpleBlobDetector::Params params;
    // Of a binary picture every threshold says the same; two are the fewest that the detector steps through.
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
    cv::SimpleBlobDetector::create(params)->detect(overlay, keypoints);
    std::stable_sort(keypoints.begin(), keypoints.end(),
                     [](const cv::KeyPoint& a, const cv::KeyPoint& b) { return a.size > b.size; });
    return keypoints;
}

Outcome onlyBlob(const std::vector<cv::KeyPoint>& found, const PaperDetectorOptions& options, bool isOfItsColour) {
    if (found.empty())
        return tl::unexpected(Miss{Cause::OutOfSight, isOfItsColour ? Sentence::saying("no blob of its colour")
                                                                    : Sentence::saying("no blob")});
    if (found.size() > options.maxBlobs)
        return tl::unexpected(Miss{
            Cause::Reflected, isOfItsColour ? Sentence::saying("{} blobs of its colour instead of one", found.size())
                                            : Sentence::saying("{} blobs instead of one", found.size())});
    return Vector2d(static_cast<double>(found[0].pt.x), static_cast<double>(found[0].pt.y));
}

double hueOf(double r, double g, double b) {
    return std::atan2(std::sqrt(3.0) * (g - b), 2 * r - g - b);
}

/// Position in `lit` of the LED whose colour a spot has, if it has that of any.
std::optional<std::size_t> ledOfColour(const cv::Vec3f& bgr, const std::vector<LitModule>& lit,
                                       const PaperDetectorOptions& options) {
    const auto b = static_cast<double>(bgr[0]);
    const auto g = static_cast<double>(bgr[1]);
    const auto r = static_cast<double>(bgr[2]);
    const double top = std::max({r, g, b});
    const bool white = top - std::min({r, g, b}) < options.minSaturation * top;
    std::optional<std::size_t> best;
    double least = options.maxHueError;
    for (std::size_t i = 0; i < lit.size(); ++i) {
        const auto colour = colourOf(lit[i]);
        if (isWhite(colour) != white)
            continue;
        if (white)
            return i;
        const double error =
            std::abs(std::remainder(hueOf(colour[0], colour[1], colour[2]) - hueOf(r, g, b), 2 * std::numbers::pi));
        if (error <= least) {
            least = error;
            best = i;
        }
    }
    return best;
}

class Detector {
  public:
    Detector(std::span<const FrameInfo> frames, const FrameLoader& load, const PaperDetectorOptions& options)
        : frames_(frames), load_(load), options_(options) {}

    /// One outcome per lit module of the group, in its order.
    tl::expected<std::vector<Outcome>, ScanError> detect(const PaperGroup& group) {
        std::vector<FramePair> pairs = group.pairs;
        if (pairs.size() > static_cast<std::size_t>(options_.binaryImages))
            pairs.resize(static_cast<std::size_t>(options_.binaryImages));
        const auto none = [&](const Sentence& why) {
            return std::vector<Outcome>(group.lit.size(), tl::unexpected(Miss{Cause::NeverBlinked, why}));
        };
        if (pairs.empty())
            return none(Sentence::saying("the view has no background frame"));
        cv::Mat overlay;
        cv::Mat colour;
        for (const FramePair& pair : pairs) {
            const auto foreground = load(pair.foreground);
            if (!foreground)
                return tl::unexpected(foreground.error());
            const auto background = load(pair.background);
            if (!background)
                return tl::unexpected(background.error());
            if (!group.coloured) {
                multiply(overlay, binary(blurred(toGrey(*foreground), toGrey(*background), options_), options_));
                continue;
            }
            if (foreground->channels() != 3 || background->channels() != 3)
                return none(Sentence::saying("lit in colours, but its pictures have none"));
            const cv::Mat difference = blurred(*foreground, *background, options_);
            multiply(overlay, binary(brightestChannel(difference), options_));
            if (colour.empty())
                colour = cv::Mat::zeros(difference.size(), CV_32FC3);
            cv::accumulate(difference, colour);  // a mean but for its scale, which has no hue
        }
        const auto found = blobs(overlay, options_);
        if (!group.coloured)
            return std::vector{onlyBlob(found, options_, false)};
        return byColour(found, colour, group.lit);
    }

  private:
    std::vector<Outcome> byColour(const std::vector<cv::KeyPoint>& found, const cv::Mat& colour,
                                  const std::vector<LitModule>& lit) const {
        std::vector<std::vector<cv::KeyPoint>> ofLed(lit.size());
        for (const cv::KeyPoint& blob : found) {
            const auto& bgr = colour.at<cv::Vec3f>(cvRound(blob.pt.y), cvRound(blob.pt.x));
            if (const auto led = ledOfColour(bgr, lit, options_))
                ofLed[*led].push_back(blob);
        }
        std::vector<Outcome> outcomes;
        outcomes.reserve(ofLed.size());
        for (const auto& candidates : ofLed)
            outcomes.push_back(onlyBlob(candidates, options_, true));
        return outcomes;
    }

    tl::expected<cv::Mat, ScanError> load(std::size_t k) {
        auto loaded = load_(k);
        if (!loaded)
            return tl::unexpected(ScanError{Sentence::verbatim(std::move(loaded.error())), false});
        const auto pixels = FramePixels::make(std::move(*loaded), frames_[k].file, size_, false);
        if (!pixels)
            return tl::unexpected(ScanError{pixels.error(), false});
        size_ = pixels->size();
        return pixels->picture();
    }

    std::span<const FrameInfo> frames_;
    const FrameLoader& load_;
    const PaperDetectorOptions& options_;
    cv::Size size_{};
};

/// What all groups together say of one module.
class Verdict {
  public:
    void add(const PaperGroup& group, const Outcome& outcome, const PaperDetectorOptions& options) {
        if (aloneDecides_ && group.coloured)
            return;
        if (!group.coloured) {
            aloneDecides_ = true;
            outcome_ = outcome;
        } else if (!outcome_ || (!*outcome_ && !contradicted_)) {
            outcome_ = outcome;
        } else if (*outcome_ && outcome && (**outcome_ - *outcome).norm() > 0.5 * options.blurSize) {
            outcome_ = tl::unexpected(Miss{
                Cause::Reflected, Sentence::saying("blobs of its colour at different places in different lit sets")});
            contradicted_ = true;
        }
    }
    [[nodiscard]] const std::optional<Outcome>& outcome() const { return outcome_; }

  private:
    std::optional<Outcome> outcome_;
    bool aloneDecides_ = false;
    bool contradicted_ = false;
};

}  // namespace

bool PaperDetectorOptions::validate() const {
    return blurSize > 0 && blurSize % 2 == 1 && blurSigma > 0 && thresholdShare > 0 && thresholdShare < 1 &&
           minThreshold >= 0 && binaryImages > 0 && minArea >= 0 && maxArea > minArea && maxBlobs > 0 &&
           nativeColours > 0 && nativeColours <= 7 && sigma_px > 0 && minSaturation > 0 && minSaturation < 1 &&
           maxHueError > 0 && maxHueError <= std::numbers::pi;
}

bool suitsPaperDetector(std::span<const FrameInfo> frames, const PaperDetectorOptions& options) {
    return !paperGroups(frames, options.nativeColours).empty();
}

tl::expected<ViewDetections, ScanError> detectPaper(std::string name, std::span<const ModuleId> modules,
                                                    std::span<const FrameInfo> frames, const FrameLoader& load,
                                                    const PaperDetectorOptions& options, const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("PaperDetectorOptions out of range");
    const std::vector<PaperGroup> groups = paperGroups(frames, options.nativeColours);
    Detector detector(frames, load, options);
    std::map<ModuleId, Verdict> verdicts;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        if (context.isCancelled())
            return tl::unexpected(ScanError{Sentence::saying("cancelled"), true});
        context.report(Sentence::saying("detecting LEDs"), static_cast<double>(i) / static_cast<double>(groups.size()));
        const auto outcomes = detector.detect(groups[i]);
        if (!outcomes)
            return tl::unexpected(outcomes.error());
        for (std::size_t j = 0; j < outcomes->size(); ++j)
            verdicts[groups[i].lit[j].module].add(groups[i], (*outcomes)[j], options);
    }

    std::set<ModuleId> everLit;
    for (const FrameInfo& frame : frames) {
        for (const LitModule& lit : frame.lit) {
            if (!isBlack(colourOf(lit)))
                everLit.insert(lit.module);
        }
    }
    ViewDetections view{std::move(name), {}, {}};
    for (const ModuleId id : modules) {
        const auto& outcome = verdicts[id].outcome();
        if (outcome && *outcome)
            view.found.push_back({id, **outcome, options.sigma_px});
        else if (outcome)
            view.undetected.push_back(
                {id, DetectionVerdict::NotFound, outcome->error().reason, {}, outcome->error().cause});
        else
            view.undetected.push_back({id,
                                       DetectionVerdict::NotFound,
                                       everLit.count(id) > 0
                                           ? Sentence::saying("lit only together with others: the paper's detector "
                                                              "needs it alone, or each LED in a colour of its own")
                                           : Sentence::saying("its LED was never lit"),
                                       {},
                                       Cause::NeverBlinked});
    }
    return view;
}

}  // namespace skincal
