#include "core/vision/match_fits.h"

#include <limits>

namespace skincal {
namespace {

bool blindNear(const SpotWindow& window, const Vector2d& centre, double radius_px) {
    for (Eigen::Index row = 0; row < window.state.rows(); ++row) {
        for (Eigen::Index col = 0; col < window.state.cols(); ++col) {
            const Vector2d pixel(static_cast<double>(window.x0 + col), static_cast<double>(window.y0 + row));
            if (window.state(row, col) == PixelState::Excluded && (pixel - centre).norm() <= radius_px)
                return true;
        }
    }
    return false;
}

// Clipping hides a second LED from the series, which then looks like a disturbance, and makes light no longer add up.
double strayIn(const SpotScan& scan, const DecoderOptions& options, const MatchedSpot& match, std::size_t j,
               const SpotWindow& window, const SpotFit& fit) {
    constexpr double kNear_px = 3.5;
    constexpr double kUnknown = std::numeric_limits<double>::infinity();
    if (sharesSpot(match.series, j))
        return blindNear(window, fit.centre, options.maxShift_px) ? kUnknown : 0;
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
