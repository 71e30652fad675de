#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vision/frame_pixels.h"
#include "core/vision/image_noise.h"
#include "core/vision/spot_candidates.h"

namespace skincal {

/// Brightness of a spot above its surroundings: Gaussian-weighted 5x5 core minus what a quarter of the window's edge
/// stays below. Lamps and exposure, which change both, cancel, and neighbouring spots hardly count.
struct SpotBrightness {
    double value = 0;
    double around = 0;  ///< grey level of the surroundings
    double level = 0;   ///< mean grey level of the core, for the noise
};
[[nodiscard]] SpotBrightness spotBrightness(const FramePixels& frame, const SpotCandidate& spot, int radius,
                                            int channel);
/// Standard deviation of SpotBrightness::value from camera noise, at grey level `level`.
[[nodiscard]] double spotBrightnessSigma(const ImageNoise& noise, double level, int radius);

/// Variance of SpotBrightness::around from camera noise.
[[nodiscard]] double surroundingsVariance(const ImageNoise& noise, double around, int radius);

/// True where any pixel of the spot's window is clipped.
[[nodiscard]] bool isClippedNear(const FramePixels& frame, const SpotCandidate& spot, int radius, int channel);

/// How spots go through the planes of a view.
struct SpotSeries {
    Eigen::MatrixXf light;              ///< planes x spots, SpotBrightness::value
    Eigen::MatrixXf around;             ///< planes x spots, SpotBrightness::around
    Eigen::VectorXd level;              ///< per spot, SpotBrightness::level at its highest
    std::vector<std::uint8_t> clipped;  ///< per spot, 1 where a pixel of its window is clipped in any plane

    SpotSeries(std::size_t planes, std::size_t spots);
    /// One plane of all spots.
    void read(const FramePixels& frame, std::span<const SpotCandidate> spots, int radius, std::size_t plane,
              int channel);
};

/// Light of LEDs in each plane relative to the scan's usual: a camera that steps its exposure changes all of them
/// alike. The median over what shines (half as much at least as the brightest tenth) of a spot's light over the most
/// that it has in any plane; spots that are not three times as strong as their noise are left out, those far weaker
/// than the strongest tenth, and those whose ground alone is nearly as bright. 1 where fewer than three LEDs shine, and
/// for steps of less than 5 %, which LEDs make by themselves.
/// @param sigma     per spot, of its light
/// @param litCount  per plane, how many modules are lit in it
[[nodiscard]] std::vector<double> exposureGains(const SpotSeries& series, std::span<const double> sigma,
                                                std::span<const std::size_t> litCount);

}  // namespace skincal
