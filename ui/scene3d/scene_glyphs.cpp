#include "ui/scene3d/scene_glyphs.h"

#include <vtkAppendPolyData.h>
#include <vtkArrowSource.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkMatrix4x4.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTransform.h>
#include <vtkTransformPolyDataFilter.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "ui/scene3d/body_values.h"

namespace skincal {
namespace {

constexpr int kAround = 16;
constexpr int kRings = 9;             // between the poles
constexpr double kThinnest = 0.8e-3;  // of half an axis, m

/// A sphere of unit radius mapped by `A`, with its normals.
void appendEllipsoid(const Vector3d& centre, const Matrix3d& A, const Matrix3d& normalMap, vtkPoints& points,
                     vtkFloatArray& normals, vtkCellArray& cells) {
    const vtkIdType first = points.GetNumberOfPoints();
    const auto add = [&](const Vector3d& u) {
        const Vector3d p = centre + A * u;
        const Vector3d n = (normalMap * u).normalized();
        points.InsertNextPoint(p.data());
        normals.InsertNextTuple3(n.x(), n.y(), n.z());
    };
    add(Vector3d::UnitZ());
    for (int ring = 1; ring <= kRings; ++ring) {
        const double latitude = 180 * kDegree * ring / (kRings + 1);
        for (int k = 0; k < kAround; ++k) {
            const double longitude = 360 * kDegree * k / kAround;
            add(Vector3d(std::sin(latitude) * std::cos(longitude), std::sin(latitude) * std::sin(longitude),
                         std::cos(latitude)));
        }
    }
    add(-Vector3d::UnitZ());
    const auto at = [&](int ring, int k) { return first + 1 + (ring - 1) * kAround + k % kAround; };
    const vtkIdType last = points.GetNumberOfPoints() - 1;
    for (int k = 0; k < kAround; ++k) {
        const vtkIdType top[] = {first, at(1, k), at(1, k + 1)};
        const vtkIdType bottom[] = {last, at(kRings, k + 1), at(kRings, k)};
        cells.InsertNextCell(3, top);
        cells.InsertNextCell(3, bottom);
        for (int ring = 1; ring < kRings; ++ring) {
            const vtkIdType quad[] = {at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), at(ring, k + 1)};
            cells.InsertNextCell(4, quad);
        }
    }
}

}  // namespace

vtkSmartPointer<vtkPolyData> ellipsoidsOf(const BodyModel& body, double scale, std::size_t limit) {
    std::vector<std::pair<double, const BodyModule*>> chosen;
    for (const BodyModule& module : body.modules) {
        if (const auto sigma = worstSigma_mm(module); sigma && module.T_body_module)
            chosen.emplace_back(*sigma, &module);
    }
    std::stable_sort(chosen.begin(), chosen.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    chosen.resize(std::min(limit, chosen.size()));

    auto points = vtkSmartPointer<vtkPoints>::New();
    auto normals = vtkSmartPointer<vtkFloatArray>::New();
    normals->SetNumberOfComponents(3);
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    for (const auto& [sigma, module] : chosen) {
        const Matrix3d covariance = module->covariance->bottomRightCorner<3, 3>();
        const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(covariance);
        const Vector3d half = (3 * scale * axes.eigenvalues().cwiseMax(0).cwiseSqrt()).cwiseMax(kThinnest);
        // Eigenvectors may form a mirror, which would turn the surface inside out.
        Matrix3d V = axes.eigenvectors();
        V.col(0) *= V.determinant();
        appendEllipsoid(module->T_body_module->translation(), V * half.asDiagonal(),
                        V * half.cwiseInverse().asDiagonal(), *points, *normals, *cells);
    }
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetPolys(cells);
    data->GetPointData()->SetNormals(normals);
    return data;
}

vtkSmartPointer<vtkPolyData> pyramidOf(const Isometry3d& T_s_v, double size) {
    auto points = vtkSmartPointer<vtkPoints>::New();
    for (const Vector3d& corner : {Vector3d(0, 0, 0), Vector3d(-0.8, -0.45, 1), Vector3d(0.8, -0.45, 1),
                                   Vector3d(0.8, 0.45, 1), Vector3d(-0.8, 0.45, 1)}) {
        const Vector3d p = T_s_v * Vector3d(size * corner);
        points->InsertNextPoint(p.data());
    }
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    for (vtkIdType k = 0; k < 4; ++k) {
        const vtkIdType side[] = {0, 1 + (k + 1) % 4, 1 + k};
        cells->InsertNextCell(3, side);
    }
    const vtkIdType base[] = {1, 2, 3, 4};
    cells->InsertNextCell(4, base);
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetPolys(cells);
    return data;
}

vtkSmartPointer<vtkPolyData> arrowOf(const Vector3d& from, const Vector3d& direction, double length) {
    auto source = vtkSmartPointer<vtkArrowSource>::New();
    source->SetTipResolution(24);
    source->SetShaftResolution(20);
    source->SetTipLength(0.3);
    source->SetTipRadius(0.09);
    source->SetShaftRadius(0.032);
    const Matrix3d R = Quaterniond::FromTwoVectors(Vector3d::UnitX(), direction).toRotationMatrix();
    auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
            matrix->SetElement(i, j, length * R(i, j));
        matrix->SetElement(i, 3, from[i]);
    }
    auto transform = vtkSmartPointer<vtkTransform>::New();
    transform->SetMatrix(matrix);
    auto filter = vtkSmartPointer<vtkTransformPolyDataFilter>::New();
    filter->SetTransform(transform);
    filter->SetInputConnection(source->GetOutputPort());
    filter->Update();
    return filter->GetOutput();
}

vtkSmartPointer<vtkPolyData> contactArrows(std::span<const ContactMark> contacts) {
    auto all = vtkSmartPointer<vtkAppendPolyData>::New();
    for (const ContactMark& contact : contacts) {
        const Vector3d normal = contact.normal_s.normalized();
        all->AddInputData(arrowOf(contact.point_s + contact.length * normal, -normal, contact.length));
    }
    if (contacts.empty())
        return vtkSmartPointer<vtkPolyData>::New();
    all->Update();
    return all->GetOutput();
}

}  // namespace skincal
