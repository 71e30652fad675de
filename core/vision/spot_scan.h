#pragma once

#include <vector>

#include "core/vision/amplitude_map.h"
#include "core/vision/spot_series.h"

namespace skincal {

/// What a view's pictures say of the places where something blinks, besides the pictures.
struct SpotScan {
    Codebook codebook;
    ImageNoise noise;
    SpotSeries series{0, 0};    ///< of the candidates
    std::vector<double> gains;  ///< per plane, exposureGains
    std::vector<double> sigma;  ///< per candidate, of its series at the usual exposure

    /// Sets gains and sigma.
    void levelExposure(int windowRadius);
    /// A candidate's series as if the exposure had not changed.
    [[nodiscard]] Eigen::VectorXd levelled(std::size_t candidate) const;
    [[nodiscard]] Ambient ambientOfSpot(std::size_t candidate) const;
    /// Planes in which a candidate has its light or more, as what it adds is cut off (atLeastPlanes); empty where
    /// there are none, and in colours.
    [[nodiscard]] std::vector<std::uint8_t> boundsOfSpot(std::size_t candidate) const;
};

}  // namespace skincal
