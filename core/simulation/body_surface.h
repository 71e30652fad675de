#pragma once

#include "core/mesh/triangle_mesh.h"
#include "core/simulation/world.h"

namespace skincal {

/// The true surface of a world's body, body frame, m: the tubes that pictures show under the skin, and the plane,
/// relief or sole that other patches were laid on, as far as they reach. Boards lie on it but for mechanical play and
/// what closing the gaps between them shifted; on tubes 5 % of the radius above it. What moved since (see WorldFaults)
/// has left it.
[[nodiscard]] TriangleMesh bodySurface(const World& world);

}  // namespace skincal
