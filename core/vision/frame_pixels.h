#pragma once

#include <algorithm>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <tl/expected.hpp>

#include "core/geometry/sentence.h"

namespace skincal {

/// A loaded frame, checked, with access to the pixels of its planes.
class FramePixels {
  public:
    static constexpr std::uint8_t kTop = 254;  ///< from here on a pixel is clipped

    /// Fails when the picture is empty or smaller than 4 x 4 pixels, not 8-bit with 1 or 3 channels, of another size
    /// than `expected` (if that is not empty), or grey where colours were lit.
    [[nodiscard]] static tl::expected<FramePixels, Sentence> make(cv::Mat picture, const std::string& file,
                                                                  cv::Size expected, bool coloured);

    [[nodiscard]] cv::Size size() const { return picture_.size(); }
    [[nodiscard]] const cv::Mat& picture() const { return picture_; }
    /// Whether the plane is the mean of several channels.
    [[nodiscard]] bool isMean(int channel) const { return picture_.channels() > 1 && channel < 0; }
    /// The whole plane as 8-bit grey.
    [[nodiscard]] cv::Mat plane(int channel) const;
    [[nodiscard]] double value(int x, int y, int channel) const {
        const std::uint8_t* pixel = at(x, y);
        if (picture_.channels() == 1)
            return pixel[0];
        return channel >= 0 ? pixel[channel] : (pixel[0] + pixel[1] + pixel[2]) / 3.0;
    }
    /// `count` values side by side from (x, y) on.
    void values(int x, int y, int count, int channel, float* to) const {
        if (picture_.channels() == 1) {
            const std::uint8_t* pixel = at(x, y);
            for (int i = 0; i < count; ++i)
                to[i] = static_cast<float>(pixel[i]);
            return;
        }
        for (int i = 0; i < count; ++i)
            to[i] = static_cast<float>(value(x + i, y, channel));
    }
    /// True where any channel that the plane is made of sits at the end of its range.
    [[nodiscard]] bool saturated(int x, int y, int channel) const {
        const std::uint8_t* pixel = at(x, y);
        if (picture_.channels() == 1)
            return pixel[0] >= kTop;
        return channel >= 0 ? pixel[channel] >= kTop : std::max(pixel[0], std::max(pixel[1], pixel[2])) >= kTop;
    }

  private:
    explicit FramePixels(cv::Mat picture) : picture_(std::move(picture)) {}
    [[nodiscard]] const std::uint8_t* at(int x, int y) const {
        return picture_.ptr<std::uint8_t>(y) + static_cast<std::ptrdiff_t>(x) * picture_.channels();
    }

    cv::Mat picture_;
};

}  // namespace skincal
