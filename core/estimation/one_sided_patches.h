#pragma once

#include <vector>

#include "core/estimation/body_solution.h"

namespace skincal {

/// Patches whose views all look from the same side.
struct OneSidedPatches {
    std::vector<PatchId> patches;
    double widestAngle = 0;  ///< rad, between two views of one of them; 0 where each is in one view only
    Sentence text;           ///< what that means and what to do; empty where there are none
};

/// The directions from a patch's origin to the cameras that show it, three of its LEDs at least, differ by less than
/// `viewAngle`: how far it is from them rests on its own size, and nothing contradicts a wrong focal length. Patches
/// that are not placed, or in no such view, are not among them.
/// @param used       the detections that count.
/// @param state      body frame.
/// @param viewAngle  rad.
[[nodiscard]] OneSidedPatches oneSidedPatches(const SkinLayout& layout, const std::vector<PixelObservation>& used,
                                              const BodyState& state, double viewAngle);

}  // namespace skincal
