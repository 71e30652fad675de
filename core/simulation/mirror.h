#pragma once

#include <optional>

#include "core/simulation/world.h"

namespace skincal {

/// The polished surface of DisturbanceOptions::reflection: flat, below the body, level with the x and the axis of the
/// camera, and as far as the body from it. It shows LEDs whether or not the camera sees them: those that face it, and
/// those that something hides from the camera alone. The world must outlive it.
class Mirror {
  public:
    /// @param T_r_v  pose of the camera; of one that is knocked, before it
    Mirror(const World& world, const Isometry3d& T_r_v);

    /// Where an LED's image shows, in a picture of the camera that it was made for or of one that has turned since.
    /// Nothing where the LED is turned away from the mirror, where a tube, a card or the occluder hides LED or image,
    /// and where the image is beyond the mirror's edge or the picture.
    [[nodiscard]] std::optional<Vector2d> pixelOf(const Isometry3d& T_r_v, std::size_t view, std::size_t module,
                                                  double maxAngle) const;
    /// The camera, as LEDs see it in the mirror.
    [[nodiscard]] const Vector3d& image() const { return image_r_; }

  private:
    [[nodiscard]] Vector3d reflected(const Vector3d& p_r) const;

    const World& world_;
    Isometry3d T_r_v_;
    double height_;  ///< m below the camera's axis
    Vector3d image_r_;
};

}  // namespace skincal
