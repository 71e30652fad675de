#pragma once

#include <tl/expected.hpp>

#include "core/estimation/body_adjustment.h"
#include "core/estimation/body_model.h"
#include "core/estimation/candidate_selection.h"
#include "core/estimation/gravity_alignment.h"
#include "core/estimation/measurements.h"
#include "core/estimation/patch_pose.h"
#include "core/estimation/pose_graph.h"
#include "core/estimation/skin_layout.h"
#include "core/geometry/run_context.h"

namespace skincal {

struct SturdyMethodOptions {
    LayoutOptions layout;
    PatchPoseOptions pose;
    GravityAlignmentOptions gravity;
    SelectionOptions selection;
    PoseAveragingOptions averaging;
    AdjustmentOptions adjustment;
    /// Detections farther from the result than this many sigmas are rejected.
    double rejectionSigmas = 5.0;
    int maxRelinkings = 2;  ///< rounds after the first, for links that the solution shows to be misjudged
    double gravityRotationSigma = 0.5 * kDegree;  ///< of a patch's rotation from gravity alone

    [[nodiscard]] bool validate() const;
};

/// The paper's pipeline without its weaknesses (METHOD.md, sections 3 and 4):
///   1. patch shapes by least squares over gravity and link points, accelerometers calibrated on the way
///   2. every pose that explains a patch in a view (two for a flat one), decided by gravity and by the other views
///   3. body from a spanning tree over all views by quality, loops closed by rotation and translation averaging
///   4. views and patches that the tree could not reach are attached through the whole body: views by all placed
///      LEDs together, patches with few LEDs by triangulation with the rotation that gravity gives them
///   5. robust adjustment of modules and views over pixels, gravity and links, from a coarse pixel scale to a fine
///      one; detections that disagree are rejected and named
///   6. links whose ports came out far apart are cables after all, those that met neighbours: solved again with them
/// Fails with Cancelled. Where nothing can be placed the body says so, with what is missing.
[[nodiscard]] tl::expected<BodyModel, CalibrationError> calibrateSturdy(const Measurements& measurements,
                                                                        const SturdyMethodOptions& options = {},
                                                                        const RunContext& context = {});

}  // namespace skincal
