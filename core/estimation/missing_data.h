#pragma once

#include <map>
#include <vector>

#include "core/adjustment/body_adjustment.h"
#include "core/estimation/patch_shape.h"
#include "core/estimation/skin_layout.h"
#include "core/geometry/sentence.h"

namespace skincal {

/// What pictures and gravity told about one patch, to say what is missing where it could not be placed.
struct PatchEvidence {
    std::size_t mostDetected = 0;           ///< LEDs of its modules found in one view
    std::size_t mostUsable = 0;             ///< those whose place in the patch is known
    std::map<ErrorCode, int> poseFailures;  ///< why views with enough of them gave no pose
};

/// What the pictures show of each patch, without the failures.
[[nodiscard]] std::vector<PatchEvidence> patchEvidence(const SkinLayout& layout, const std::vector<PatchShape>& shapes,
                                                       const std::vector<PixelObservation>& pixels);

enum class NotPlaced {
    Unseen,          ///< in no view
    ShapeUnknown,    ///< too few of the modules seen have readings that tell how they lie
    TooSmall,        ///< the whole patch has fewer LEDs than a pose needs
    TooFewLeds,      ///< no view shows enough of it
    OnALine,         ///< what is seen of it lies on a line
    Contradicted,    ///< its shape explains its pictures nowhere
    TwoPlaces,       ///< nothing is placed, and it could be in two places in each view
    NeverWithPlaced  ///< no view shows it with a placed patch
};

/// Why a patch could not be placed.
/// @param needed       LEDs that a pose needs.
/// @param anyPlaced    false where nothing of the body could be placed.
[[nodiscard]] NotPlaced reasonNotPlaced(const Patch& patch, const PatchEvidence& evidence, int needed, bool anyPlaced);

/// What an operator has to do about a patch that could not be placed; parameters as above.
[[nodiscard]] Sentence whyNotPlaced(const Skin& skin, const Patch& patch, const PatchEvidence& evidence, int needed,
                                    bool anyPlaced);

/// The same for modules of placed patches that nothing measured holds; empty where there are none.
[[nodiscard]] Sentence whyNotHeld(const Skin& skin, const std::vector<std::size_t>& modules);

}  // namespace skincal
