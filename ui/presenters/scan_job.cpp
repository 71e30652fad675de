#include "ui/presenters/scan_job.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "core/vision/decoder.h"
#include "core/vision/looks.h"

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

}  // namespace

tl::expected<ScanResult, Sentence> decodeScan(std::vector<FrameInfo> frames, std::shared_ptr<const Pictures> pictures,
                                              const std::vector<ModuleId>& modules, const RunContext& context,
                                              std::optional<ViewDetections> before) {
    const FrameLoader load = [&](std::size_t frame) -> tl::expected<cv::Mat, std::string> {
        return (*pictures)[frame];
    };
    const std::size_t last = beginningsOfLooks(frames).back();
    auto decoded = before ? decodeFurther(*std::move(before), last, modules, frames, load, {}, context)
                          : decodeView("view", modules, frames, load, {}, context);
    if (!decoded)
        return tl::unexpected(decoded.error().cancelled ? Sentence() : decoded.error().message);
    ScanResult result;
    // Between looks LEDs tell it, and what a knock spoilt is not used.
    std::vector<std::size_t> dark;
    for (std::size_t k = 0; k < frames.size(); ++k) {
        if (frames[k].lit.empty() && frames[k].look == frames.back().look)
            dark.push_back(k);
    }
    if (dark.size() >= 2)
        result.moved_px = shiftBetween((*pictures)[dark.front()], (*pictures)[dark.back()]);
    // LEDs tell smaller motions than the scene, and where the scene is dark.
    result.moved_px = std::max(result.moved_px, decoded->moved_px.value_or(0));
    result.view = {{}, std::move(frames), std::move(pictures), *std::move(decoded)};
    return result;
}

}  // namespace skincal
