#pragma once

#include <vector>

#include "core/vision/decoder.h"
#include "core/vision/matched_spot.h"
#include "core/vision/scan_motion.h"

namespace skincal {

/// Makes the maps of all matches, each with the words of its neighbours, and has some spots all over the picture
/// watched for a camera that moves.
void prepareMaps(const SpotScan& scan, cv::Size size, const DecoderOptions& options, std::vector<MatchedSpot>& matches,
                 ScanMotion& motion);

}  // namespace skincal
