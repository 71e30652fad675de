#pragma once

#include <array>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "core/geometry/random.h"
#include "core/geometry/se3.h"
#include "core/vision/frame.h"

namespace skincal::testing {

struct PaintedLed {
    ModuleId module;
    Vector2d pixel = Vector2d::Zero();
    double peak = 150;  ///< grey levels; 0 where it is covered
};

/// A scan of point lights painted without any code of the program. Frame k looks the same however often it is asked
/// for, so that decoders may pass over a scan several times.
struct ScanPainter {
    std::uint64_t seed = 1;
    cv::Size size{320, 240};
    std::vector<PaintedLed> leds;
    std::vector<PaintedLed> mirrored{};  ///< reflections: they blink as `module` does
    std::vector<FrameInfo> frames;
    double width_px = 1.1;
    double halo = 0.03;
    double readNoise = 1.4;
    double shotGain = 0.01;  ///< variance per grey level
    bool colour = false;
    /// What channels see of colours, both blue, green, red.
    Eigen::Matrix3d mixing = Eigen::Matrix3d::Identity();
    /// Adds light of its own to frame k (CV_32F, one channel).
    std::function<void(cv::Mat& light, std::size_t k)> disturb{};

    [[nodiscard]] cv::Mat paint(std::size_t k) const;
    [[nodiscard]] FrameLoader loader() const;
    [[nodiscard]] std::vector<ModuleId> modules() const;
};

/// Adds a round Gaussian spot to a picture of light (CV_32F).
void addSpot(cv::Mat& light, const Vector2d& at, double peak, double width_px);

/// `count` LEDs at random places at least `apart` pixels from each other and `margin` from the border.
[[nodiscard]] std::vector<PaintedLed> scatterLeds(Random& random, std::size_t count, cv::Size size, double apart = 16,
                                                  double margin = 12);

/// A background before, between and after frames with one LED each, `repeats` frames of each LED in a row.
[[nodiscard]] std::vector<FrameInfo> oneAtATime(const std::vector<PaintedLed>& leds, int repeats = 1);

/// Background, everything, then the bits of a random number per module and their complements.
[[nodiscard]] std::vector<FrameInfo> coded(const std::vector<PaintedLed>& leds, Random& random);

}  // namespace skincal::testing
