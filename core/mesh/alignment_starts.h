#pragma once

#include <span>

#include "core/geometry/run_context.h"
#include "core/mesh/surface_samples.h"

namespace skincal {

/// Poses T_mesh_body worth refining, most promising first, when nothing is known of how a body lies in its mesh, and it
/// may cover a small part of it.
///
/// Pairs of modules far apart are looked up among pairs of surface points by what no motion changes: their distance and
/// the angles between the two normals and the line; each pair that agrees gives a pose. The poses are scored by how
/// many modules then lie near the surface and face its outside, and those that differ least are merged. The four turns
/// that bring principal axes together join in.
/// Ref: Drost et al., Model globally, match locally, CVPR 2010.
/// @param modules  body frame, m, at least 3
/// @param most     so many at most
/// Empty where cancelled, or the mesh has no area.
[[nodiscard]] std::vector<Isometry3d> alignmentStarts(std::span<const OrientedPoint> modules, const TriangleMesh& mesh,
                                                      std::size_t most, Random& random, const RunContext& context);

/// Root mean square of how far the modules lie apart in two poses, m.
[[nodiscard]] double motionBetween(std::span<const OrientedPoint> modules, const Isometry3d& a, const Isometry3d& b);

}  // namespace skincal
