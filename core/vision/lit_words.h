#pragma once

#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "core/vision/frame.h"

namespace skincal {

/// One grey picture out of a frame: the frame itself (channel -1: mean of its channels), or one channel (0 blue,
/// 1 green, 2 red) where LEDs were lit in colours.
struct Plane {
    std::size_t frame = 0;
    int channel = -1;
};

/// When each module was lit, over the planes of a view.
struct LitWords {
    std::vector<Plane> planes;                  ///< in the order of the frames
    std::vector<std::vector<std::size_t>> lit;  ///< per module, the planes in which it shines, ascending
    bool coloured = false;                      ///< three planes per frame

    [[nodiscard]] std::size_t planesPerFrame() const { return coloured ? 3 : 1; }
};

/// The words of `modules` over `frames`. Colours are told apart as soon as any module is lit in a colour other than
/// white. Fails with a sentence when a frame lights a module that is not among `modules`, or lights one twice, or a
/// colour is not made of zeros and ones.
[[nodiscard]] tl::expected<LitWords, std::string> litWords(std::span<const ModuleId> modules,
                                                           std::span<const FrameInfo> frames);

/// A loaded frame, checked, with access to the pixels of its planes.
class FramePixels {
  public:
    /// Fails when the picture is empty, not 8-bit with 1 or 3 channels, of another size than `expected` (if that is not
    /// empty), or grey where colours were lit.
    [[nodiscard]] static tl::expected<FramePixels, std::string> make(cv::Mat picture, const std::string& file,
                                                                     cv::Size expected, bool coloured);

    [[nodiscard]] cv::Size size() const { return picture_.size(); }
    [[nodiscard]] const cv::Mat& picture() const { return picture_; }
    /// The whole plane as 8-bit grey.
    [[nodiscard]] cv::Mat plane(int channel) const;
    [[nodiscard]] double value(int x, int y, int channel) const {
        const std::uint8_t* pixel = picture_.ptr<std::uint8_t>(y) + x * picture_.channels();
        if (picture_.channels() == 1)
            return pixel[0];
        return channel >= 0 ? pixel[channel] : (pixel[0] + pixel[1] + pixel[2]) / 3.0;
    }
    /// True where any channel that the plane is made of sits at the end of its range.
    [[nodiscard]] bool saturated(int x, int y, int channel) const {
        constexpr int kTop = 254;
        const std::uint8_t* pixel = picture_.ptr<std::uint8_t>(y) + x * picture_.channels();
        if (picture_.channels() == 1)
            return pixel[0] >= kTop;
        return channel >= 0 ? pixel[channel] >= kTop : std::max(pixel[0], std::max(pixel[1], pixel[2])) >= kTop;
    }

  private:
    explicit FramePixels(cv::Mat picture) : picture_(std::move(picture)) {}
    cv::Mat picture_;
};

}  // namespace skincal
