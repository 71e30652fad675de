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
#include <vector>

#include "ui/palette.h"

namespace skincal {
namespace {

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

std::optional<Vector3d> firstCameraUp(const BodyModel& body) {
    const auto view = std::find_if(body.views.begin(), body.views.end(),
                                   [](const BodyView& v) { return v.T_body_camera.has_value(); });
    if (view == body.views.end())
        return std::nullopt;
    return Vector3d(-view->T_body_camera->linear().col(1));
}

std::array<double, 3> patchColour(PatchId patch) {
    const std::uint32_t colour = kKinds.at(patch.value % kKinds.size());
    return {(colour >> 16 & 0xff) / 255.0, (colour >> 8 & 0xff) / 255.0, (colour & 0xff) / 255.0};
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

    auto cameras = actorOf(camerasOf(body, 0.035 * radiusOf(body, centreOf(body))));
    cameras->GetProperty()->SetColor(0.45, 0.49, 0.55);
    cameras->GetProperty()->SetLineWidth(1.2);
    cameras->GetProperty()->SetLighting(false);
    renderer.AddActor(cameras);
}

double lookAtBody(vtkRenderer& renderer, const BodyModel& body, const Margins& margins, double aspect) {
    std::vector<Isometry3d> poses;
    for (const BodyModule& module : body.modules) {
        if (module.T_body_module)
            poses.push_back(*module.T_body_module);
    }
    std::vector<Vector3d> points;
    const auto boards = boardsOf(body);
    for (vtkIdType i = 0; i < boards->GetNumberOfPoints(); ++i)
        points.emplace_back(boards->GetPoint(i));
    const Spectator spectator = bestSpectator(poses, firstCameraUp(body), aspect >= 1);
    const double height = fitCamera(*renderer.GetActiveCamera(), spectator, points, centreOf(body), margins, aspect);
    renderer.ResetCameraClippingRange();
    return height;
}

}  // namespace skincal
