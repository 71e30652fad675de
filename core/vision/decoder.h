#pragma once

#include <span>
#include <string>
#include <tl/expected.hpp>

#include "core/geometry/run_context.h"
#include "core/vision/detection.h"
#include "core/vision/frame.h"
#include "core/vision/frame_pass.h"
#include "core/vision/spot_candidates.h"
#include "core/vision/spot_fit.h"
#include "core/vision/word_match.h"

namespace skincal {

struct DecoderOptions {
    SpotCandidateOptions candidates{};
    WordMatchOptions words{};
    SpotFitOptions fit{};
    int windowRadius = 5;          ///< half the side of the window around a spot, at least; larger for wide spots
    double maxShift_px = 2.5;      ///< how far the fitted centre may lie from a candidate of one LED, its middle seen
    double maxStrayShare = 0.02;   ///< of a clipped or shared spot's light that may follow another word
    double sameSpot_px = 2;        ///< two finds of one module nearer than this are one
    double reflectionRatio = 2.5;  ///< flux ratio from which the weaker of two spots is a reflection
    double maxMotion_px = 1;       ///< of the camera within the scan; beyond it nothing is found
    int maxSpots = 4;              ///< of one module that are handed on; where there are more, none is
    int candidatesPerModule = 8;   ///< limits the candidates to this times the modules …
    int extraCandidates = 500;     ///< … plus this

    [[nodiscard]] bool validate() const;
};

/// Finds every module's LED in a view from frames with any lit sets: one at a time between backgrounds, patterns with
/// or without complements, repeats, colours (which ColourMixing tells apart, where there is a picture of all LEDs in
/// each of red, green and blue). Three passes over the frames: where does anything blink (SpotFinder); what does it
/// blink (a series per candidate, WordMatcher); what does its light look like (per pixel the least-squares amplitude of
/// the module's word, neighbours' light taken off, fitSpot); the latter two again in larger windows where spots turn
/// out to be wide, as of a lens out of focus. Memory grows with candidates times frames, never pictures times frames.
///
/// Where modules were looked for again (FurtherLooks), each look is decoded by itself and adds to those before it
/// (addLook).
///
/// Every module is either in `found` or in `undetected` with the reason:
///   NotFound   never or always lit; no spot blinks its word; its spot has not the shape of an LED; the camera moved by
///              more than `maxMotion_px` in the scan
///   Ambiguous  another module has the same word; another word fits its spot as well; its spot has other light in it,
///              or is that of another module, too; two spots of similar strength blink its word (a reflection less than
///              `reflectionRatio` weaker): these are handed on as Undetected::spots, at most `maxSpots` of them; where
///              there are more, none is. So is the only spot of a module where the picture, or that of an earlier look,
///              shows others reflected (MirrorSide): a mirror also shows modules that are out of the camera's sight,
///              and there `reflectionRatio` does not count. Where it shows those alone, three modules of which are not
///              seen twice, a picture can't tell, and they are found: where they are not. settleSpots decides of the
///              former by the body, and what rejects observations that no body explains does of the latter
/// A spot shared by two LEDs is separated where both centres can be fitted, else neither is reported. Where the camera
/// moved a little, half of that is part of every standard deviation: when it moved is not known.
/// @param modules  all modules of the skin; a frame that lights any other is an error
/// @param frames   in the order in which they were taken
/// @param load     called for each frame three times, or up to seven where spots are wide, and a few times more where
///                 LEDs shine in colours
/// Fails with a sentence on a loader error (passed on), frames of different sizes, lit sets that make no sense,
/// pictures that show what was lit before them (picturesLate), and "cancelled". Throws std::logic_error on invalid
/// options.
[[nodiscard]] tl::expected<ViewDetections, ScanError> decodeView(std::string name, std::span<const ModuleId> modules,
                                                                 std::span<const FrameInfo> frames,
                                                                 const FrameLoader& load,
                                                                 const DecoderOptions& options = {},
                                                                 const RunContext& context = {});

/// Adds the looks from `frames[first]` on to a view of the frames before: what decodeView of all of them gives, without
/// decoding the earlier ones once more. Fails and throws likewise.
[[nodiscard]] tl::expected<ViewDetections, ScanError> decodeFurther(
    ViewDetections view, std::size_t first, std::span<const ModuleId> modules, std::span<const FrameInfo> frames,
    const FrameLoader& load, const DecoderOptions& options = {}, const RunContext& context = {});

/// 8-bit grey of what a loader returned.
[[nodiscard]] cv::Mat toGrey(const cv::Mat& frame);

}  // namespace skincal
