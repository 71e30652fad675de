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

/// True where any pixel within `radius` of the spot is clipped.
[[nodiscard]] bool isClippedNear(const FramePixels& frame, const SpotCandidate& spot, int radius, int channel);

/// How spots go through the planes of a view.
struct SpotSeries {
    Eigen::MatrixXf light;              ///< planes x spots, SpotBrightness::value
    Eigen::MatrixXf around;             ///< planes x spots, SpotBrightness::around
    Eigen::VectorXd level;              ///< per spot, SpotBrightness::level at its highest
    std::vector<std::uint8_t> clipped;  ///< per spot, 1 where a pixel of its window is clipped in any plane
    /// Planes x spots, 1 where the pixel in the spot's middle is clipped: its light is that much, or more.
    Eigen::Array<std::uint8_t, Eigen::Dynamic, Eigen::Dynamic> isFull;

    SpotSeries(std::size_t planes, std::size_t spots);
    /// One plane of all spots.
    void read(const FramePixels& frame, std::span<const SpotCandidate> spots, int radius, std::size_t plane,
              int channel);
};

}  // namespace skincal
