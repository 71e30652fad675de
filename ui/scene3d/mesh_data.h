#pragma once

#include <vtkSmartPointer.h>

#include "core/mesh/triangle_mesh.h"

class vtkPolyData;

namespace skincal {

/// A mesh for drawing, in another frame: p_s = T_s_mesh * p. Round surfaces are shaded round, edges of more than 30
/// degrees stay edges.
[[nodiscard]] vtkSmartPointer<vtkPolyData> toPolyData(const TriangleMesh& mesh, const Isometry3d& T_s_mesh);

}  // namespace skincal
