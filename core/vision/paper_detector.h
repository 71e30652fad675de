#pragma once

#include <span>
#include <string>
#include <tl/expected.hpp>

#include "core/geometry/run_context.h"
#include "core/vision/decoder.h"
#include "core/vision/detection.h"
#include "core/vision/frame.h"

namespace skincal {

/// The constants of the paper's Algorithm 2, each with its value there.
struct PaperDetectorOptions {
    int blurSize = 9;             ///< px, Gaussian blur of the difference
    double blurSigma = 2;         ///< px
    double thresholdShare = 0.5;  ///< of the difference's maximum
    double minThreshold = 40;     ///< grey levels: excludes detections where no LED is seen
    int binaryImages = 3;         ///< M, multiplied with each other
    float minArea = 1;            ///< px, of the blob
    float maxArea = 500;
    double sigma_px = 0.1;        ///< what such a centre is good for; the paper gives none
    double minSaturation = 0.25;  ///< colour multiplexing: below it a spot has no hue

    [[nodiscard]] bool validate() const;
};

/// The paper's LED localisation (Algorithm 2, eq. 10-13): for each module a frame with only its LED lit and the
/// background frame nearest in time; grey, difference, blur, threshold, M binary images multiplied, blob detector;
/// exactly one blob or none at all. Where a recording holds fewer than M such pairs, those it has are used.
/// Colour multiplexing (up to 7 modules lit at once, each in its own native colour) takes for each lit module the
/// blobs whose hue is nearest to its colour, exactly one or none; hue shifts with angle and distance, as the paper
/// says, so that near colours are confused: prefer one at a time.
/// Modules that were lit only together with others have no such frame and are reported as not found.
[[nodiscard]] tl::expected<ViewDetections, ScanError> detectPaper(std::string name, std::span<const ModuleId> modules,
                                                                  std::span<const FrameInfo> frames,
                                                                  const FrameLoader& load,
                                                                  const PaperDetectorOptions& options = {},
                                                                  const RunContext& context = {});

/// True where the paper's detector has something to work on: a module alone in a frame, or frames lit in colours.
[[nodiscard]] bool suitsPaperDetector(std::span<const FrameInfo> frames);

}  // namespace skincal
