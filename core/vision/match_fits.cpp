#include "core/vision/match_fits.h"

#include <algorithm>
#include <limits>

namespace skincal {
namespace {

// Clipping hides a second LED from the series, which then looks like a disturbance, and makes light no longer add up.
// And the words of two LEDs may add up to those of two others, but where one of them is brighter.
double strayIn(const SpotScan& scan, const DecoderOptions& options, const MatchedSpot& match, std::size_t j,
               const SpotWindow& window, const SpotFit& fit) {
    constexpr double kNear_px = 3.5;
    constexpr double kNearWidths = 3;
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    const bool isShared = sharesSpot(match.series, j);
    if (isShared && blindShare(window, fit.centre, options.maxShift_px) > 0)
        return kUnknown;
    if (!isShared && fit.clipped && hasMoreLight(scan, match))
        return kUnknown;
    return isShared || fit.clipped
               ? match.maps[j].strayShare(fit.centre, std::max(kNear_px, kNearWidths * fit.width_px))
               : 0;
}

}  // namespace

void fitMatch(const SpotScan& scan, const DecoderOptions& options, MatchedSpot& match) {
    for (std::size_t j = 0; j < match.maps.size(); ++j) {
        const SpotWindow window = match.maps[j].window();
        const auto fit = fitSpot(window, options.fit);
        match.fits.push_back(fit);
        match.strays.push_back(fit ? strayIn(scan, options, match, j, window, *fit) : 0.0);
    }
    // Of two words that make a spot alike both are right or none.
    if (match.strays.size() == 2 && sharesSpot(match.series, 0) && sharesSpot(match.series, 1))
        match.strays[0] = match.strays[1] = std::max(match.strays[0], match.strays[1]);
    std::vector<AmplitudeMap>().swap(match.maps);
}

}  // namespace skincal
