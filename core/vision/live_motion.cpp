#include "core/vision/live_motion.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/vision/decoder.h"

namespace skincal {
namespace {

/// Edges and spots: what is brighter as a whole tells of no motion.
cv::Mat detailOf(const cv::Mat& picture, double scale) {
    cv::Mat small;
    cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
    small.convertTo(small, CV_32F);
    // Wide enough to meet though they are shifted by half a pixel.
    cv::GaussianBlur(small, small, {}, 1);
    cv::Mat ground;
    cv::GaussianBlur(small, ground, {}, 3);
    return small - ground;
}

/// Offset of the vertex of a parabola through three values of which the middle one is the largest.
double vertex(float before, float at, float after) {
    const double curvature = static_cast<double>(before) - 2.0 * static_cast<double>(at) + static_cast<double>(after);
    return curvature < 0 ? 0.5 * (static_cast<double>(before) - static_cast<double>(after)) / curvature : 0;
}

/// By how much a picture is shifted against another of the same size; empty where they are not alike at any shift. All
/// that either shows has a say: of parts alone a few LEDs may look like others.
std::optional<cv::Point2d> shiftBetween(const cv::Mat& reference, const cv::Mat& picture, int reach) {
    constexpr double kAlike = 0.25;
    cv::Mat wide;
    cv::copyMakeBorder(reference, wide, reach, reach, reach, reach, cv::BORDER_CONSTANT, cv::Scalar(0));
    cv::Mat likeness;
    cv::matchTemplate(wide, picture, likeness, cv::TM_CCORR);
    double most = 0;
    cv::Point at;
    cv::minMaxLoc(likeness, nullptr, &most, nullptr, &at);
    if (!(most > kAlike * cv::norm(reference) * cv::norm(picture)))
        return std::nullopt;
    cv::Point2d shift(at.x - reach, at.y - reach);
    if (at.x > 0 && at.x + 1 < likeness.cols)
        shift.x +=
            vertex(likeness.at<float>(at.y, at.x - 1), likeness.at<float>(at), likeness.at<float>(at.y, at.x + 1));
    if (at.y > 0 && at.y + 1 < likeness.rows)
        shift.y +=
            vertex(likeness.at<float>(at.y - 1, at.x), likeness.at<float>(at), likeness.at<float>(at.y + 1, at.x));
    return shift;
}

}  // namespace

void LiveMotion::add(const cv::Mat& picture) {
    constexpr double kWidth_px = 320;  // some milliseconds per picture
    constexpr double kStands_px = 1.5;
    constexpr double kSame_px = 1;
    if (picture.empty() || (size_ != cv::Size() && picture.size() != size_))
        return;
    size_ = picture.size();
    if (pictures_++ == 0)  // dark
        return;
    const double scale = std::min(0.5, kWidth_px / picture.cols);
    const cv::Mat detail = detailOf(toGrey(picture), scale);
    if (reference_.empty()) {
        reference_ = detail;
        return;
    }
    const auto shift = shiftBetween(reference_, detail, detail.rows / 5);
    if (!shift)
        return;
    const cv::Point2d away = *shift / scale;
    const double way = std::hypot(away.x, away.y);
    const bool isSaidTwice = last_ && std::hypot(away.x - last_->x, away.y - last_->y) < kSame_px;
    if (way > kStands_px && isSaidTwice)
        moved_px_ = std::max(moved_px_.value_or(0), way);
    last_ = away;
}

}  // namespace skincal
