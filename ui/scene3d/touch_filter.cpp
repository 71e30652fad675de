#include "ui/scene3d/touch_filter.h"

#include <QMouseEvent>

#include "ui/scene3d/body_view_widget.h"
#include "ui/scene3d/scene_widget.h"

namespace skincal {

TouchFilter::TouchFilter(BodyViewWidget& view, QObject* parent) : QObject(parent), view_(view) {
    view_.scene().installEventFilter(this);
}

void TouchFilter::setOn(bool on) {
    isOn_ = on;
    view_.scene().setCursor(on ? Qt::PointingHandCursor : Qt::ArrowCursor);
    if (!on)
        end();
}

bool TouchFilter::eventFilter(QObject* watched, QEvent* event) {
    // The scene sees no part of a press that began as a touch.
    if (!isOn_ && !isPressed_)
        return QObject::eventFilter(watched, event);
    switch (event->type()) {
        case QEvent::MouseButtonPress:
        case QEvent::MouseButtonDblClick: {
            const auto* mouse = static_cast<QMouseEvent*>(event);
            if (!isOn_ || mouse->button() != Qt::LeftButton || mouse->modifiers() != Qt::NoModifier ||
                view_.measuring() || !view_.pickAt(mouse->position()))
                break;
            view_.setFocus(Qt::MouseFocusReason);
            isPressed_ = true;
            follow(mouse->position());
            return true;
        }
        case QEvent::MouseMove:
            if (!isPressed_)
                break;
            if (isOn_)
                follow(static_cast<QMouseEvent*>(event)->position());
            return true;
        case QEvent::MouseButtonRelease:
            if (!isPressed_ || static_cast<QMouseEvent*>(event)->button() != Qt::LeftButton)
                break;
            isPressed_ = false;
            end();
            return true;
        case QEvent::Hide:
            isPressed_ = false;
            end();
            break;
        default:
            break;
    }
    return QObject::eventFilter(watched, event);
}

void TouchFilter::follow(const QPointF& position) {
    if (const auto pick = view_.pickAt(position)) {
        isTouching_ = true;
        emit touched(pick->module, pick->point_u);
    } else if (std::exchange(isTouching_, false)) {
        emit released();
    }
}

void TouchFilter::end() {
    if (std::exchange(isTouching_, false))
        emit released();
}

}  // namespace skincal
