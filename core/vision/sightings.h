#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/vision/decoder.h"
#include "core/vision/matched_spot.h"

namespace skincal {

/// One spot that blinks the word of one module.
struct Sighting {
    std::size_t module = 0;
    SpotFit fit;
    double when = 0.5;      ///< in the scan it is seen on average, 0 to 1
    std::size_t match = 0;  ///< which of the matches tells it
};

/// Those of the matches' fits that are the light of an LED, by module and brightest first; why others are not goes to
/// `verdicts`.
[[nodiscard]] std::vector<Sighting> sightingsOf(const SpotScan& scan, const std::vector<MatchedSpot>& matches,
                                                const DecoderOptions& options, Verdicts& verdicts);

/// The spots that may be a module's LED, brightest first; of several finds of one spot the sharpest counts.
/// @param finds     all of one module, brightest first
/// @param faintest  share of the brightest one's light; what has less is a reflection
[[nodiscard]] std::vector<Sighting> distinctSpots(std::span<const Sighting> finds, double faintest,
                                                  const DecoderOptions& options);

/// The modules that are seen twice.
/// @param sightings  by module and brightest first
/// @param counts     per module, 0: it shares its word with others, and may be seen twice for that
[[nodiscard]] std::vector<MirroredPair> mirroredPairs(std::span<const Sighting> sightings,
                                                      std::span<const std::uint8_t> counts, double sameSpot_px);

/// Why none of several spots was taken, nor a single one that may be a reflection (MirrorSide), with the spots for
/// whoever knows more than the picture.
[[nodiscard]] Undetected undecided(const std::vector<Sighting>& spots, const DecoderOptions& options);

/// A knock of more than a spot's width: many spots show their words only up to one plane, or only from it on, and
/// modules may be here before and there afterwards. By how much, px, or a spot's width where nothing tells; nothing
/// where there was no knock.
[[nodiscard]] std::optional<double> knocked_px(const std::vector<Sighting>& sightings,
                                               const std::vector<MatchedSpot>& matches);

}  // namespace skincal
