#include "ui/scene3d/body_actors.h"

#include <vtkActor.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>

#include "ui/scene3d/body_scene.h"
#include "ui/scene3d/scene_glyphs.h"

namespace skincal {
namespace {

constexpr std::size_t kMaxEllipsoids = 1000;

vtkSmartPointer<vtkActor> emptyActor(vtkRenderer& renderer) {
    auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
    mapper->SetInputData(vtkSmartPointer<vtkPolyData>::New());
    mapper->ScalarVisibilityOff();
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    actor->VisibilityOff();
    renderer.AddActor(actor);
    return actor;
}

void give(vtkActor& actor, vtkPolyData* data) {
    vtkPolyDataMapper::SafeDownCast(actor.GetMapper())->SetInputData(data);
    actor.SetVisibility(data->GetNumberOfCells() > 0 ? 1 : 0);
}

void paint(vtkActor& actor, const Rgb& colour) {
    actor.GetProperty()->SetColor(colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0);
}

void asLines(vtkActor& actor, double width) {
    actor.GetProperty()->SetLighting(false);
    actor.GetProperty()->SetLineWidth(static_cast<float>(width));
}

}  // namespace

Rgb guideColour(bool dark) {
    return dark ? Rgb{255, 122, 69} : Rgb{201, 72, 12};
}

Rgb cameraColour(bool dark) {
    return dark ? Rgb{150, 158, 171} : Rgb{104, 112, 126};
}

Rgb ellipsoidColour(bool dark) {
    return dark ? Rgb{255, 158, 196} : Rgb{204, 38, 112};
}

Rgb backgroundColour(bool dark) {
    return dark ? Rgb{33, 37, 43} : Rgb{246, 247, 249};
}

BodyActors::BodyActors(vtkRenderer& renderer)
    : renderer_(renderer),
      cameras_(emptyActor(renderer)),
      ellipsoids_(emptyActor(renderer)),
      selectedUnder_(emptyActor(renderer)),
      selected_(emptyActor(renderer)),
      guide_(emptyActor(renderer)),
      guideFill_(emptyActor(renderer)),
      up_(emptyActor(renderer)),
      contacts_(emptyActor(renderer)),
      mesh_(emptyActor(renderer)) {
    renderer.AddActor(boards_.actor());
    asLines(*cameras_, 1.4);
    cameras_->GetProperty()->SetOpacity(0.6);
    asLines(*guide_, 2.5);
    guide_->GetProperty()->SetRepresentationToWireframe();
    asLines(*guideFill_, 1);
    guideFill_->GetProperty()->SetOpacity(0.22);
    // White on black is seen on every colour of board and background.
    asLines(*selectedUnder_, 7);
    paint(*selectedUnder_, {10, 11, 13});
    asLines(*selected_, 3.5);
    paint(*selected_, {255, 255, 255});
    for (const auto& arrow : {up_, contacts_}) {
        arrow->GetProperty()->SetAmbient(0.45);
        arrow->GetProperty()->SetDiffuse(0.6);
    }
    ellipsoids_->GetProperty()->SetOpacity(0.9);
    ellipsoids_->GetProperty()->SetAmbient(0.35);
    ellipsoids_->GetProperty()->SetDiffuse(0.75);
    ellipsoids_->GetProperty()->SetSpecular(0.25);
    ellipsoids_->GetProperty()->SetSpecularPower(25);
    ellipsoids_->GetProperty()->BackfaceCullingOn();
    mesh_->GetProperty()->SetOpacity(0.3);
    mesh_->GetProperty()->SetAmbient(0.3);
    setDark(true);
}

void BodyActors::show(const BodyModel& body, const SceneLayout& layout) {
    boards_.build(layout);
    boards_.actor()->SetVisibility(layout.modules.empty() ? 0 : 1);
    const int shown = cameras_->GetVisibility();
    give(*cameras_, camerasOf(body, cameraSize(layout)));
    cameras_->SetVisibility(shown);
    setSelected(layout, {});
}

void BodyActors::clear() {
    const SceneLayout nothing;
    boards_.build(nothing);
    for (const auto& actor : {cameras_, ellipsoids_, selectedUnder_, selected_, guide_, guideFill_, up_, contacts_})
        actor->VisibilityOff();
    boards_.actor()->VisibilityOff();
}

void BodyActors::setDark(bool dark) {
    const Rgb low = dark ? Rgb{24, 27, 32} : Rgb{232, 235, 240};
    const Rgb high = dark ? Rgb{44, 49, 57} : Rgb{255, 255, 255};
    renderer_.SetBackground(low[0] / 255.0, low[1] / 255.0, low[2] / 255.0);
    renderer_.SetBackground2(high[0] / 255.0, high[1] / 255.0, high[2] / 255.0);
    renderer_.GradientBackgroundOn();
    boards_.setDark(dark);
    paint(*cameras_, cameraColour(dark));
    paint(*ellipsoids_, ellipsoidColour(dark));
    paint(*guide_, guideColour(dark));
    paint(*guideFill_, guideColour(dark));
    paint(*up_, guideColour(dark));
    paint(*contacts_, guideColour(dark));
    paint(*mesh_, {150, 158, 171});
}

void BodyActors::setCamerasShown(bool shown) {
    cameras_->SetVisibility(shown ? 1 : 0);
}

void BodyActors::setEllipsoids(const BodyModel& body, double scale) {
    if (scale > 0)
        give(*ellipsoids_, ellipsoidsOf(body, scale, kMaxEllipsoids));
    else
        ellipsoids_->VisibilityOff();
}

void BodyActors::setSelected(const SceneLayout& layout, std::span<const ModuleId> modules) {
    const auto lines = outlinesOf(layout, modules);
    give(*selectedUnder_, lines);
    give(*selected_, lines);
}

void BodyActors::setGuideCamera(const std::optional<Isometry3d>& T_s_v, double size) {
    guide_->SetVisibility(T_s_v ? 1 : 0);
    guideFill_->SetVisibility(T_s_v ? 1 : 0);
    if (!T_s_v)
        return;
    const auto pyramid = pyramidOf(*T_s_v, size);
    give(*guide_, pyramid);
    give(*guideFill_, pyramid);
}

Vector3d BodyActors::tipOfUp(const Vector3d& direction, const SceneLayout& layout) {
    return layout.centre + 1.2 * layout.radius * direction.normalized();
}

void BodyActors::setGuideUp(const std::optional<Vector3d>& direction, const SceneLayout& layout) {
    up_->SetVisibility(direction ? 1 : 0);
    if (direction)
        give(*up_,
             arrowOf(layout.centre + 0.6 * layout.radius * direction->normalized(), *direction, 0.6 * layout.radius));
}

void BodyActors::setContacts(std::span<const ContactMark> contacts) {
    give(*contacts_, contactArrows(contacts));
}

void BodyActors::setMesh(vtkPolyData* mesh) {
    mesh_->SetVisibility(mesh != nullptr ? 1 : 0);
    if (mesh != nullptr)
        give(*mesh_, mesh);
}

}  // namespace skincal
