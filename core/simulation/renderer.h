#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/simulation/scene.h"
#include "core/simulation/world.h"

namespace skincal {

/// The simulated webcam at one view: LEDs with their lobe, through lens, blur, noise and clipping, on the skin before
/// a room, with the scenario's disturbances. The picture of a frame depends on world, view, lit set and frame
/// number alone, not on what was drawn before.
class FrameRenderer {
  public:
    /// @param frames  how many the scan will have: disturbances run their course over them.
    FrameRenderer(const World& world, std::size_t view, std::size_t frames);

    /// 8-bit grey, or BGR where any LED is lit in a colour or `colour` asks for it.
    [[nodiscard]] cv::Mat render(const std::vector<LitModule>& lit, std::size_t frame, bool colour = false) const;

  private:
    struct Spot {
        Vector2d pixel = Vector2d::Zero();
        double peak = 0;  ///< grey levels
    };

    [[nodiscard]] std::vector<Spot> spotsAt(const Isometry3d& T_r_v) const;
    [[nodiscard]] bool bumped(std::size_t frame) const;
    void drawSpot(cv::Mat& light, const Spot& spot) const;
    void passBy(cv::Mat& light, std::size_t frame) const;
    [[nodiscard]] cv::Mat expose(const cv::Mat& light, std::uint64_t noiseSeed) const;

    const World& world_;
    std::size_t view_;
    std::size_t frames_;
    cv::Mat background_;             ///< CV_32F
    std::vector<Spot> spots_;        ///< per module; no peak where it can't be seen
    cv::Mat bumpedBackground_;       ///< after the camera was knocked; empty in views where it is not
    std::vector<Spot> bumpedSpots_;  ///< the same
    cv::Mat lamp_;                   ///< of a flickering lamp; empty without one
    Person person_;                  ///< empty without one
    std::vector<float> noise_;       ///< standard normal numbers, read from random places
    std::unordered_map<ModuleId, std::size_t> index_;
};

/// Light of a point source turned by `angle` from its axis, relative to its front: cos^n with half of it at half the
/// lobe's full angle.
[[nodiscard]] double ledLobe(double angle, double fullAngle);

}  // namespace skincal
