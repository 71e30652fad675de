#pragma once

#include <opencv2/core/mat.hpp>

#include "core/simulation/world.h"

namespace skincal {

/// What the light of the room, and the camera's own exposure, do while a view is scanned: the lamp, the sun, the screen
/// and the exposure of DisturbanceOptions. Depends on world, view and frame alone.
class RoomLight {
  public:
    /// @param frames  how many the scan will have
    RoomLight(const World& world, std::size_t view, std::size_t frames);

    /// Changes a picture without LEDs (CV_32F).
    /// @param roomShare  where the room shows, and with it a screen; same size
    void shine(cv::Mat& light, const cv::Mat& roomShare, std::size_t frame) const;
    /// Of the camera, relative to what it begins with.
    [[nodiscard]] double exposure(std::size_t frame) const;

  private:
    [[nodiscard]] double sun(std::size_t frame) const;
    void showScreen(cv::Mat& light, const cv::Mat& roomShare, std::size_t frame) const;

    DisturbanceOptions options_;
    std::uint64_t seed_;
    std::size_t frames_;
    cv::Mat lamp_;             ///< share of its light that reaches each pixel; empty without one
    cv::Rect screen_;          ///< empty without one
    std::size_t darker_ = 0;   ///< frames in which the exposure steps down …
    std::size_t lighter_ = 0;  ///< … and up
};

}  // namespace skincal
