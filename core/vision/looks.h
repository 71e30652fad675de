#pragma once

#include <span>
#include <vector>

#include "core/vision/detection.h"
#include "core/vision/frame.h"

namespace skincal {

/// Where the looks of a view begin: what a first scan of all modules leaves undecided is looked for again, by a scan of
/// its own (FurtherLooks), whose pictures follow those of the first. The first of the result is 0.
[[nodiscard]] std::vector<std::size_t> beginningsOfLooks(std::span<const FrameInfo> frames);

[[nodiscard]] std::vector<ModuleId> modulesLitIn(std::span<const FrameInfo> look);

struct LookOptions {
    double maxMotion_px = 1;  ///< of the camera between two looks; beyond it the later one counts for nothing
    double sameSpot_px = 2;   ///< two LEDs can't be nearer than this

    [[nodiscard]] bool validate() const { return maxMotion_px > 0 && sameSpot_px > 0; }
};

/// Whether it has spots to choose from.
[[nodiscard]] bool hasChoices(const ViewDetections& view);

/// Adds what a further look found, in the pixels of the first: modules that both found tell how the camera moved in
/// between (their median), which is taken off where it is more than they may be off, and by half part of the new
/// standard deviations. What was found before stays. A module that shines where another was found is ambiguous. Modules
/// that it does not find either keep their reason, unless the further look has spots to choose from, or a reason where
/// the earlier had none. Where nothing was found before, the further look
/// takes the place of the earlier ones, unless those left spots to choose from: nothing tells whether the camera still
/// stands where it saw them.
/// @param further  of some of the view's modules
/// @return whether it counts. It does not, and changes nothing but `moved_px`, where the camera moved by more than
///         maxMotion_px, in it or since, and where none of the modules found before was found again.
bool addLook(ViewDetections& view, const ViewDetections& further, const LookOptions& options = {});

/// Puts what is found, and what is not, into the order of the modules.
void sortAs(std::span<const ModuleId> modules, ViewDetections& view);

}  // namespace skincal
