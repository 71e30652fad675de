#include "core/vision/match_fits.h"

#include <limits>

namespace skincal {
namespace {

// Clipping hides a second LED from the series, which then looks like a disturbance, and makes light no longer add up.
double strayIn(const SpotScan& scan, const DecoderOptions& options, const MatchedSpot& match, std::size_t j,
               const SpotWindow& window, const SpotFit& fit) {
    constexpr double kNear_px = 3.5;
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    if (sharesSpot(match.series, j))
        return isBlindNear(window, fit.centre, options.maxShift_px) ? kUnknown : 0;
    if (!fit.clipped)
        return 0;
    return hasMoreLight(scan, match) ? kUnknown : match.maps[j].strayShare(fit.centre, kNear_px);
}

}  // namespace

void fitMatch(const SpotScan& scan, const DecoderOptions& options, MatchedSpot& match) {
    for (std::size_t j = 0; j < match.maps.size(); ++j) {
        const SpotWindow window = match.maps[j].window();
        const auto fit = fitSpot(window, options.fit);
        match.fits.push_back(fit);
        match.strays.push_back(fit ? strayIn(scan, options, match, j, window, *fit) : 0.0);
    }
    std::vector<AmplitudeMap>().swap(match.maps);
}

}  // namespace skincal
