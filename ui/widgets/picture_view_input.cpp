// What PictureView does with mouse and keys.

#include <QKeyEvent>
#include <QMouseEvent>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

#include "ui/widgets/picture_view.h"

namespace skincal {

void PictureView::wheelEvent(QWheelEvent* event) {
    zoomAbout(event->position(), std::pow(1.0015, event->angleDelta().y()));
}

void PictureView::zoomAbout(const QPointF& position, double factor) {
    const double zoom = std::clamp(zoom_ * factor, 1.0, 32.0);
    // What is there stays there.
    const QPointF from = position - QPointF(0.5 * width(), 0.5 * height()) - shift_;
    shift_ += from * (1 - zoom / zoom_);
    zoom_ = zoom;
    if (zoom_ == 1)
        shift_ = {};
    update();
}

void PictureView::shiftBy(const QPointF& way) {
    shift_ += way;
    update();
}

void PictureView::showAll() {
    zoom_ = 1;
    shift_ = {};
    update();
}

void PictureView::mousePressEvent(QMouseEvent* event) {
    pressedAt_ = event->position();
    isDragging_ = false;
}

void PictureView::mouseMoveEvent(QMouseEvent* event) {
    const QPointF way = event->position() - pressedAt_;
    if (!isDragging_ && way.manhattanLength() < 4)
        return;
    isDragging_ = true;
    if (zoom_ > 1) {
        shiftBy(way);
        pressedAt_ = event->position();
    }
}

void PictureView::mouseReleaseEvent(QMouseEvent* event) {
    if (isDragging_)
        return;
    constexpr double kReach = 14;
    const PictureMark* nearest = nullptr;
    double best = kReach;
    for (const PictureMark& mark : marks_) {
        const QPointF way = toWidget(mark.pixel) - event->position();
        const double distance = std::hypot(way.x(), way.y());
        if (mark.module && distance < best) {
            best = distance;
            nearest = &mark;
        }
    }
    if (nearest != nullptr) {
        emit markClicked(*nearest->module);
        return;
    }
    for (const PictureShape& shape : shapes_) {
        if (!shape.isDim && transform().map(shape.outline).containsPoint(event->position(), Qt::OddEvenFill)) {
            emit markClicked(shape.module);
            return;
        }
    }
}

void PictureView::mouseDoubleClickEvent(QMouseEvent*) {
    showAll();
}

std::vector<ModulePlace> PictureView::places() const {
    std::vector<ModulePlace> places;
    const auto add = [&](ModuleId module, const QPointF& at) {
        if (std::none_of(places.begin(), places.end(), [&](const ModulePlace& p) { return p.module == module; }))
            places.push_back({module, at});
    };
    for (const PictureMark& mark : marks_) {
        if (mark.module)
            add(*mark.module, toWidget(mark.pixel));
    }
    for (const PictureShape& shape : shapes_) {
        if (!shape.isDim)
            add(shape.module, toWidget(shape.outline.boundingRect().center()));
    }
    return places;
}

void PictureView::setCurrent(std::optional<ModuleId> module) {
    if (module == current_)
        return;
    current_ = module;
    setAccessibleDescription(module ? tr("Module %1").arg(module->value) : QString());
    update();
}

bool PictureView::moveByKey(int key) {
    const auto all = places();
    const auto find = [&](std::optional<ModuleId> module) {
        return std::find_if(all.begin(), all.end(), [&](const ModulePlace& place) { return place.module == module; });
    };
    if (key == Qt::Key_Return || key == Qt::Key_Enter || key == Qt::Key_Space) {
        // It may have gone with the picture that it was in.
        const bool isThere = find(current_) != all.end();
        if (isThere)
            emit markClicked(*current_);
        return isThere;
    }
    if (const auto next = moduleByKey(key, all, current_ ? current_ : selected_)) {
        setCurrent(next);
        const QPointF at = find(next)->at;
        constexpr double kEdge = 24;
        const QRectF inside = QRectF(rect()).adjusted(kEdge, kEdge, -kEdge, -kEdge);
        if (zoom_ > 1 && !inside.contains(at))
            shiftBy(inside.center() - at);
        return true;
    }
    constexpr double kStep = 60;  // px on the screen
    const bool canShift = all.empty() && zoom_ > 1;
    switch (canShift ? key : Qt::Key_unknown) {
        case Qt::Key_Left:
            shiftBy({kStep, 0});
            return true;
        case Qt::Key_Right:
            shiftBy({-kStep, 0});
            return true;
        case Qt::Key_Up:
            shiftBy({0, kStep});
            return true;
        case Qt::Key_Down:
            shiftBy({0, -kStep});
            return true;
        default:
            return false;
    }
}

void PictureView::keyPressEvent(QKeyEvent* event) {
    constexpr double kZoom = 1.25;
    const int key = event->key();
    const QPointF middle(0.5 * width(), 0.5 * height());
    if (key == Qt::Key_Plus || key == Qt::Key_Equal)
        zoomAbout(middle, kZoom);
    else if (key == Qt::Key_Minus)
        zoomAbout(middle, 1 / kZoom);
    else if (key == Qt::Key_0)
        showAll();
    else if (!moveByKey(key))
        QWidget::keyPressEvent(event);
}

}  // namespace skincal
