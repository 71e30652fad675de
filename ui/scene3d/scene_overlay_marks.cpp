// What SceneOverlay draws that follows the camera: axes, scale bar, a measured distance.

#include <vtkCamera.h>
#include <vtkMatrix4x4.h>

#include <QPainter>
#include <algorithm>
#include <array>
#include <cmath>

#include "ui/scene3d/scene_overlay.h"

namespace skincal {

void SceneOverlay::paintMeasure(QPainter& painter) const {
    std::optional<QPointF> last;
    for (const Vector3d& point : content_.measure) {
        const auto at = project(point);
        if (!at)
            continue;
        painter.setPen(QPen(content_.measureColour, 2.5, Qt::SolidLine, Qt::RoundCap));
        if (last)
            painter.drawLine(*last, *at);
        painter.setBrush(ground());
        painter.drawEllipse(*at, 5, 5);
        last = at;
    }
}

double SceneOverlay::pixelsPerMetre() const {
    return height() / (2 * camera_.GetDistance() * std::tan(0.5 * camera_.GetViewAngle() * kDegree));
}

void SceneOverlay::paintAxes(QPainter& painter) const {
    if (!content_.axes)
        return;
    // Okabe and Ito's vermilion, bluish green and blue: told apart without seeing red and green.
    const std::array<QColor, 3> colours{QColor(222, 97, 24), QColor(0, 168, 122),
                                        content_.dark ? QColor(86, 170, 240) : QColor(0, 108, 190)};
    const std::array<QString, 3> names{"x", "y", "z"};
    const QPointF origin(54, height() - 54);
    constexpr double kLength = 32;
    vtkMatrix4x4* view = camera_.GetModelViewTransformMatrix();
    std::array<int, 3> order{0, 1, 2};
    std::sort(order.begin(), order.end(),
              [&](int a, int b) { return view->GetElement(2, a) < view->GetElement(2, b); });
    QFont bold = painter.font();
    bold.setBold(true);
    painter.setFont(bold);
    for (const int axis : order) {
        const QPointF way(view->GetElement(0, axis), -view->GetElement(1, axis));
        painter.setPen(QPen(colours.at(static_cast<std::size_t>(axis)), 3, Qt::SolidLine, Qt::RoundCap));
        painter.drawLine(origin, origin + kLength * way);
        QRectF box(0, 0, 20, 20);
        // An axis that points at the spectator still has its letter beside it.
        const double length = std::hypot(way.x(), way.y());
        const QPointF aside = length > 0.25 ? (kLength + 10 / length) * way : QPointF(11, -11);
        box.moveCenter(origin + aside);
        painter.drawText(box, Qt::AlignCenter, names.at(static_cast<std::size_t>(axis)));
    }
    painter.setFont(font());
}

void SceneOverlay::paintScale(QPainter& painter) const {
    const double perMetre = pixelsPerMetre();
    if (!content_.scale || !std::isfinite(perMetre) || perMetre <= 0)
        return;
    const double longest = std::min(160.0, width() / 5.0) / perMetre;
    double length = std::pow(10, std::floor(std::log10(longest)));
    for (const double factor : {5.0, 2.0}) {
        if (length * factor <= longest) {
            length *= factor;
            break;
        }
    }
    const double right = width() - kMargin;
    const double left = right - length * perMetre;
    const double y = height() - kMargin - 2;
    painter.setPen(QPen(softInk(), 2, Qt::SolidLine, Qt::FlatCap, Qt::MiterJoin));
    painter.setBrush(Qt::NoBrush);
    painter.drawPolyline(QPolygonF{{left, y - 6}, {left, y}, {right, y}, {right, y - 6}});
    const double mm = 1e3 * length;
    const QString text = mm >= 1000 ? tr("%L1 m").arg(mm / 1000) : tr("%L1 mm").arg(mm);
    painter.drawText(QRectF(right - 200, y - 9 - 20, 200, 20), Qt::AlignRight | Qt::AlignBottom, text);
}

}  // namespace skincal
