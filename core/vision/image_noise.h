#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace skincal {

/// Noise of one 8-bit pixel value, grey levels squared: variance(I) = read + gain * I. Quantisation is part of `read`.
struct ImageNoise {
    double read = 1.0;
    double gain = 0.0;

    [[nodiscard]] double variance(double intensity) const { return read + gain * (intensity > 0 ? intensity : 0.0); }
};

/// Gathers differences of two pictures of the same scene, less those of the neighbouring pixel (a lamp that flickers
/// changes both alike), sorted by brightness. The few pixels that truly changed (LEDs, people) do not count, unless
/// most did: then that is a lamp. The spread is read off the central 68 % of each brightness class.
class ImageNoiseEstimator {
  public:
    /// a, b: 8-bit grey of equal size, taken one after the other. Looks at one pixel in 32.
    void add(const cv::Mat& a, const cv::Mat& b);
    /// Weighted straight line through the classes; read >= 1/12 (quantisation), gain >= 0. With a single class the gain
    /// is 0, with no data at all the default noise is returned, in the dark with a webcam's gain.
    [[nodiscard]] ImageNoise estimate() const;

  private:
    static constexpr int kClasses = 16;
    static constexpr int kDifferences = 96;
    using Counts = std::array<std::uint32_t, kDifferences>;
    std::array<Counts, kClasses> still_{};    ///< of pixels that hardly changed, but for noise
    std::array<Counts, kClasses> changed_{};  ///< of the others
    std::uint64_t black_ = 0;                 ///< pixels that tell nothing
    std::uint64_t white_ = 0;                 ///< the same
};

}  // namespace skincal
