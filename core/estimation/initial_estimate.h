#pragma once

#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "core/adjustment/body_adjustment.h"
#include "core/adjustment/measurements.h"
#include "core/estimation/body_attachment.h"
#include "core/estimation/candidate_selection.h"
#include "core/estimation/gravity_alignment.h"
#include "core/estimation/missing_data.h"
#include "core/estimation/patch_pose.h"
#include "core/estimation/patch_shape.h"
#include "core/estimation/patch_sightings.h"
#include "core/estimation/pose_graph.h"
#include "core/estimation/skin_layout.h"
#include "core/estimation/spot_verdict.h"
#include "core/estimation/view_alternatives.h"
#include "core/geometry/run_context.h"

namespace skincal {

struct InitialEstimateOptions {
    LayoutOptions layout;
    PatchPoseOptions pose;
    GravityAlignmentOptions gravity;
    SelectionOptions selection;
    PoseAveragingOptions averaging;
    AdjustmentOptions shapes = roughly();         ///< of the fit that gives patches their shapes
    double gravityRotationSigma = 0.5 * kDegree;  ///< of a patch's rotation from gravity alone

    [[nodiscard]] bool validate() const;

  private:
    /// The body's own adjustment follows.
    static AdjustmentOptions roughly() {
        AdjustmentOptions options;
        options.tolerance = 1e-6;
        return options;
    }
};

/// Where everything lies before the whole body is adjusted, and what is still open.
struct InitialEstimate {
    const Measurements* measurements = nullptr;
    SkinLayout layout;
    AdjustmentInput input;
    PatchShapesResult shapes;
    std::vector<PatchEvidence> evidence;  ///< per patch
    GravityFrame gravityFrame;
    GrowingBody body;
    std::vector<ViewAlternative> alternatives;  ///< other places of views that nothing decided yet
    std::vector<SpotVerdict> spotsByShape;      ///< taken, all of `input`'s pixels (chooseSpotsByShape)

    /// Modules of placed patches and views in one frame.
    [[nodiscard]] BodyState state() const;
};

/// Attaches the views and patches that the body so far can reach, until nothing changes: views by all placed LEDs
/// together, patches by triangulation with the rotation that gravity gives them.
void attachRest(InitialEstimate& estimate, const std::vector<PatchSighting>& sightings,
                const InitialEstimateOptions& options);

/// The paper's pipeline without its weaknesses:
///   1. patch shapes by least squares over gravity and link points, accelerometers calibrated on the way;
///      where a view has hardly a sure LED of a patch, spots are taken that its shape explains (chooseSpotsByShape)
///   2. every pose that explains a patch in a view (two for a flat one), decided by gravity and by the other views
///   3. body from a spanning tree over all views by quality, loops closed by rotation and translation averaging
///   4. views and patches that the tree could not reach are attached through the whole body: views by all placed LEDs
///      together, patches with few LEDs by triangulation with the rotation that gravity gives them
/// @param gravity  of the same measurements; the result refers to both, they must outlive it.
/// Fails with Cancelled. Throws std::logic_error where the options are out of range.
[[nodiscard]] tl::expected<InitialEstimate, CalibrationError> estimateInitially(
    const Measurements& measurements, const GravityTable& gravity, const SolutionHistory& history,
    const InitialEstimateOptions& options = {}, const RunContext& context = {});

}  // namespace skincal
