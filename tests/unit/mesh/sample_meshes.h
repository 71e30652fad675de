#pragma once

#include "core/geometry/random.h"
#include "core/mesh/mesh_comparison.h"
#include "core/mesh/surface_samples.h"

namespace skincal::test {

/// An egg with bumps, some 0.3 m long, no two sides alike; finely divided.
[[nodiscard]] TriangleMesh bumpyBody(Random& random);

[[nodiscard]] Isometry3d randomPose(Random& random, double shift);

/// Modules on a surface, `offset` above it, in the frame of the mesh, turned at random about their normals; the facets'
/// corners are rounded off by less than a tenth of a millimetre.
/// @param isCovered  where modules may be
[[nodiscard]] std::vector<PlacedModule> modulesOn(const TriangleMesh& mesh, std::size_t count, double offset,
                                                  Random& random,
                                                  const std::function<bool(const Vector3d&)>& isCovered = {});

/// The same in another frame: T_b_module = T_b_a * T_a_module.
[[nodiscard]] std::vector<PlacedModule> movedBy(const Isometry3d& T_b_a, std::vector<PlacedModule> modules);

[[nodiscard]] bool hasDoubt(const MeshComparison& comparison, AlignmentDoubt::Kind kind);

}  // namespace skincal::test
