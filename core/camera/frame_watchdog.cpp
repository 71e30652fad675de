#include "core/camera/frame_watchdog.h"

#include <algorithm>
#include <stdexcept>

#include "core/vision/light_change.h"

namespace skincal {
namespace {

constexpr int kBars = 7;

}  // namespace

bool FrameWatchdogOptions::validate() const {
    return width >= 0 && height >= 0 && (width == 0) == (height == 0) && oldest > Time{} && newest >= Time{} &&
           firstPicture > Time{} && nextPicture > Time{} && longestPause > Time{};
}

bool isTestPicture(const cv::Mat& image) {
    if (image.depth() != CV_8U || image.cols < 10 * kBars || image.rows < 8)
        return false;
    const int channels = image.channels();
    // Green stands for luma: both fall from bar to bar, or stay.
    const int channel = channels == 1 ? 0 : 1;
    int brighter = 256;
    int first = 0;
    for (int bar = 0; bar < kBars; ++bar) {
        // Where bars meet they may be blended.
        const int from = image.cols * bar / kBars + 4;
        const int to = image.cols * (bar + 1) / kBars - 4;
        const int level = image.ptr(0)[from * channels + channel];
        for (const int row : {0, image.rows / 4, image.rows / 2}) {
            for (int column = from; column < to; ++column) {
                if (image.ptr(row)[column * channels + channel] != level)
                    return false;
            }
        }
        if (channels == 1 ? level >= brighter : level > brighter)
            return false;
        if (bar == 0)
            first = level;
        brighter = level;
    }
    return first - brighter > 60;
}

FrameWatchdog::FrameWatchdog(const FrameWatchdogOptions& options, Time started)
    : options_(options), started_(started), checked_(started) {
    if (!options.validate())
        throw std::logic_error("FrameWatchdogOptions out of range");
}

std::optional<FrameFault> FrameWatchdog::faultOf(const CameraFrame& frame, Time now) const {
    if (frame.image.empty())
        return FrameFault::Empty;
    if (options_.width > 0 && (frame.image.cols != options_.width || frame.image.rows != options_.height))
        return FrameFault::WrongSize;
    if (isTestPicture(frame.image))
        return FrameFault::TestPicture;
    if (last_ && frame.sequence <= last_->sequence)
        return FrameFault::RepeatedSequence;
    if (last_ && frame.time <= last_->time)
        return FrameFault::RepeatedTime;
    if (frame.time < started_ || frame.time < now - options_.oldest)
        return FrameFault::Stale;
    if (frame.time > now + options_.newest)
        return FrameFault::FromTheFuture;
    if (!options_.mayStandStill && last_ && isSamePicture(last_->image, frame.image) && !isOfOneLevel(frame.image))
        return FrameFault::RepeatedContent;
    return std::nullopt;
}

std::optional<FrameFault> FrameWatchdog::judge(const CameraFrame& frame, Time now) {
    const auto fault = faultOf(frame, now);
    if (fault) {
        ++refused_[static_cast<std::size_t>(*fault)];
        lastFault_ = fault;
        return fault;
    }
    if (options_.width == 0) {
        options_.width = frame.image.cols;
        options_.height = frame.image.rows;
    }
    ++accepted_;
    last_ = frame;
    lastFault_.reset();
    waited_ = Time{};
    checked_ = std::max(checked_, now);
    return std::nullopt;
}

std::optional<CameraTrouble> FrameWatchdog::check(Time now) {
    waited_ += std::clamp(now - checked_, Time{}, options_.longestPause);
    checked_ = std::max(checked_, now);
    if (waited_ < (accepted_ == 0 ? options_.firstPicture : options_.nextPicture))
        return std::nullopt;
    return trouble();
}

CameraTrouble FrameWatchdog::trouble() const {
    if (!lastFault_)
        return accepted_ == 0 ? CameraTrouble::NoFirstPicture : CameraTrouble::Silent;
    switch (*lastFault_) {
        case FrameFault::Empty:
            return CameraTrouble::Unreadable;
        case FrameFault::WrongSize:
            return CameraTrouble::WrongSize;
        case FrameFault::TestPicture:
            return CameraTrouble::TestPicture;
        case FrameFault::Stale:
            return CameraTrouble::Late;
        case FrameFault::RepeatedContent:
            return CameraTrouble::Frozen;
        default:
            return CameraTrouble::Unsteady;
    }
}

}  // namespace skincal
