#include "ui/presenters/spot_evidence.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "core/vision/decoder.h"
#include "core/vision/paper_detector.h"
#include "core/vision/spot_fit.h"

namespace skincal {
namespace {

bool isLit(const FrameInfo& frame, ModuleId module) {
    return std::any_of(frame.lit.begin(), frame.lit.end(), [&](const LitModule& lit) { return lit.module == module; });
}

/// Pictures added up.
struct Sum {
    cv::Mat sum;
    cv::Mat squares;
    int count = 0;

    explicit Sum(const cv::Size& size) : sum(cv::Mat::zeros(size, CV_64F)), squares(sum.clone()) {}
    void add(const cv::Mat& picture) {
        cv::accumulate(picture, sum);
        cv::accumulateSquare(picture, squares);
        ++count;
    }
    [[nodiscard]] cv::Mat mean() const { return sum / count; }
    /// Of one picture.
    [[nodiscard]] cv::Mat variance() const {
        const cv::Mat m = mean();
        return cv::max(squares / count - m.mul(m), 0.0);
    }
};

/// As the decoder does, but of the mean over all pictures: other LEDs' light counts as noise.
std::optional<double> widthOf(const cv::Mat& difference, const Sum& lit, const Sum& dark, const cv::Point& at) {
    constexpr int kRadius = 5;
    constexpr double kClipped = 250;
    constexpr double kLeastVariance = 0.1;  // rounding to grey levels
    const cv::Rect area =
        cv::Rect(at.x - kRadius, at.y - kRadius, 2 * kRadius + 1, 2 * kRadius + 1) & cv::Rect({}, difference.size());
    if (area.width < kRadius || area.height < kRadius)
        return std::nullopt;
    const cv::Mat darkVariance = dark.variance();
    const cv::Mat variance = (lit.count > 1 ? lit.variance() : darkVariance) / lit.count + darkVariance / dark.count;
    const cv::Mat level = lit.mean();
    SpotWindow window{area.x, area.y, {}, {}, {}};
    window.value.resize(area.height, area.width);
    window.variance.resize(area.height, area.width);
    window.state.resize(area.height, area.width);
    for (int y = 0; y < area.height; ++y) {
        for (int x = 0; x < area.width; ++x) {
            const cv::Point pixel(area.x + x, area.y + y);
            window.value(y, x) = difference.at<double>(pixel);
            window.variance(y, x) = variance.at<double>(pixel) + kLeastVariance;
            window.state(y, x) = level.at<double>(pixel) > kClipped ? PixelState::Saturated : PixelState::Good;
        }
    }
    const auto fit = fitSpot(window);
    return fit ? std::optional(fit->width_px) : std::nullopt;
}

/// The crop as large as was asked for, though the picture ends.
cv::Mat padded(const cv::Mat& picture, const cv::Rect& inside, const cv::Rect& wanted) {
    cv::Mat eight;
    picture.convertTo(eight, CV_8U);
    cv::Mat result = cv::Mat::zeros(wanted.size(), CV_8U);
    eight.copyTo(result(inside - wanted.tl()));
    return result;
}

/// The one that decided about a module: where it was found or nearly was, or else the last in which it shone.
std::size_t lookFor(const ScannedView& view, ModuleId module) {
    const ViewDetections& decoded = view.decoded;
    for (std::size_t i = 0; i < std::min(decoded.found.size(), decoded.readings.size()); ++i) {
        if (decoded.found[i].module == module)
            return decoded.readings[i].look;
    }
    for (const Undetected& undetected : decoded.undetected) {
        if (undetected.module == module && undetected.nearest)
            return undetected.nearest->reading.look;
    }
    std::size_t look = decoded.look;
    for (const FrameInfo& frame : view.frames) {
        if (isLit(frame, module))
            look = std::max(look, frame.look);
    }
    return look;
}

}  // namespace

const cv::Mat& pictureOf(const ScannedView& view) {
    const auto first = std::find_if(view.frames.begin(), view.frames.end(),
                                    [&](const FrameInfo& frame) { return frame.look == view.decoded.look; });
    const auto dark = first == view.frames.end() ? 0 : static_cast<std::size_t>(first - view.frames.begin());
    return (*view.pictures)[std::min(dark + 1, view.pictures->size() - 1)];
}

std::optional<SpotEvidence> evidenceOf(const ScannedView& view, ModuleId module, const Vector2d& pixel, int radius) {
    if (!view.pictures || view.pictures->empty())
        return std::nullopt;
    const cv::Point centre(cvRound(pixel.x()), cvRound(pixel.y()));
    const cv::Rect wanted(centre.x - radius, centre.y - radius, 2 * radius + 1, 2 * radius + 1);
    const cv::Rect inside = wanted & cv::Rect({}, view.pictures->front().size());
    if (inside.empty())
        return std::nullopt;
    Sum lit(inside.size());
    Sum dark(inside.size());
    const std::size_t look = lookFor(view, module);
    for (std::size_t k = 0; k < view.frames.size(); ++k) {
        if (view.frames[k].look == look)
            (isLit(view.frames[k], module) ? lit : dark).add(toGrey((*view.pictures)[k](inside)));
    }
    if (lit.count == 0 || dark.count == 0)
        return std::nullopt;
    SpotEvidence evidence;
    evidence.corner = wanted.tl();
    const cv::Mat difference = lit.mean() - dark.mean();
    evidence.width_px = widthOf(difference, lit, dark, centre - inside.tl());
    cv::minMaxLoc(difference, nullptr, &evidence.contrast);
    const cv::Mat light = cv::max(difference, 0.0);

    const PaperDetectorOptions paper;
    cv::Mat blurred;
    cv::GaussianBlur(light, blurred, cv::Size(paper.blurSize, paper.blurSize), paper.blurSigma);
    double top = 0;
    cv::minMaxLoc(blurred, nullptr, &top);
    evidence.level = paper.thresholdShare * top;

    evidence.lit = padded(lit.mean(), inside, wanted);
    evidence.dark = padded(dark.mean(), inside, wanted);
    evidence.difference = padded(evidence.contrast > 0 ? light * (255 / evidence.contrast) : light, inside, wanted);
    evidence.threshold = padded(blurred > evidence.level, inside, wanted);
    return evidence;
}

std::optional<OverlayModule> placeByBody(const Session& session, const std::string& view, ModuleId module) {
    const auto& solution = session.solution();
    if (!solution || !session.decisions().camera)
        return std::nullopt;
    for (const BodyView& solved : solution->body.views) {
        if (solved.name != view)
            continue;
        const ModelOverlay overlay = overlayOf(solution->body, solved, *session.decisions().camera);
        const auto found = std::find_if(overlay.modules.begin(), overlay.modules.end(),
                                        [&](const OverlayModule& other) { return other.module == module; });
        return found == overlay.modules.end() ? std::nullopt : std::optional(*found);
    }
    return std::nullopt;
}

}  // namespace skincal
