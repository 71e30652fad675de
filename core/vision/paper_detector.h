#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "core/geometry/run_context.h"
#include "core/geometry/se3.h"
#include "core/vision/detection.h"
#include "core/vision/frame.h"
#include "core/vision/frame_pass.h"

namespace skincal {

/// The constants of the paper's section II-C, each with its value there; below them what it leaves open.
struct PaperDetectorOptions {
    int blurSize = 9;               ///< px, Gaussian blur of the difference; odd
    double blurSigma = 2;           ///< px, of that blur
    double thresholdShare = 0.5;    ///< of the maximum of the blurred difference (eq. 11b)
    double minThreshold = 40;       ///< grey levels, minVal of eq. 11b: nothing is detected where no LED is seen
    int binaryImages = 3;           ///< M, multiplied with each other (eq. 12)
    float minArea = 1;              ///< px, of a blob (eq. 13)
    float maxArea = 500;            ///< px, of a blob (eq. 13)
    std::size_t maxBlobs = 1;       ///< exactly one blob or none; were more allowed, the largest would count
    std::size_t nativeColours = 7;  ///< RGB combinations, so many LEDs at once in the colour variant

    double sigma_px = 0.1;              ///< what such a centre is good for; the paper gives none
    double minSaturation = 0.25;        ///< colour variant: (max - min) / max of a spot's channels; less has no hue
    double maxHueError = 30 * kDegree;  ///< colour variant, rad: native hues are 60 degrees apart, so half of that

    [[nodiscard]] bool validate() const;
};

/// The paper's LED localisation (Algorithm 2, eq. 11-13). For each module up to M frames with only its LED lit, in
/// white, each with the background frame nearest in time (nearestBackgrounds):
///   D = grey(F) - grey(B), below 0 cut off;   DB = GaussianBlur(D);   B = DB > max(thresholdShare max(DB),
///   minThreshold)
/// The M binary pictures are multiplied and given to a blob detector: exactly one blob of `minArea` to `maxArea`, or
/// the module is not available. Where a recording holds fewer than M such pairs, those it has are used.
///
/// Equation 11b as printed thresholds D at half the maximum of D, and the text only then speaks of the blur. Algorithm
/// 2 blurs first and makes the binary picture from that, else the blur would serve nothing; so DB is thresholded here.
/// Its half maximum is that of DB too: blurring with sigma 2 leaves s^2 / (s^2 + 4) of the peak of a spot of sigma s,
/// so that an LED of less than 2 px would never reach half the maximum of D, and one hot pixel would hide any LED.
///
/// Colour variant: frames with several LEDs lit at once, each in a native colour of its own (paperGroups). Frames with
/// equal lit sets are treated as above, with the brightest channel in place of grey (in which blue would hardly show);
/// one threshold holds for the whole picture, as in eq. 11b. Each blob of the product goes to the lit module with its
/// colour, by the mean difference of the M pairs at its centre: white where its saturation is below `minSaturation`,
/// else the nearest hue, if nearer than `maxHueError`; other blobs are nobody's. A module has exactly one blob or is
/// not available. Hue shifts with angle and distance, as the paper says, so that near colours are confused: prefer one
/// at a time. A module that shines alone in some frames is taken from these only. Lit sets that place a module more
/// than half of `blurSize` apart contradict each other, and it is not available.
///
/// Modules that are in no frame of either kind are reported as not found, with the reason.
/// @param modules, frames, load  as in decodeView
/// Fails with the loader's error, with that of FramePixels::make where a picture is empty, of another kind or of
/// another size than the ones before, and with "cancelled". Grey and colour pictures may be mixed: they are compared in
/// grey. Throws std::logic_error on invalid options.
[[nodiscard]] tl::expected<ViewDetections, ScanError> detectPaper(std::string name, std::span<const ModuleId> modules,
                                                                  std::span<const FrameInfo> frames,
                                                                  const FrameLoader& load,
                                                                  const PaperDetectorOptions& options = {},
                                                                  const RunContext& context = {});

/// True where the paper's detector has something to work on: a module alone in a frame, or LEDs lit in colours that
/// tell them apart.
[[nodiscard]] bool suitsPaperDetector(std::span<const FrameInfo> frames, const PaperDetectorOptions& options = {});

}  // namespace skincal
