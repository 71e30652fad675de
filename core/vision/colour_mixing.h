#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <tl/expected.hpp>

#include "core/vision/frame.h"

namespace skincal {

/// How red, green and blue LEDs look to the channels of a camera: LEDs differ in brightness from colour to colour,
/// white balance makes them differ more, and every channel sees some of its neighbours' colours.
///   p - p_dark = M c,   p a pixel, c in {0,1}^3 times the LED's light, both blue, green, red
/// Scans in colours (scanOf) begin with one picture of all LEDs in each of the three, which tell M; off the dark
/// picture and by its inverse every other picture becomes one in which a channel is a colour, and hues are as far apart
/// as they can be. A channel that is clipped stays so; of the others as much is taken off as is known of it.
class ColourMixing {
  public:
    /// From the pictures of a look in which the same modules shine all in red, all in green and all in blue, and the
    /// backgrounds nearest to them. Nothing where there are none, where too little light is in them or colours can't be
    /// told apart; the error is the loader's.
    [[nodiscard]] static tl::expected<std::optional<ColourMixing>, std::string> measured(
        std::span<const FrameInfo> frames, const FrameLoader& load);

    /// 8-bit BGR to 8-bit BGR; dark ground becomes kGround. Pictures of another size or type are returned as they are.
    [[nodiscard]] cv::Mat unmixed(const cv::Mat& picture) const;
    /// M, a column per colour, blue, green, red, up to a factor: what is not clipped must not become so.
    [[nodiscard]] const Eigen::Matrix3d& matrix() const { return M_; }

    static constexpr double kGround = 32;  ///< grey levels: the room may grow darker

  private:
    ColourMixing(Eigen::Matrix3d M, cv::Mat dark) : M_(std::move(M)), dark_(std::move(dark)) {}

    Eigen::Matrix3d M_;
    cv::Mat dark_;
};

}  // namespace skincal
