#pragma once

#include <optional>
#include <vector>

#include "core/adjustment/body_adjustment.h"
#include "core/estimation/patch_pose.h"
#include "core/estimation/patch_shape.h"
#include "core/estimation/skin_layout.h"

namespace skincal {

/// The LEDs of one patch in one view, with their places in the patch's frame.
struct PatchSighting {
    std::size_t view = 0;
    std::size_t patch = 0;
    std::vector<std::size_t> observations;  ///< positions in the flat list of detections
    std::vector<LedCorrespondence> leds;    ///< parallel to observations
};

/// Every patch in every view that shows at least one of its LEDs, by view, then patch; within one by module, so that
/// the order of detections makes no difference. Detections of modules without a pose in their patch are left out.
[[nodiscard]] std::vector<PatchSighting> collectSightings(const Skin& skin, const SkinLayout& layout,
                                                          const std::vector<PatchShape>& shapes,
                                                          const std::vector<PixelObservation>& pixels);

}  // namespace skincal
