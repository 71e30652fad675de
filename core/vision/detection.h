#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/ids.h"
#include "core/geometry/se3.h"
#include "core/geometry/sentence.h"
#include "core/vision/word_reading.h"

namespace skincal {

/// Where an LED was found in one view: raw (distorted) pixel and its standard deviation per axis.
struct LedDetection {
    ModuleId module;
    Vector2d pixel = Vector2d::Zero();
    double sigma_px = 0.1;
};

/// What became of a module in a view's picture.
enum class DetectionVerdict { Found, NotFound, Ambiguous };

/// A spot that blinks the word of a module and may be its LED or a reflection of it.
struct SpotChoice {
    Vector2d pixel = Vector2d::Zero();  ///< raw (distorted)
    double sigma_px = 0.1;              ///< per axis
    double strength = 1;                ///< its light over that of the brightest of them, 0 … 1
    WordReading reading{};              ///< where it was decoded from pictures
};

/// The two brightest spots of a module that is seen twice, the brighter one first: a mirror, if there is one, has the
/// LED there and its reflection here.
struct MirroredPair {
    Vector2d led = Vector2d::Zero();         ///< raw (distorted)
    Vector2d reflection = Vector2d::Zero();  ///< likewise
    double strength = 1;                     ///< light of the second over that of the first
};

/// The spot that came nearest to being the LED of a module that was not found: the brightest of those that were refused
/// for the same verdict.
struct NearestSpot {
    Vector2d pixel = Vector2d::Zero();  ///< raw (distorted)
    WordReading reading{};
};

/// A module that the decoder did not accept, and why ("two spots blink its word", "no spot above the noise", …).
struct Undetected {
    /// The reason in a word, for whoever sorts by it.
    enum class Cause {
        OutOfSight,    ///< nothing in the picture blinks its word
        TooWeak,       ///< something may blink its word, but is too faint to be sure
        Reflected,     ///< several spots blink its word, or one that may be a reflection
        Alike,         ///< the word of another module fits as well, or is the same
        NotAnLed,      ///< what blinks its word is no round spot of its own: stray light, the light of others
        TooBright,     ///< its spot is clipped, and its centre can't be told
        NeverBlinked,  ///< it was not lit so that it could be told from others or from the room
        CameraMoved,   ///< while its word was shown
        Rejected,      ///< by the operator
    };
    ModuleId module;
    DetectionVerdict verdict = DetectionVerdict::NotFound;
    Sentence reason;
    /// Where several spots blink its word alike: all of them, brightest first. The picture can't tell which is the LED;
    /// what is known of the body may (see settleSpots). A single one where it may be a reflection itself. Empty where
    /// there is nothing to choose from.
    std::vector<SpotChoice> spots{};
    Cause cause = Cause::OutOfSight;
    std::optional<NearestSpot> nearest{};  ///< empty where nothing blinks like it, or nothing can
};

/// Everything the picture of one view yields.
struct ViewDetections {
    std::string name;
    std::vector<LedDetection> found;
    std::vector<Undetected> undetected;
    std::vector<WordReading> readings{};  ///< one per `found`, where they were decoded from pictures
    std::optional<double> moved_px{};     ///< by which the camera moved in the scan, or more; empty: LEDs can't tell
    /// Spots that blink like LEDs, and like none that was found: light of modules that could not be told apart, or of
    /// something else. Of the last look, where there were several.
    std::size_t unexplained = 0;
    std::size_t look = 0;  ///< the first look that counts: its camera's are the pixels of all that is found
    std::vector<MirroredPair> mirrored{};  ///< of all looks
};

}  // namespace skincal
