#pragma once

#include <optional>
#include <vector>

#include "core/estimation/patch_pose.h"

namespace skincal {

/// A patch in a view with the poses that explain its picture, best first.
struct SightingCandidates {
    std::size_t view = 0;
    std::size_t patch = 0;
    std::vector<PatchPose> poses;
};

struct SelectionOptions {
    /// Candidates whose rotation differs from the rest of the data by more than this are not believed: flips differ by
    /// tens of degrees, good ones by a few.
    double maxDisagreement_rad = 15 * kDegree;
    /// Without any other evidence the best candidate must explain the picture better than the second by this.
    double decisiveCostRatio = 1.5;

    [[nodiscard]] bool validate() const { return maxDisagreement_rad > 0 && decisiveCostRatio >= 1; }
};

struct Selection {
    std::optional<std::size_t> candidate;  ///< which of the poses, or none that fits the rest
    bool undecided = false;                ///< two candidates remain and nothing tells them apart
    /// Other candidates that nothing but the picture itself speaks against.
    std::vector<std::size_t> rivals{};
};

/// Decides between the candidates of every sighting by what else is known.
/// With gravity: R_g_o of each patch (rotation into a frame that gravity gives) makes every candidate a statement
/// about the view's own rotation, R_v_g = R_v_o R_g_o^T; all patches of a view must make the same one.
/// Without: the relative rotation of two patches must be the same in all views that show both.
/// @param R_g_o  per patch, nothing where gravity can't tell.
[[nodiscard]] std::vector<Selection> selectCandidates(const std::vector<SightingCandidates>& sightings,
                                                      const std::vector<std::optional<Matrix3d>>& R_g_o,
                                                      const SelectionOptions& options = {});

}  // namespace skincal
