#include "ui/presenters/scan_job.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "core/vision/decoder.h"

namespace skincal {
namespace {

/// Shift between two pictures of the same scene, px: phase correlation at half size, where noise does not matter.
double shiftBetween(const cv::Mat& a, const cv::Mat& b) {
    const auto half = [](const cv::Mat& picture) {
        cv::Mat small;
        cv::resize(toGrey(picture), small, {}, 0.5, 0.5, cv::INTER_AREA);
        small.convertTo(small, CV_32F);
        return small;
    };
    const cv::Mat first = half(a);
    cv::Mat window;
    cv::createHanningWindow(window, first.size(), CV_32F);
    const cv::Point2d shift = cv::phaseCorrelate(first, half(b), window);
    return 2 * std::hypot(shift.x, shift.y);
}

bool isLit(const FrameInfo& frame, ModuleId module) {
    return std::any_of(frame.lit.begin(), frame.lit.end(), [&](const LitModule& lit) { return lit.module == module; });
}

}  // namespace

tl::expected<ScanResult, std::string> decodeScan(std::vector<FrameInfo> frames,
                                                 std::shared_ptr<const Pictures> pictures,
                                                 const std::vector<ModuleId>& modules, const RunContext& context) {
    const FrameLoader load = [&](std::size_t frame) -> tl::expected<cv::Mat, std::string> {
        return (*pictures)[frame];
    };
    auto decoded = decodeView("view", modules, frames, load, {}, context);
    if (!decoded)
        return tl::unexpected(decoded.error().cancelled ? std::string() : decoded.error().message);
    ScanResult result;
    std::vector<std::size_t> dark;
    for (std::size_t k = 0; k < frames.size(); ++k) {
        if (frames[k].lit.empty())
            dark.push_back(k);
    }
    if (dark.size() >= 2)
        result.moved_px = shiftBetween((*pictures)[dark.front()], (*pictures)[dark.back()]);
    // LEDs tell smaller motions than the scene, and where the scene is dark.
    result.moved_px = std::max(result.moved_px, decoded->moved_px.value_or(0));
    result.view = {{}, std::move(frames), std::move(pictures), *std::move(decoded)};
    return result;
}

std::optional<SpotEvidence> evidenceOf(const ScannedView& view, ModuleId module, const Vector2d& pixel, int radius) {
    if (!view.pictures || view.pictures->empty())
        return std::nullopt;
    const cv::Size size = view.pictures->front().size();
    const cv::Rect crop =
        cv::Rect(cvRound(pixel.x()) - radius, cvRound(pixel.y()) - radius, 2 * radius + 1, 2 * radius + 1) &
        cv::Rect({}, size);
    if (crop.empty())
        return std::nullopt;
    cv::Mat lit = cv::Mat::zeros(crop.size(), CV_32F);
    cv::Mat dark = lit.clone();
    int litCount = 0;
    int darkCount = 0;
    for (std::size_t k = 0; k < view.frames.size(); ++k) {
        cv::Mat grey;
        toGrey((*view.pictures)[k](crop)).convertTo(grey, CV_32F);
        const bool on = isLit(view.frames[k], module);
        (on ? lit : dark) += grey;
        ++(on ? litCount : darkCount);
    }
    if (litCount == 0 || darkCount == 0)
        return std::nullopt;
    lit /= litCount;
    dark /= darkCount;
    SpotEvidence evidence;
    evidence.corner = crop.tl();
    cv::Mat difference = lit - dark;
    cv::minMaxLoc(difference, nullptr, &evidence.contrast);
    difference = cv::max(difference, 0.0F);
    difference.convertTo(evidence.difference, CV_8U, evidence.contrast > 0 ? 255 / evidence.contrast : 1);
    lit.convertTo(evidence.lit, CV_8U);
    dark.convertTo(evidence.dark, CV_8U);
    return evidence;
}

}  // namespace skincal
