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
    /// Whether pixels may be clipped, or strayShare will be asked for: to look costs as much as all the rest.
    bool doubtful = false;
};

/// One of a view's planes with its picture.
struct FramePlane {
    std::size_t plane = 0;
    int channel = -1;
    FramePixels frame;
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

    /// Some planes, of which each is added once; several at a time take much less than one by one.
    void add(std::span<const FramePlane> planes, const ImageNoise& noise);
    /// After the last plane.
    [[nodiscard]] SpotWindow window() const;
    /// Energy of unexplained light over that of the word, noise and what that may chance to be taken off, in the pixels
    /// within `radius_px` of `centre` that are not clipped; planes in which somebody walks past don't count. Zero where
    /// it was not asked for.
    [[nodiscard]] double strayShare(const Vector2d& centre, double radius_px) const;

  private:
    /// Columns of sums_.
    enum Column : std::uint8_t {
        kValue,     ///< the amplitude
        kVariance,  ///< of it, per variance of a pixel
        kNoise,     ///< of the calm planes, per variance of a pixel; this and the following only where it is doubtful
        kExplained  ///< from here on one per column of space_
    };

    /// The window's light above its surroundings: a row per pixel, row by row of the picture, and a column per plane.
    [[nodiscard]] Eigen::MatrixXf lightIn(std::span<const FramePlane* const> planes);
    /// What a pixel's light counts in each of the sums: a row per plane.
    [[nodiscard]] Eigen::MatrixXf factorsOf(std::span<const FramePlane* const> planes) const;
    /// @param values  of the window's pixels in the plane
    void noteClipped(const FramePlane& plane, const Eigen::Ref<const Eigen::ArrayXf>& values);
    [[nodiscard]] bool isCalm(std::size_t plane) const { return filter_.doubtful && calm_[plane] != 0; }

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
    float squaredWeights_ = 0;
    float varianceOffset_ = 0;
    float noiseOffset_ = 0;
    // … and a row of them per pixel.
    Eigen::MatrixXf sums_;
    // Only where it is doubtful: the squares of its light in calm planes, and in how many planes with the module
    // lit it is clipped, and in how many others.
    Eigen::ArrayXf squares_;
    Eigen::ArrayXf clippedLit_;
    Eigen::ArrayXf clippedDark_;
};

}  // namespace skincal
