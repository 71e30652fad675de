#pragma once

#include <span>
#include <vector>

#include "core/vision/detection.h"

namespace skincal {

/// Where a picture shows a mirror, as told by the modules of which it shows two spots, LED and reflection: a flat one
/// has all LEDs on one side of the lines half-way between the two, and all reflections on the other, where the fainter
/// ones are. Glints that lie here and there have no such sides.
/// A module that is out of the camera's sight may show in the mirror alone. Nothing in that single spot tells it from
/// an LED, but where it lies.
/// Which side is the mirror's is told by brightness alone. Where LEDs face the mirror throughout, and the camera sees
/// all of them from the side, it is taken for the other one.
class MirrorSide {
  public:
    /// Fewer than three pairs tell of no mirror.
    explicit MirrorSide(std::span<const MirroredPair> pairs);

    /// Whether a spot may be a reflection by where it lies: on the mirror's side, or anywhere where there is a mirror
    /// that makes LEDs about as bright as they are.
    [[nodiscard]] bool mayReflect(const Vector2d& pixel) const;

  private:
    /// How far, px, a pixel is on the reflection's side of the line half-way between the two.
    [[nodiscard]] static double beyond(const MirroredPair& pair, const Vector2d& pixel);
    void orient();
    [[nodiscard]] bool isFlat() const;
    [[nodiscard]] double spread_px() const;

    std::vector<MirroredPair> pairs_;  ///< none without a mirror
    bool isOriented_ = true;
    double margin_px_ = 0;  ///< the lines lie by so much farther up or down where LEDs are nearer or farther than any
                            ///< that is seen twice
};

}  // namespace skincal
