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

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

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

/// Where to look from (unit vector towards the spectator) and what is up.
struct BodyView3d {
    Vector3d from;
    Vector3d up;
};

/// From where most boards face, a little aside so that depth shows; turned so that the body lies along the picture's
/// longer side, as upright as the first camera was.
BodyView3d bestView(const BodyModel& body, bool landscape) {
    Vector3d from = Vector3d::Zero();
    Matrix3d spread = Matrix3d::Zero();
    const Vector3d centre = centreOf(body);
    for (const BodyModule& module : body.modules) {
        if (!module.T_body_module)
            continue;
        from += module.T_body_module->linear().col(2);
        const Vector3d d = module.T_body_module->translation() - centre;
        spread += d * d.transpose();
    }
    from = from.norm() > 1e-6 ? Vector3d(from.normalized()) : Vector3d::UnitZ();
    const auto view = std::find_if(body.views.begin(), body.views.end(),
                                   [](const BodyView& v) { return v.T_body_camera.has_value(); });
    Vector3d up = view == body.views.end() ? Vector3d(0, 1, 0) : Vector3d(-view->T_body_camera->linear().col(1));
    if (std::abs(up.dot(from)) > 0.95)
        up = from.unitOrthogonal();
    const Vector3d side = up.cross(from).normalized();
    from = (from + 0.25 * side + 0.2 * up).normalized();

    const Matrix3d across = Matrix3d::Identity() - from * from.transpose();
    const Eigen::SelfAdjointEigenSolver<Matrix3d> axes(across * spread * across);
    const Vector3d extent = axes.eigenvalues();
    constexpr double kLonger = 1.3;  // squared ratio of the sides from which a body has a direction
    if (extent[2] > kLonger * extent[1]) {
        const Vector3d along = axes.eigenvectors().col(2);
        const Vector3d turned = landscape ? from.cross(along) : along;
        up = turned.dot(up) < 0 ? Vector3d(-turned) : turned;
    }
    return {from, up};
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

    auto cameras = actorOf(camerasOf(body, 0.035 * radiusOf(body, centreOf(body))));
    cameras->GetProperty()->SetColor(0.45, 0.49, 0.55);
    cameras->GetProperty()->SetLineWidth(1.2);
    cameras->GetProperty()->SetLighting(false);
    renderer.AddActor(cameras);
}

double lookAtBody(vtkRenderer& renderer, const BodyModel& body, const Margins& margins, double aspect) {
    const BodyView3d view = bestView(body, aspect >= 1);
    const Vector3d x = view.up.cross(view.from).normalized();
    const Vector3d y = view.from.cross(x);

    // All boards, in axes right, up and towards the spectator.
    std::vector<Vector3d> points;
    const auto boards = boardsOf(body);
    for (vtkIdType i = 0; i < boards->GetNumberOfPoints(); ++i) {
        const Vector3d p(boards->GetPoint(i));
        points.emplace_back(p.dot(x), p.dot(y), p.dot(view.from));
    }
    if (points.empty())
        points.emplace_back(0, 0, 0);

    // A point is in the picture where x - c <= (d - z) right and c - x <= (d - z) left, with the spectator at c, d:
    // d right + c >= max(x + z right) and d left - c >= max(z left - x); the same for top and bottom.
    constexpr double kAngle_deg = 30;
    const double half = std::tan(0.5 * kAngle_deg * kDegree);
    struct Side {
        double more, less;  // tangents of the angles that are free on either side of the axis
        double a = -1e300, b = -1e300;
    };
    std::array<Side, 2> sides{Side{half * aspect * (1 - 2 * margins.right), half * aspect * (1 - 2 * margins.left)},
                              Side{half * (1 - 2 * margins.top), half * (1 - 2 * margins.bottom)}};
    for (const Vector3d& p : points) {
        for (int i = 0; i < 2; ++i) {
            Side& s = sides.at(static_cast<std::size_t>(i));
            s.a = std::max(s.a, p[i] + p.z() * s.more);
            s.b = std::max(s.b, p.z() * s.less - p[i]);
        }
    }
    double distance = -1e300;
    for (const Side& s : sides)
        distance = std::max(distance, (s.a + s.b) / (s.more + s.less));
    Vector3d place(0, 0, distance);
    for (int i = 0; i < 2; ++i) {
        const Side& s = sides.at(static_cast<std::size_t>(i));
        place[i] = 0.5 * ((s.a - distance * s.more) + (distance * s.less - s.b));
    }
    const Vector3d eye = place.x() * x + place.y() * y + place.z() * view.from;
    const double depth = std::max(0.02, distance - centreOf(body).dot(view.from));
    const Vector3d focus = eye - depth * view.from;
    vtkCamera* camera = renderer.GetActiveCamera();
    camera->SetViewAngle(kAngle_deg);
    camera->SetFocalPoint(focus.x(), focus.y(), focus.z());
    camera->SetPosition(eye.x(), eye.y(), eye.z());
    camera->SetViewUp(view.up.x(), view.up.y(), view.up.z());
    renderer.ResetCameraClippingRange();
    return 2 * depth * half;
}

}  // namespace skincal
