#include "ui/scene3d/mesh_data.h"

#include <vtkCellArray.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataNormals.h>

namespace skincal {

vtkSmartPointer<vtkPolyData> toPolyData(const TriangleMesh& mesh, const Isometry3d& T_s_mesh) {
    const auto points = vtkSmartPointer<vtkPoints>::New();
    for (const Vector3d& vertex : mesh.vertices)
        points->InsertNextPoint(Vector3d(T_s_mesh * vertex).data());
    const auto cells = vtkSmartPointer<vtkCellArray>::New();
    for (const auto& corners : mesh.triangles) {
        const std::array<vtkIdType, 3> ids{corners[0], corners[1], corners[2]};
        cells->InsertNextCell(3, ids.data());
    }
    const auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetPolys(cells);
    const auto normals = vtkSmartPointer<vtkPolyDataNormals>::New();
    normals->SetInputData(data);
    normals->SetFeatureAngle(30);
    normals->ConsistencyOff();
    normals->Update();
    return normals->GetOutput();
}

}  // namespace skincal
