#pragma once

#include <optional>
#include <span>
#include <tl/expected.hpp>
#include <vector>

#include "core/vision/decoder.h"
#include "core/vision/matched_spot.h"

namespace skincal {

/// What the pictures of one look say, before it is decided who is where.
struct MeasuredSpots {
    SpotScan scan;
    std::vector<MatchedSpot> matches{};  ///< with their fits
    std::optional<double> moved_px{};    ///< by which the camera moved in the scan, as far as the spots tell
    DecoderOptions options{};            ///< that they were measured with at last
    Verdicts verdicts;
};

/// The three passes over the pictures of one look, of which two are done again, once or twice, in larger windows where
/// spots are too wide for DecoderOptions::windowRadius, or most modules fit none. Fails as decodeView.
[[nodiscard]] tl::expected<MeasuredSpots, ScanError> measureSpots(std::span<const ModuleId> modules,
                                                                  std::span<const FrameInfo> frames,
                                                                  const FrameLoader& load,
                                                                  const DecoderOptions& options,
                                                                  const RunContext& context);

}  // namespace skincal
