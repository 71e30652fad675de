#pragma once

#include <opencv2/core/types.hpp>
#include <span>
#include <vector>

#include "core/vision/codebook.h"
#include "core/vision/frame_pixels.h"
#include "core/vision/image_noise.h"
#include "core/vision/spot_candidates.h"
#include "core/vision/spot_fit.h"

namespace skincal {

/// Brightness of a spot above its surroundings: Gaussian-weighted 5x5 core minus the median of the window's edge.
/// Lamps and exposure, which change both, cancel.
struct SpotBrightness {
    double value = 0;
    double level = 0;  ///< mean grey level of the core, for the noise
};
[[nodiscard]] SpotBrightness spotBrightness(const FramePixels& frame, const SpotCandidate& spot, int radius,
                                            int channel);
/// Standard deviation of SpotBrightness::value from camera noise, at grey level `level`.
[[nodiscard]] double spotBrightnessSigma(const ImageNoise& noise, double level, int radius);

/// Collects, pixel by pixel in a window, the amplitude of one module's word, its variance, and what light there is that
/// the word does not explain; each frame less the median of the window's edge.
class AmplitudeMap {
  public:
    /// @param words  all words in the series of this spot, @param index the one whose light is wanted
    /// @param used   planes that were not disturbed
    /// Throws std::logic_error where the words can't be separated over those planes; those of a Matched series can.
    /// A clipped pixel bounds the light from below where the word is the only one; with two nothing is known of it.
    AmplitudeMap(const SpotCandidate& spot, int radius, cv::Size picture, const Codebook& codebook,
                 std::span<const std::size_t> words, std::size_t index, std::span<const std::uint8_t> used);

    void add(const FramePixels& frame, std::size_t plane, int channel, const ImageNoise& noise);
    [[nodiscard]] const SpotWindow& window() const { return window_; }
    /// Energy of unexplained light over that of the word, noise taken off, in the pixels within `radius_px` of `centre`
    /// that are not clipped.
    [[nodiscard]] double strayShare(const Vector2d& centre, double radius_px) const;
    /// True where a pixel within `radius_px` of `centre` tells nothing because it was clipped.
    [[nodiscard]] bool blindNear(const Vector2d& centre, double radius_px) const;

  private:
    [[nodiscard]] double distance(Eigen::Index row, Eigen::Index col, const Vector2d& centre) const;

    SpotCandidate spot_;
    int radius_;
    SpotWindow window_;
    Eigen::RowVectorXd weights_;
    Eigen::MatrixXd space_;
    std::vector<std::uint8_t> lit_;
    std::vector<std::uint8_t> used_;
    std::vector<Eigen::ArrayXXd> moments_;  ///< per column of space_
    Eigen::ArrayXXd squares_;
    Eigen::ArrayXXd noise_;
    bool alone_;
};

}  // namespace skincal
