#pragma once

#include <optional>
#include <vector>

#include "core/geometry/se3.h"

namespace skincal {

struct GravityFrame {
    std::vector<std::optional<Matrix3d>> R_g_o;  ///< per patch
    double disagreement_rad = 0;                 ///< rms over patches and poses
};

struct GravityAlignmentOptions {
    double maxDisagreement_rad = 3 * kDegree;  ///< rms over the poses, of a patch that moved with the others
    std::size_t maxReferences = 20;            ///< patches tried as the one that the others are compared with

    [[nodiscard]] bool validate() const { return maxDisagreement_rad > 0 && maxReferences > 0; }
};

/// A common frame for all patches from what gravity looked like to each in the same poses:
///   R_g_o up_o[k][p] = up_g[p]  for the largest set of patches k that agree
/// The frame is that of one of them. Patches whose directions can't be turned into the others' have none: the body's
/// joints moved between poses, or the poses are too alike. Nobody has one where no two poses differ.
/// @param up_o  [patch][pose], unit vectors in the patch's frame; nothing where the patch was not measured.
/// Throws std::logic_error where the options are out of range.
[[nodiscard]] GravityFrame alignPatchesByGravity(const std::vector<std::vector<std::optional<Vector3d>>>& up_o,
                                                 const GravityAlignmentOptions& options = {});

}  // namespace skincal
