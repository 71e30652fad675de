#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/geometry/random.h"
#include "core/mesh/triangle_mesh.h"

namespace skincal {

/// A place on a surface, or a module on its board: where, and which way is out.
struct OrientedPoint {
    Vector3d position = Vector3d::Zero();
    Vector3d normal = Vector3d::UnitZ();
};

/// At most so many of them, evenly by number, in their order.
[[nodiscard]] std::vector<OrientedPoint> thinned(std::span<const OrientedPoint> points, std::size_t most);

/// Points spread evenly over the area of a mesh: at least `spacing` apart, and hardly farther than that.
/// @param count  about so many; where the area is 0 there are none.
[[nodiscard]] std::vector<OrientedPoint> sampleSurface(const TriangleMesh& mesh, std::size_t count, Random& random);

/// Points that can be asked for the nearest of them; quicker than MeshSurface, and as coarse as they are.
class SampledSurface {
  public:
    explicit SampledSurface(std::vector<OrientedPoint> points);
    ~SampledSurface();

    /// Throws std::logic_error where there are none.
    [[nodiscard]] const OrientedPoint& nearest(const Vector3d& p) const;

  private:
    struct Index;
    std::vector<OrientedPoint> points_;
    std::unique_ptr<Index> index_;
};

}  // namespace skincal
