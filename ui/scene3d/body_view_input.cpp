// What BodyViewWidget does with mouse and keys.

#include <vtkCamera.h>
#include <vtkRenderer.h>

#include <QFocusEvent>
#include <QKeyEvent>
#include <algorithm>
#include <cmath>

#include "ui/scene3d/body_view_widget.h"
#include "ui/scene3d/scene_overlay.h"
#include "ui/scene3d/scene_widget.h"

namespace skincal {

void BodyViewWidget::click(const QPointF& position) {
    setFocus(Qt::MouseFocusReason);
    const auto module = moduleAt(position);
    if (module)
        choose(*module);
    else if (!measuring_)
        emit nothingClicked();
}

void BodyViewWidget::choose(ModuleId module) {
    if (measuring_)
        measureTo(module);
    else
        emit moduleClicked(module);
}

void BodyViewWidget::stepModules(int way) {
    std::vector<ModuleId> modules;
    for (const ShownModule& module : layout_.modules)
        modules.push_back(module.id);
    if (modules.empty())
        return;
    std::sort(modules.begin(), modules.end());
    // One that has gone leads to its neighbours by number.
    const std::optional<ModuleId> from = current_                ? current_
                                         : selected_.size() == 1 ? std::optional(selected_.front())
                                                                 : std::nullopt;
    if (!from)
        current_ = way > 0 ? modules.front() : modules.back();
    else if (way > 0)
        current_ = *std::prev(modules.end()) > *from ? *std::upper_bound(modules.begin(), modules.end(), *from) : *from;
    else if (modules.front() < *from)
        current_ = *std::prev(std::lower_bound(modules.begin(), modules.end(), *from));
    focusFrame_ = true;
    outlineSelected();
    updateWords();
}

void BodyViewWidget::measureTo(ModuleId module) {
    // A third click begins anew, a second one on the same module changes nothing.
    if (measured_.size() == 2)
        measured_.clear();
    if (measured_.empty() || measured_.front() != module)
        measured_.push_back(module);
    updateWords();
    const std::vector<Vector3d> ends = measurePoints();
    if (ends.size() == 2)
        emit measured(measured_[0], measured_[1], (ends[1] - ends[0]).norm());
}

std::optional<ModuleId> BodyViewWidget::moduleAt(const QPointF& position) const {
    const auto pick = pickAt(position);
    return pick ? std::optional(pick->module) : std::nullopt;
}

std::optional<ScenePick> BodyViewWidget::pickAt(const QPointF& position) const {
    if (layout_.modules.empty())
        return std::nullopt;
    vtkCamera* camera = scene_->renderer().GetActiveCamera();
    const double aspect = static_cast<double>(scene_->width()) / std::max(1, scene_->height());
    const double half = std::tan(0.5 * camera->GetViewAngle() * kDegree);
    const double* shift = camera->GetWindowCenter();
    const double x = (2 * position.x() / std::max(1, scene_->width()) - 1 + shift[0]) * half * aspect;
    const double y = (1 - 2 * position.y() / std::max(1, scene_->height()) + shift[1]) * half;
    const Vector3d eye(camera->GetPosition());
    const Vector3d ahead(camera->GetDirectionOfProjection());
    const Vector3d up = Vector3d(camera->GetViewUp());
    const Vector3d right = ahead.cross(up).normalized();
    return pickPoint(layout_, eye, ahead + x * right + y * right.cross(ahead));
}

std::optional<QPointF> BodyViewWidget::positionOf(const Vector3d& point) const {
    return overlay_->project(point);
}

void BodyViewWidget::keyPressEvent(QKeyEvent* event) {
    constexpr double kStep = 10 * kDegree;
    constexpr double kZoom = 1.2;
    switch (event->key()) {
        case Qt::Key_Left:
            return scene_->orbit(-kStep, 0);
        case Qt::Key_Right:
            return scene_->orbit(kStep, 0);
        case Qt::Key_Up:
            return scene_->orbit(0, kStep);
        case Qt::Key_Down:
            return scene_->orbit(0, -kStep);
        case Qt::Key_Plus:
        case Qt::Key_Equal:
            return scene_->zoom(kZoom);
        case Qt::Key_Minus:
            return scene_->zoom(1 / kZoom);
        case Qt::Key_F:
            return event->modifiers().testFlag(Qt::ShiftModifier) ? fitEverything() : fitView();
        case Qt::Key_Home:
            return resetView();
        case Qt::Key_PageUp:
            return stepModules(-1);
        case Qt::Key_PageDown:
            return stepModules(1);
        case Qt::Key_Return:
        case Qt::Key_Enter:
            if (current_ && layout_.find(*current_) != nullptr)
                return choose(*current_);
            break;
        case Qt::Key_Escape:
            if (!measured_.empty()) {
                measured_.clear();
                return updateWords();
            }
            break;
        default:
            break;
    }
    QWidget::keyPressEvent(event);
}

void BodyViewWidget::focusInEvent(QFocusEvent* event) {
    // Those who come with the mouse know where they are.
    focusFrame_ = event->reason() != Qt::MouseFocusReason && event->reason() != Qt::ActiveWindowFocusReason;
    outlineSelected();
    updateWords();
}

void BodyViewWidget::focusOutEvent(QFocusEvent* /*event*/) {
    focusFrame_ = false;
    outlineSelected();
    updateWords();
}

}  // namespace skincal
