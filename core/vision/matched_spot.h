#pragma once

#include <optional>
#include <span>
#include <tl/expected.hpp>
#include <vector>

#include "core/geometry/run_context.h"
#include "core/vision/detection.h"
#include "core/vision/spot_scan.h"
#include "core/vision/verdicts.h"
#include "core/vision/word_match.h"

namespace skincal {

/// Light that some words explain together, and a map and then a fit per word.
struct MatchedSpot {
    SpotCandidate spot;
    std::size_t candidate = 0;  ///< position in the scan's series
    SeriesMatch series;
    std::vector<AmplitudeMap> maps{};  ///< until they are fitted
    std::vector<tl::expected<SpotFit, SpotFitError>> fits{};
    /// Per fit, of a clipped or shared spot's light what follows another word; infinite: no telling.
    std::vector<double> strays{};
};

/// True where another LED's light in the spot is comparable with that of the match's word j: more than a quarter of it.
/// What is weaker is the skirt of a neighbour, with a spot of its own.
[[nodiscard]] bool sharesSpot(const SeriesMatch& series, std::size_t j);

/// The candidates whose series a word explains, or two; what else is to be said of words goes to `verdicts`. Nothing
/// where the context asks to stop.
[[nodiscard]] std::optional<std::vector<MatchedSpot>> matchCandidates(const SpotScan& scan,
                                                                      std::span<const SpotCandidate> candidates,
                                                                      std::span<const ModuleId> modules,
                                                                      const WordMatchOptions& options,
                                                                      const RunContext& context, Verdicts& verdicts);

/// True where a disturbed plane is brighter than the first word makes it: what hides an LED makes it darker. Who walks
/// past may be brighter than the ground, but changes the surroundings (calmPlanes).
[[nodiscard]] bool hasMoreLight(const SpotScan& scan, const MatchedSpot& match);

/// @param module  one of those whose words match, or nearly do
[[nodiscard]] WordReading readingOf(const SpotScan& scan, const MatchedSpot& match, std::size_t module);
[[nodiscard]] NearestSpot nearestSpot(const SpotScan& scan, const MatchedSpot& match, std::size_t module);

}  // namespace skincal
