#pragma once

#include <vector>

#include "core/adjustment/measurements.h"
#include "core/estimation/patch_sightings.h"
#include "core/geometry/run_context.h"
#include "core/vision/detection.h"

namespace skincal {

/// One of several spots of a view, taken for a module's LED.
struct ChosenSpot {
    std::size_t view = 0;
    std::size_t module = 0;
    SpotChoice spot;
    Sentence reason;
};

/// Chooses among the spots of doubtful modules (Undetected::spots) where hardly an LED of a patch is sure in a view, as
/// before a mirror that returns half of the light or more: view or patch may then have no pose by which settleSpots
/// could tell. What tells here is the patch's shape. A mirror shows it inside out: no motion brings a bent patch there,
/// and a flat one only so that its LEDs face away from the camera. A single row of LEDs, as of a ring, may well lie
/// where the mirror shows it: of that nothing is taken.
/// Of each patch the spots are taken that lie where the pose has them which explains the most LEDs, where any other
/// that explains nearly as much has them, too; at least six, and half of the patch's LEDs that show a spot. A spot with
/// another of its module near it is left to settleSpots, as are patches with fewer. Cancelled: any of them.
/// @param pixels  LEDs that are sure, or were taken before; a patch to which these give a pose is left alone in that
///                view
[[nodiscard]] std::vector<ChosenSpot> chooseSpotsByShape(const Measurements& measurements, const SkinLayout& layout,
                                                         const std::vector<PatchShape>& shapes,
                                                         const std::vector<PixelObservation>& pixels,
                                                         const PatchPoseOptions& options = {},
                                                         const RunContext& context = {});

}  // namespace skincal
