#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/types.hpp>
#include <span>
#include <vector>

#include "core/vision/codebook.h"
#include "core/vision/frame_pixels.h"
#include "core/vision/image_noise.h"
#include "core/vision/spot_candidates.h"
#include "core/vision/spot_fit.h"

namespace skincal {

/// How to take one module's light out of the planes of a spot.
struct LightFilter {
    /// In the codebook, the wanted one first; the rest are those of other LEDs that throw light into the window. As
    /// many of these count, from the first on, as can be told apart.
    std::vector<std::size_t> words;
    std::vector<std::uint8_t> used;   ///< per plane, 0 where it was disturbed
    Eigen::VectorXf around;           ///< per plane, level of the surroundings (SpotBrightness::around)
    std::span<const double> gains{};  ///< per plane, of the exposure
    double sigma = 1;                 ///< of the spot's brightness, for how much it may follow its surroundings
    bool shared = false;              ///< the second word is that of another LED in the same spot
    bool clipped = false;             ///< whether any pixel may be: to look costs as much as all the rest
};

/// Collects, pixel by pixel in a window, the amplitude of one module's word, its variance, and what light there is that
/// the words do not explain; each frame less the level of the surroundings and over its exposure.
class AmplitudeMap {
  public:
    /// Throws std::logic_error where the first word can't be told from drift and surroundings over the used planes;
    /// those of a Matched series can.
    /// A clipped pixel bounds the light from below where it is clipped in no plane in which the module is dark, and,
    /// with other LEDs near but none in the spot, in every one in which it shines; else nothing is known of it.
    AmplitudeMap(const SpotCandidate& spot, int radius, cv::Size picture, const Codebook& codebook, LightFilter filter);

    void add(const FramePixels& frame, std::size_t plane, int channel, const ImageNoise& noise);
    /// After the last plane.
    [[nodiscard]] SpotWindow window() const;
    /// Energy of unexplained light over that of the word, noise and what that may chance to be taken off, in the pixels
    /// within `radius_px` of `centre` that are not clipped; planes in which somebody walks past don't count. Zero where
    /// it was not asked for.
    [[nodiscard]] double strayShare(const Vector2d& centre, double radius_px) const;

  private:
    using Image = Eigen::ArrayXXf;  ///< a column per row of the picture, whose pixels lie side by side

    cv::Rect rect_;
    int radius_;
    LightFilter filter_;
    Eigen::VectorXf weights_;
    Eigen::MatrixXf space_;  ///< planes x unknowns, orthonormal: what the words and the surroundings explain
    std::vector<std::uint8_t> lit_;
    std::vector<std::uint8_t> calm_;  ///< planes in which light that the word does not explain is looked for
    // Sums over the planes of what pixels have in common …
    float read_ = 0;
    float shot_ = 0;
    float offset_ = 0;
    float squaredWeights_ = 0;
    float noiseOffset_ = 0;
    // … and per pixel: of values times weights, and times squared weights.
    Image value_;
    Image variance_;
    // Only where something is clipped: in how many planes with the module lit, and not …
    Image clippedLit_;
    Image clippedDark_;
    // … and of its light the values over squared exposure, the squares, and the products with each column of space_.
    Image noise_;
    Image squares_;
    std::vector<Image> moments_;
};

}  // namespace skincal
