#include "core/vision/live_motion.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/vision/decoder.h"

namespace skincal {

void LiveMotion::add(const cv::Mat& picture) {
    constexpr double kWidth_px = 480;  // some milliseconds per picture
    constexpr double kStands_px = 1.5;
    constexpr double kAlike_px = 1;
    if (picture.empty() || (size_ != cv::Size() && picture.size() != size_))
        return;
    size_ = picture.size();
    if (pictures_++ == 0)  // dark
        return;
    const double scale = std::min(0.5, kWidth_px / picture.cols);
    cv::Mat small;
    cv::resize(toGrey(picture), small, {}, scale, scale, cv::INTER_AREA);
    small.convertTo(small, CV_32F);
    if (reference_.empty()) {
        reference_ = small;
        cv::createHanningWindow(window_, small.size(), CV_32F);
        return;
    }
    const cv::Point2d shift = cv::phaseCorrelate(reference_, small, window_) / scale;
    const double away = std::hypot(shift.x, shift.y);
    const bool isSaidTwice = last_ && std::hypot(shift.x - last_->x, shift.y - last_->y) < kAlike_px;
    if (away > kStands_px && isSaidTwice)
        moved_px_ = std::max(moved_px_.value_or(0), away);
    last_ = shift;
}

}  // namespace skincal
