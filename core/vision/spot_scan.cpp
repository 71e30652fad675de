#include "core/vision/spot_scan.h"

#include <algorithm>

#include "core/geometry/statistics.h"
#include "core/vision/clipped_planes.h"
#include "core/vision/exposure_gains.h"
#include "core/vision/surroundings.h"

namespace skincal {

void SpotScan::levelExposure(int windowRadius) {
    const auto spots = static_cast<std::size_t>(series.level.size());
    sigma.resize(spots);
    for (std::size_t i = 0; i < spots; ++i)
        sigma[i] = spotBrightnessSigma(noise, series.level[static_cast<Eigen::Index>(i)], windowRadius);
    std::vector<std::size_t> litCount(codebook.planes(), 0);
    for (const auto& planes : codebook.lit) {
        for (const std::size_t plane : planes)
            ++litCount[plane];
    }
    gains.assign(codebook.planes(), 1);
    // In colours too few shine in one plane, and channels clip apart.
    if (!codebook.coloured)
        gains = exposureGains(series, sigma, litCount);
    // Where it was darker the noise counts for more.
    std::vector<double> inverse;
    for (const double gain : gains)
        inverse.push_back(1 / gain);
    const double usual = inverse.empty() ? 1 : median(std::move(inverse));
    for (double& one : sigma)
        one *= usual;
}

Eigen::VectorXd SpotScan::levelled(std::size_t candidate) const {
    Eigen::VectorXd y = series.light.col(static_cast<Eigen::Index>(candidate)).cast<double>();
    for (Eigen::Index k = 0; k < y.size(); ++k)
        y[k] /= gains[static_cast<std::size_t>(k)];
    return y;
}

Ambient SpotScan::ambientOfSpot(std::size_t candidate) const {
    return ambientOf(codebook, series.around.col(static_cast<Eigen::Index>(candidate)), gains, sigma[candidate]);
}

std::vector<std::uint8_t> SpotScan::boundsOfSpot(std::size_t candidate) const {
    // Channels are clipped and black apart, and in so few pictures there is none to spare.
    if (codebook.coloured)
        return {};
    const auto spot = static_cast<Eigen::Index>(candidate);
    std::vector<std::uint8_t> bounds = atLeastPlanes(series.isFull.col(spot), series.around.col(spot));
    if (std::find(bounds.begin(), bounds.end(), 1) == bounds.end())
        bounds.clear();
    return bounds;
}

}  // namespace skincal
