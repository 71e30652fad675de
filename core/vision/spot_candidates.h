#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "core/vision/frame_pixels.h"
#include "core/vision/image_noise.h"

namespace skincal {

struct SpotCandidateOptions {
    double minContrast = 2.5;     ///< grey levels above the surroundings, after smoothing
    double noiseFactor = 7;       ///< … and this many times the spread of the contrast map
    double smoothing_px = 1.2;    ///< standard deviation of the smoothing, about that of a spot
    double minDistance_px = 2.5;  ///< of two candidates
    int surroundings_px = 15;     ///< side of the square that counts as a spot's surroundings

    [[nodiscard]] bool validate() const;
};

/// A place whose brightness jumps between frames.
struct SpotCandidate {
    int x = 0;
    int y = 0;
    double contrast = 0;
};

/// First pass over a view: remembers for every pixel how much it changes from frame to frame on average, which shows
/// LEDs that blink all the time as sharply as the picture has them; and at half the size, after smoothing, the largest
/// jump between one frame and the next and the largest flash (a jump that the frame after takes back). Slow drift of
/// the lighting leaves no trace in these, and an LED that shines in a single frame of thousands stands out as much as
/// one that blinks all the time. The outline of something that moves jumps, and would hide the LEDs that it passes, but
/// hardly flashes.
/// The memory needed does not depend on the number of frames.
class SpotFinder {
  public:
    explicit SpotFinder(const SpotCandidateOptions& options = {});

    /// Frames in the order in which they were taken, all of one size. The last one is kept, not copied: its pixels must
    /// stay as they are.
    void add(const FramePixels& frame, bool coloured);
    [[nodiscard]] ImageNoise noise() const { return noise_.estimate(); }
    /// Local maxima that rise above their surroundings by more than the noise, strongest first, at most `most`. A lamp
    /// that flickers over a large area is no candidate; the outline of something that moved may be.
    [[nodiscard]] std::vector<SpotCandidate> candidates(std::size_t most) const;

  private:
    /// Updates jump_, flash_ and `lastStep`.
    void noteStep(const cv::Mat& now, const cv::Mat& before, cv::Mat& lastStep);

    SpotCandidateOptions options_;
    ImageNoiseEstimator noise_;
    std::vector<cv::Mat> last_;          ///< 8-bit plane of the frame before, one per channel
    std::vector<cv::Mat> lastContrast_;  ///< localContrast of it
    std::vector<cv::Mat> lastStep_;      ///< of that from the frame before to it
    cv::Mat sum_;                        ///< of absolute differences from frame to frame, as large as the picture
    int summed_ = 0;                     ///< how many there were
    cv::Mat jump_;
    cv::Mat flash_;
};

}  // namespace skincal
