#include "ui/scene3d/body_scene.h"

#include <vtkActor.h>
#include <vtkAppendPolyData.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace skincal {
namespace {

/// Okabe and Ito's palette, less black.
constexpr std::array<std::array<double, 3>, 8> kPalette{{{0.00, 0.45, 0.70},
                                                         {0.90, 0.62, 0.00},
                                                         {0.00, 0.62, 0.45},
                                                         {0.80, 0.47, 0.65},
                                                         {0.34, 0.71, 0.91},
                                                         {0.84, 0.37, 0.00},
                                                         {0.94, 0.89, 0.26},
                                                         {0.55, 0.55, 0.60}}};

std::map<std::string, const ModuleTemplate*> templatesByName(const BodyModel& body) {
    std::map<std::string, const ModuleTemplate*> byName;
    for (const ModuleTemplate& type : body.templates)
        byName[type.name] = &type;
    return byName;
}

vtkSmartPointer<vtkActor> actorOf(vtkPolyData* data) {
    auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
    mapper->SetInputData(data);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    return actor;
}

void addLine(vtkPoints& points, vtkCellArray& lines, const Vector3d& a, const Vector3d& b) {
    lines.InsertNextCell(2);
    lines.InsertCellPoint(points.InsertNextPoint(a.x(), a.y(), a.z()));
    lines.InsertCellPoint(points.InsertNextPoint(b.x(), b.y(), b.z()));
}

Vector3d centreOf(const BodyModel& body) {
    Vector3d sum = Vector3d::Zero();
    double count = 0;
    for (const BodyModule& module : body.modules) {
        if (module.T_body_module) {
            sum += module.T_body_module->translation();
            ++count;
        }
    }
    return count > 0 ? Vector3d(sum / count) : sum;
}

double radiusOf(const BodyModel& body, const Vector3d& centre) {
    double radius = 0.02;
    for (const BodyModule& module : body.modules) {
        if (module.T_body_module)
            radius = std::max(radius, (module.T_body_module->translation() - centre).norm() + 0.02);
    }
    return radius;
}

}  // namespace

std::array<double, 3> patchColour(PatchId patch) {
    return kPalette.at(patch.value % kPalette.size());
}

vtkSmartPointer<vtkPolyData> boardsOf(const BodyModel& body) {
    const auto types = templatesByName(body);
    auto points = vtkSmartPointer<vtkPoints>::New();
    auto polygons = vtkSmartPointer<vtkCellArray>::New();
    auto colours = vtkSmartPointer<vtkUnsignedCharArray>::New();
    colours->SetNumberOfComponents(3);
    for (const BodyModule& module : body.modules) {
        const auto type = types.find(module.type);
        if (!module.T_body_module || type == types.end())
            continue;
        polygons->InsertNextCell(static_cast<vtkIdType>(type->second->outline.size()));
        for (const Vector2d& corner : type->second->outline) {
            const Vector3d p = *module.T_body_module * Vector3d(corner.x(), corner.y(), 0);
            polygons->InsertCellPoint(points->InsertNextPoint(p.x(), p.y(), p.z()));
        }
        const auto colour = patchColour(module.patch.value_or(PatchId(0)));
        colours->InsertNextTuple3(255 * colour[0], 255 * colour[1], 255 * colour[2]);
    }
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetPolys(polygons);
    data->GetCellData()->SetScalars(colours);
    return data;
}

vtkSmartPointer<vtkPolyData> ledsOf(const BodyModel& body) {
    const auto types = templatesByName(body);
    auto append = vtkSmartPointer<vtkAppendPolyData>::New();
    auto empty = vtkSmartPointer<vtkPolyData>::New();
    append->AddInputData(empty);
    for (const BodyModule& module : body.modules) {
        const auto type = types.find(module.type);
        if (!module.T_body_module || type == types.end())
            continue;
        const Vector3d p = *module.T_body_module * type->second->led;
        auto sphere = vtkSmartPointer<vtkSphereSource>::New();
        sphere->SetCenter(p.x(), p.y(), p.z());
        sphere->SetRadius(0.0012);
        sphere->SetThetaResolution(10);
        sphere->SetPhiResolution(8);
        append->AddInputConnection(sphere->GetOutputPort());
    }
    append->Update();
    return append->GetOutput();
}

vtkSmartPointer<vtkPolyData> camerasOf(const BodyModel& body, double size) {
    auto points = vtkSmartPointer<vtkPoints>::New();
    auto lines = vtkSmartPointer<vtkCellArray>::New();
    for (const BodyView& view : body.views) {
        if (!view.T_body_camera)
            continue;
        const std::array<Vector3d, 4> corners{*view.T_body_camera * Vector3d(-0.8 * size, -0.45 * size, size),
                                              *view.T_body_camera * Vector3d(0.8 * size, -0.45 * size, size),
                                              *view.T_body_camera * Vector3d(0.8 * size, 0.45 * size, size),
                                              *view.T_body_camera * Vector3d(-0.8 * size, 0.45 * size, size)};
        for (std::size_t i = 0; i < 4; ++i) {
            addLine(*points, *lines, view.T_body_camera->translation(), corners.at(i));
            addLine(*points, *lines, corners.at(i), corners.at((i + 1) % 4));
        }
    }
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetLines(lines);
    return data;
}

void addBody(vtkRenderer& renderer, const BodyModel& body) {
    auto boards = actorOf(boardsOf(body));
    boards->GetProperty()->EdgeVisibilityOn();
    boards->GetProperty()->SetEdgeColor(0.12, 0.13, 0.16);
    boards->GetProperty()->SetLineWidth(1.5);
    boards->GetProperty()->SetInterpolationToFlat();
    boards->GetProperty()->SetAmbient(0.55);
    boards->GetProperty()->SetDiffuse(0.5);
    // From behind, a board shows its electronics: darker, so that inside and outside are told apart.
    auto back = vtkSmartPointer<vtkProperty>::New();
    back->SetColor(0.3, 0.31, 0.34);
    back->SetAmbient(0.5);
    boards->SetBackfaceProperty(back);
    renderer.AddActor(boards);

    auto leds = actorOf(ledsOf(body));
    leds->GetProperty()->SetColor(1, 1, 0.92);
    leds->GetProperty()->SetAmbient(0.9);
    renderer.AddActor(leds);

    auto cameras = actorOf(camerasOf(body, 0.08 * radiusOf(body, centreOf(body))));
    cameras->GetProperty()->SetColor(0.45, 0.49, 0.55);
    cameras->GetProperty()->SetLineWidth(1.2);
    cameras->GetProperty()->SetLighting(false);
    renderer.AddActor(cameras);
}

void lookAtBody(vtkRenderer& renderer, const BodyModel& body) {
    const Vector3d centre = centreOf(body);
    const double radius = radiusOf(body, centre);
    // From where most boards face, a little aside so that depth shows; upright as the first camera was.
    Vector3d from = Vector3d::Zero();
    for (const BodyModule& module : body.modules) {
        if (module.T_body_module)
            from += module.T_body_module->linear().col(2);
    }
    from = from.norm() > 1e-6 ? Vector3d(from.normalized()) : Vector3d::UnitZ();
    Vector3d up(0, 1, 0);
    for (const BodyView& view : body.views) {
        if (!view.T_body_camera)
            continue;
        up = -view.T_body_camera->linear().col(1);
        break;
    }
    if (std::abs(up.dot(from)) > 0.95)
        up = from.unitOrthogonal();
    const Vector3d side = up.cross(from).normalized();
    from = (from + 0.25 * side + 0.2 * up).normalized();
    vtkCamera* camera = renderer.GetActiveCamera();
    camera->SetViewAngle(30);
    const double distance = 0.92 * radius / std::sin(0.5 * 30 * kDegree);
    const Vector3d position = centre + distance * from;
    camera->SetFocalPoint(centre.x(), centre.y(), centre.z());
    camera->SetPosition(position.x(), position.y(), position.z());
    camera->SetViewUp(up.x(), up.y(), up.z());
    renderer.ResetCameraClippingRange();
}

}  // namespace skincal
