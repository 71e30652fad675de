#pragma once

#include <tl/expected.hpp>

#include "core/adjustment/measurements.h"
#include "core/estimation/body_model.h"
#include "core/estimation/patch_pose.h"
#include "core/estimation/skin_layout.h"
#include "core/geometry/run_context.h"

namespace skincal {

struct PaperMethodOptions {
    LayoutOptions layout;
    RelativeRotationOptions rotation;  ///< eq. 7-8
    PaperPoseOptions pose;             ///< eq. 14

    [[nodiscard]] bool validate() const { return layout.validate() && rotation.validate() && pose.validate(); }
};

/// The method of Mittendorfer, Dean and Cheng (IROS 2014) to the letter, the baseline that ours is measured against:
///   edge rotations by Procrustes (eq. 7-8), propagation along shortest paths from each origin (eq. 2-5), LED points
///   (eq. 9), EPnP with RANSAC per patch and view (eq. 14), r_T_v1 = I (eq. 15), and a new patch n attached through a
///   known patch m of the same view: r_T_on = r_T_om (v_T_om)^-1 v_T_on (eq. 16).
/// Views are taken in the order of the recording, again and again until none attaches anything new; the paper leaves
/// open which of several known patches to go through: here the one with the most inliers.
/// Fails with Cancelled. Where nothing can be placed the body says so, with what is missing.
[[nodiscard]] tl::expected<BodyModel, CalibrationError> calibratePaper(const Measurements& measurements,
                                                                       const PaperMethodOptions& options = {},
                                                                       const RunContext& context = {});

}  // namespace skincal
