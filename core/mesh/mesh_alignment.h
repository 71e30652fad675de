#pragma once

#include <span>

#include "core/mesh/mesh_surface.h"
#include "core/mesh/surface_samples.h"

namespace skincal {

struct MeshAlignmentOptions {
    bool fitOffset = true;
    double offset = 0;  ///< m; where it is fitted, where that begins
    int iterations = 60;
    double reach = 0.1;  ///< m: modules farther from the surface than that have no say

    [[nodiscard]] bool validate() const { return iterations > 0 && reach > 0; }
};

/// A body laid against a mesh.
struct MeshAlignment {
    Isometry3d T_mesh_body = Isometry3d::Identity();
    double offset = 0;  ///< h, m
    double sigma = 0;   ///< of the deviations of those that fit: 1.4826 times the median of their absolute values, m
    std::size_t matched = 0;  ///< modules with a surface within reach that faces their way
};

/// Lays modules on a surface: minimises
///   sum_i rho(d(T_mesh_body p_i) - h)
/// over the pose and, where asked for, the offset h; d is MeshSurface::nearest's signed distance, rho is Tukey's
/// biweight, whose scale shrinks from far to what the residuals show, so that modules that sit elsewhere have no say in
/// the end. Levenberg-Marquardt; directions that nothing measures stay as they began. A weak pull towards h = 0 (10 mm
/// cost as much as 0.03 mm in every module) decides where pose and offset can't be told apart, as on a plane. Where
/// cancelled it ends as far as it has come.
[[nodiscard]] MeshAlignment alignToMesh(std::span<const OrientedPoint> modules, const MeshSurface& surface,
                                        const Isometry3d& start, const MeshAlignmentOptions& options,
                                        const RunContext& context = {});

/// How well an alignment is held.
struct AlignmentStrength {
    /// Of the six motions, root mean square change of the modules' distances per root mean square way of the modules:
    /// from 0 (slides freely) to 1, rising.
    Vector6d sensitivity = Vector6d::Zero();
    double offset = 1;  ///< the same of the offset, whatever the pose does meanwhile
};
[[nodiscard]] AlignmentStrength strengthOf(std::span<const OrientedPoint> modules, const MeshSurface& surface,
                                           const MeshAlignment& alignment, double reach);

}  // namespace skincal
