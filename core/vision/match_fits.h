#pragma once

#include "core/vision/decoder.h"
#include "core/vision/matched_spot.h"

namespace skincal {

/// Fits a spot to each of the match's maps, once they are complete, and gives their memory back.
void fitMatch(const SpotScan& scan, const DecoderOptions& options, MatchedSpot& match);

}  // namespace skincal
