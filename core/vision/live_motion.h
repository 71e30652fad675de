#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

namespace skincal {

/// Whether the camera moves while a coded scan is under way, for who may want to break it off: every picture against
/// the one with all LEDs lit, which shows all that any other shows, by normalised correlation of edges and spots at
/// reduced size, over a fifth of the picture to every side. One picture may err; two in a row that agree do not. What
/// counts is decided by decodeView from all pictures together.
class LiveMotion {
  public:
    /// The next picture, 8-bit BGR or grey, in the order of the lit sets of codedScan(). One of another size than the
    /// ones before is ignored.
    void add(const cv::Mat& picture);
    /// The farthest that it was away; empty while it stands.
    [[nodiscard]] std::optional<double> moved_px() const { return moved_px_; }

  private:
    cv::Mat reference_;  ///< small, 32-bit grey, edges and spots alone
    cv::Size size_{};    ///< of a picture
    std::optional<cv::Point2d> last_;
    std::optional<double> moved_px_;
    std::size_t pictures_ = 0;
};

}  // namespace skincal
