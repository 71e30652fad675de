#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/simulation/room_light.h"
#include "core/simulation/scene.h"
#include "core/simulation/world.h"

namespace skincal {

/// Where an LED shows in a picture, and how bright.
struct LedSpot {
    Vector2d pixel = Vector2d::Zero();
    double peak = 0;  ///< grey levels; 0 where it can't be seen
};

/// Adds an LED's light to a picture of light (CV_32F): a Gaussian with a halo, each collected over the area of a pixel.
void drawLed(cv::Mat& light, const LedSpot& spot, const RenderOptions& options);

/// Something that is held between the camera and everything else. Both CV_32F and equally large.
struct HeldLayer {
    cv::Mat light;     ///< grey levels that it adds: its own times how much of a pixel it covers
    cv::Mat cover;     ///< share of the pixel that it hides, 0 to 1
    cv::Point corner;  ///< pixel of the picture where its top-left pixel lies; all of it is within the picture
};

/// The simulated webcam in one place: LEDs with their lobe, through lens, blur, noise and clipping, on the skin before
/// a room, with the scenario's disturbances. The picture of a frame depends on world, pose and number of the view, lit
/// set, frame number and exposure alone, not on what was drawn before. The world must outlive it.
class FrameRenderer {
  public:
    /// @param frames  how many the scan will have: disturbances run their course over them.
    FrameRenderer(const World& world, std::size_t view, std::size_t frames);

    /// A camera that stands anywhere.
    /// @param T_r_v  its pose in the body
    /// @param view   any number: decides by chance how the room is furnished and what stands in the way
    FrameRenderer(const World& world, const Isometry3d& T_r_v, std::size_t view, std::size_t frames);

    /// From now on as one that was made for this pose, in less time: the room stays.
    void moveCamera(const Isometry3d& T_r_v);

    /// 8-bit grey, or BGR where any LED is lit in a colour or `colour` asks for it.
    /// @param exposure  relative to the one that RenderOptions' levels are for: light grows with it, and clips.
    /// @param held      hides what is behind it, lit LEDs included; empty for nothing
    [[nodiscard]] cv::Mat render(const std::vector<LitModule>& lit, std::size_t frame, bool colour = false,
                                 double exposure = 1, const HeldLayer& held = {}) const;

    /// Of each module, before any knock.
    [[nodiscard]] const std::vector<LedSpot>& spots() const { return spots_; }
    /// The same of their images in the mirror; empty without one.
    [[nodiscard]] const std::vector<LedSpot>& images() const { return images_; }

  private:
    [[nodiscard]] std::vector<LedSpot> spotsAt(const Isometry3d& T_r_v) const;
    [[nodiscard]] std::vector<LedSpot> imagesAt(const Isometry3d& T_r_v) const;
    void drawLit(cv::Mat& light, const std::vector<LitModule>& lit, std::size_t frame, int channel) const;
    [[nodiscard]] bool bumped(std::size_t frame) const;
    void passBy(cv::Mat& light, std::size_t frame) const;
    [[nodiscard]] cv::Mat expose(const cv::Mat& light, std::uint64_t noiseSeed) const;

    const World& world_;
    Isometry3d T_r_v_;  ///< before any knock
    std::size_t view_;
    std::size_t frames_;
    int margin_;  ///< that scenes are wider than pictures
    ScenePainter painter_;
    cv::Mat background_;                ///< CV_32F
    std::vector<LedSpot> spots_;        ///< per module
    std::vector<LedSpot> images_;       ///< of these in the mirror; empty without one
    cv::Mat bumpedBackground_;          ///< after the camera was knocked; empty in views where it is not
    std::vector<LedSpot> bumpedSpots_;  ///< the same
    std::vector<LedSpot> bumpedImages_;
    RoomLight roomLight_;
    cv::Mat roomShare_;         ///< CV_32F: where the room shows between the body's parts
    Person person_;             ///< empty without one
    std::vector<float> noise_;  ///< standard normal numbers, read from random places
    std::unordered_map<ModuleId, std::size_t> index_;
};

/// How a knock of DisturbanceOptions::bump_px turns the camera about its own centre.
///   T_r_b = T_r_v * (R_v_b, 0)
[[nodiscard]] Matrix3d bumpOf(const Scenario& scenario);

/// Whose light a picture shows some of: it fades towards the side but does not end at an angle, as a rule of visibility
/// does, and reaches over the border.
[[nodiscard]] Visibility visibilityOfLight();

/// Light of a point source turned by `angle` from its axis, relative to its front: cos^n with half of it at half the
/// lobe's full angle.
[[nodiscard]] double ledLobe(double angle, double fullAngle);

}  // namespace skincal
