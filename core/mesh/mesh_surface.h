#pragma once

#include <memory>
#include <optional>

#include "core/mesh/triangle_mesh.h"

namespace skincal {

/// The point of a mesh that is nearest to another.
struct SurfacePoint {
    Vector3d point = Vector3d::Zero();
    Vector3d normal =
        Vector3d::UnitZ();  ///< outwards; at an edge or a corner the mean of the triangles that meet there
    double distance = 0;    ///< positive outside
    /// Unit vector along which `distance` grows fastest: its gradient.
    Vector3d gradient = Vector3d::UnitZ();
};

/// A mesh that can be asked for its nearest point. Constant after it was made: threads may share it.
class MeshSurface {
  public:
    /// Where cancelled, it has no point near to anything.
    /// @param mesh  welded.
    explicit MeshSurface(TriangleMesh mesh, const RunContext& context = {});
    ~MeshSurface();
    MeshSurface(const MeshSurface&) = delete;
    MeshSurface& operator=(const MeshSurface&) = delete;

    [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }

    /// The nearest point among the triangles whose outside faces along `facing` (less than a right angle away), so that
    /// the far side of a thin wall is never taken for the near one. Nothing within `reach`: nothing.
    ///   distance = sign(normal . (p - q)) |p - q|
    /// The sign is right everywhere, corners included, since normals there are weighted by the angle that each triangle
    /// has in them. Ref: Baerentzen and Aanaes, Signed distance computation using the angle weighted pseudonormal,
    /// TVCG 11, 2005.
    [[nodiscard]] std::optional<SurfacePoint> nearest(const Vector3d& p, const Vector3d& facing, double reach) const;

  private:
    struct Index;

    /// Both return false where cancelled.
    bool weighFacesAndCorners(const RunContext& context);
    bool weighEdges(const RunContext& context);
    void plant(const RunContext& context);

    TriangleMesh mesh_;
    std::vector<Vector3d> faceNormals_;
    std::vector<std::array<Vector3d, 3>> edgeNormals_;  ///< per triangle, edge i from corner i to the next
    std::vector<Vector3d> vertexNormals_;
    std::unique_ptr<Index> index_;
};

}  // namespace skincal
