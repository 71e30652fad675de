#pragma once

#include <optional>
#include <vector>

#include "core/adjustment/body_adjustment.h"
#include "core/estimation/candidate_selection.h"
#include "core/estimation/patch_pose.h"
#include "core/estimation/patch_sightings.h"

namespace skincal {

/// The body while it grows: poses of views and patches, nothing where not yet known.
struct GrowingBody {
    std::vector<std::optional<Isometry3d>> T_r_v;
    std::vector<std::optional<Isometry3d>> T_r_o;
};

/// Pose of a view from all LEDs of placed patches that it shows, taken as one object (which is hardly ever flat).
/// Nothing where too few are seen, or two poses explain them equally well.
[[nodiscard]] std::optional<Isometry3d> resectView(const std::vector<PatchSighting>& sightings, std::size_t view,
                                                   const GrowingBody& body, const CameraModel& camera,
                                                   const PatchPoseOptions& options, double decisiveCostRatio);

/// Position of a patch whose rotation is known, from the rays of its LEDs in placed views:
///   min sum rho(|d x (T_r_o led - c)|),  d the ray's direction, c the camera's centre, both in the body frame.
/// Linear; needs two rays that are not parallel. Nothing where the rays miss the LEDs by more than
/// `maxResidual_px` (median) or fix no position.
[[nodiscard]] std::optional<Isometry3d> triangulatePatch(const std::vector<PatchSighting>& sightings, std::size_t patch,
                                                         const Matrix3d& R_r_o, const GrowingBody& body,
                                                         const CameraModel& camera, double maxResidual_px = 12);

}  // namespace skincal
