// What BodyViewWidget looks at, and the words above it.

#include <vtkCamera.h>
#include <vtkRenderer.h>

#include <algorithm>

#include "ui/scene3d/body_actors.h"
#include "ui/scene3d/body_scene.h"
#include "ui/scene3d/body_view_widget.h"
#include "ui/scene3d/scene_widget.h"

namespace skincal {
namespace {

constexpr std::size_t kMaxLabels = 12;
constexpr double kLegendRoom_px = 190;
constexpr double kBelow_px = 44;

QColor toQt(const Rgb& colour) {
    return {colour[0], colour[1], colour[2]};
}

void addCamera(std::vector<Vector3d>& points, const Isometry3d& T_r_v, double size) {
    points.emplace_back(T_r_v.translation());
    for (const double x : {-0.8, 0.8}) {
        for (const double y : {-0.45, 0.45})
            points.push_back(T_r_v * Vector3d(size * Vector3d(x, y, 1)));
    }
}

}  // namespace

void BodyViewWidget::lookAt(std::span<const Vector3d> points, bool anew) {
    vtkCamera* camera = scene_->renderer().GetActiveCamera();
    const double wide = std::max(1, width());
    const double high = std::max(1, height());
    Spectator spectator;
    if (anew && !layout_.anyPlaced) {
        // Patches in rows face us already: a little aside, so that depth shows, and the rows stay level.
        spectator.from = Vector3d(0.12, 0.3, 1).normalized();
        spectator.up = (Vector3d::UnitY() - spectator.from.y() * spectator.from).normalized();
    } else if (anew) {
        spectator = bestSpectator(layout_.poses(), firstCameraUp(*body_), wide >= high);
    } else {
        const Vector3d ahead(camera->GetDirectionOfProjection());
        spectator.from = -ahead;
        spectator.up = Vector3d(camera->GetViewUp());
        spectator.up = (spectator.up - spectator.up.dot(ahead) * ahead).normalized();
    }
    // What we turn about is in the middle of the picture as well as of the body.
    Matrix3d R;
    R << spectator.up.cross(spectator.from), spectator.up, spectator.from;
    Eigen::AlignedBox3d seen;
    for (const Vector3d& point : points)
        seen.extend(Vector3d(R.transpose() * point));
    const Vector3d centre = seen.isEmpty() ? Vector3d::Zero() : Vector3d(R * seen.center());
    // Room for the widest legend to expect, lest the body jumps with every change of colours.
    const double legend = std::max(kLegendRoom_px, overlay_->legendSize().width() + 20);
    const Margins margins{std::min(0.35, 0.01 + legend / wide), 0.05, 0.05, 0.05 + std::min(0.15, kBelow_px / high)};
    fitAbout(*camera, spectator, points, centre, margins, wide / high);
    movedByUser_ = false;
    scene_->requestDraw();
}

std::vector<Vector3d> BodyViewWidget::bodyPoints() const {
    std::vector<Vector3d> points = layout_.corners();
    if (layout_.anyPlaced && guideUp_)
        points.push_back(BodyActors::tipOfUp(*guideUp_, layout_));
    if (layout_.anyPlaced && guideCamera_)
        addCamera(points, *guideCamera_, 2 * BodyActors::cameraSize(layout_));
    return points;
}

void BodyViewWidget::fitView() {
    std::vector<Vector3d> points = bodyPoints();
    if (layout_.anyPlaced && !meshBox_.isEmpty()) {
        for (int corner = 0; corner < 8; ++corner)
            points.emplace_back(meshBox_.corner(static_cast<Eigen::AlignedBox3d::CornerType>(corner)));
    }
    lookAt(points, false);
    // The direction is the user's, and kept.
    movedByUser_ = true;
}

void BodyViewWidget::resetView() {
    lookAt(bodyPoints(), true);
}

void BodyViewWidget::fitEverything() {
    std::vector<Vector3d> points = bodyPoints();
    if (body_ && cameras_) {
        for (const auto& view : body_->views) {
            if (view.T_body_camera)
                addCamera(points, *view.T_body_camera, BodyActors::cameraSize(layout_));
        }
    }
    lookAt(points, false);
    movedByUser_ = true;
}

std::vector<Vector3d> BodyViewWidget::measurePoints() const {
    std::vector<Vector3d> points;
    for (const ModuleId id : measured_) {
        if (const ShownModule* module = layout_.find(id))
            points.push_back(module->led());
    }
    return points;
}

std::vector<SceneLabel> BodyViewWidget::labels() const {
    std::vector<SceneLabel> labels;
    for (const PatchId patch : layout_.apart) {
        // Below each patch of the row; many small ones are told apart by colour and a click.
        if (layout_.apart.size() > kMaxLabels)
            break;
        Eigen::AlignedBox3d box;
        for (const ShownModule& module : layout_.modules) {
            if (module.patch != patch || module.placed)
                continue;
            for (const Vector2d& corner : module.type->outline)
                box.extend(module.T_s_u * Vector3d(corner.x(), corner.y(), 0));
        }
        if (!layout_.anyPlaced && !box.isEmpty())
            labels.push_back(
                {Vector3d(box.center().x(), box.min().y() - 0.009, box.center().z()), BodyWords::patch(patch), false});
    }
    if (body_ && cameras_ && layout_.anyPlaced && body_->views.size() <= 2 * kMaxLabels) {
        for (const auto& view : body_->views) {
            if (view.T_body_camera)
                labels.push_back({view.T_body_camera->translation(), QString::fromStdString(view.name), false, -14});
        }
    }
    std::vector<ModuleId> named = selected_.size() <= kMaxLabels ? selected_ : std::vector<ModuleId>();
    if (current_ && areKeysAt(*current_) && std::find(named.begin(), named.end(), *current_) == named.end())
        named.push_back(*current_);
    for (const ModuleId id : named) {
        if (const ShownModule* module = layout_.find(id))
            labels.push_back({module->T_s_u.translation(), BodyWords::module(id), true, -16});
    }
    if (layout_.anyPlaced && guideCamera_)
        labels.push_back({guideCamera_->translation(), tr("Put the camera here"), true, -18});
    if (layout_.anyPlaced && guideUp_)
        labels.push_back({BodyActors::tipOfUp(*guideUp_, layout_), tr("This way up"), true, -16});
    const std::vector<Vector3d> ends = measurePoints();
    if (ends.size() == 2)
        labels.push_back({0.5 * (ends[0] + ends[1]), BodyWords::distance((ends[1] - ends[0]).norm()), true, -18});
    return labels;
}

void BodyViewWidget::updateWords() {
    OverlayContent content;
    content.dark = dark_;
    content.focus = focusFrame_;
    content.axes = layout_.anyPlaced;
    content.scale = true;
    content.measureColour = toQt(guideColour(dark_));
    if (layout_.modules.empty()) {
        content.empty = BodyWords::empty();
    } else {
        content.caption = BodyWords::caption(layout_);
        content.legend = BodyWords::legend(*body_, layout_, mode_, values_, dark_);
        if (mode_ == ColourMode::Values && !valueTitle_.isEmpty()) {
            content.legend.title = valueTitle_;
            content.legend.low = valueLow_;
            content.legend.high = valueHigh_;
        }
        if (ellipsoidScale_ > 0)
            content.legend.more.push_back({toQt(ellipsoidColour(dark_)), BodyWords::ellipsoids(ellipsoidScale_)});
        content.labels = labels();
        content.measure = measurePoints();
        if (measuring_ && content.measure.size() < 2)
            content.caption =
                content.measure.empty() ? tr("Measure: click on a module.") : tr("Measure: click on another module.");
    }
    overlay_->setContent(std::move(content));
    scene_->requestDraw();
    setAccessibleName(tr("Body in 3D"));
    setAccessibleDescription(current_ && areKeysAt(*current_) ? BodyWords::module(*current_)
                                                              : BodyWords::description(body_.get(), layout_));
    setToolTip(BodyWords::hint());
}

}  // namespace skincal
