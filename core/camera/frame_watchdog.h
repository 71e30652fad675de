#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "core/camera/camera_frame.h"
#include "core/camera/camera_trouble.h"

namespace skincal {

struct FrameWatchdogOptions {
    using Time = std::chrono::microseconds;

    int width = 0;  ///< px that every picture must have; 0 takes the first picture's
    int height = 0;
    Time oldest = std::chrono::seconds(1);               ///< age at which a picture is stale
    Time newest = std::chrono::milliseconds(50);         ///< how far its time may lie ahead of now
    Time firstPicture = std::chrono::seconds(5);         ///< patience with a source that was just started
    Time nextPicture = std::chrono::milliseconds(700);   ///< patience with one that runs
    Time longestPause = std::chrono::milliseconds(250);  ///< between two checks that counts as waiting, see check()
    /// Cameras have noise: two pictures that agree in every pixel are one. Videos may stand still.
    bool mayStandStill = false;

    [[nodiscard]] bool validate() const;
};

/// Whether these are the colour bars of GStreamer's videotestsrc: seven even bars across the upper half, each darker
/// than the one to its left. No picture of a lens is that even.
/// @param image  8 bit, 1 or 3 channels; less than 70 px wide or 8 px high is never one
[[nodiscard]] bool isTestPicture(const cv::Mat& image);

/// Judges the pictures of a source that may fail without a word, and notices when no good ones come any more. Knows no
/// clock: the time is always passed in, and never goes back. For one run of the source; make another for the next.
class FrameWatchdog {
  public:
    using Time = std::chrono::microseconds;

    /// @param started  now; pictures exposed before are stale
    /// Throws std::logic_error where the options are out of range.
    FrameWatchdog(const FrameWatchdogOptions& options, Time started);

    /// What is wrong with a picture; nothing where it may be passed on. The first reason in the order of FrameFault.
    [[nodiscard]] std::optional<FrameFault> judge(const CameraFrame& frame, Time now);

    /// To be called at least every longestPause. What ended the source: no good picture for as long as options say.
    /// Where the caller itself slept longer than longestPause, the source is not blamed for the rest of that pause:
    /// pictures may have come that nobody could fetch.
    [[nodiscard]] std::optional<CameraTrouble> check(Time now);

    [[nodiscard]] std::uint64_t accepted() const { return accepted_; }
    /// How many were refused for it.
    [[nodiscard]] std::uint64_t refused(FrameFault fault) const { return refused_[static_cast<std::size_t>(fault)]; }
    [[nodiscard]] const std::array<std::uint64_t, kFrameFaults>& refused() const { return refused_; }

  private:
    [[nodiscard]] std::optional<FrameFault> faultOf(const CameraFrame& frame, Time now) const;
    [[nodiscard]] CameraTrouble trouble() const;

    FrameWatchdogOptions options_;
    Time started_;
    Time checked_;
    Time waited_{};  ///< since the last good picture
    std::optional<CameraFrame> last_;
    std::optional<FrameFault> lastFault_;  ///< since the last good picture
    std::uint64_t accepted_ = 0;
    std::array<std::uint64_t, kFrameFaults> refused_{};
};

}  // namespace skincal
