#include "ui/widgets/gravity_sphere.h"

#include <QPainter>
#include <QPainterPath>
#include <cmath>

#include "ui/widgets/theme.h"

namespace skincal {
namespace {

/// Points of the great circle from a to b.
std::vector<Vector3d> arcBetween(const Vector3d& a, const Vector3d& b) {
    constexpr int kPieces = 24;
    Vector3d axis = a.cross(b);
    if (axis.norm() < 1e-9)
        axis = a.unitOrthogonal();
    const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
    std::vector<Vector3d> points;
    for (int i = 0; i <= kPieces; ++i)
        points.emplace_back(Eigen::AngleAxisd(angle * i / kPieces, axis.normalized()) * a);
    return points;
}

}  // namespace

GravitySphere::GravitySphere(QWidget* parent) : QWidget(parent) {
    setAccessibleName(tr("Gravity directions"));
    setToolTip(tr("Directions that have pointed up. The large dot is where the body is now; bring it into the ring."));
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
}

void GravitySphere::setCovered(std::vector<Vector3d> directions) {
    covered_ = std::move(directions);
    update();
}

void GravitySphere::setCurrent(const std::optional<Vector3d>& direction) {
    current_ = direction;
    turnToFace();
    update();
}

void GravitySphere::setTarget(const std::optional<Vector3d>& direction) {
    target_ = direction;
    turnToFace();
    update();
}

void GravitySphere::turnToFace() {
    // Seen from between where the body is and where it should be: both are in front while less than half a turn apart.
    Vector3d eye = Vector3d::UnitZ();
    if (current_ && target_) {
        const Vector3d middle = *current_ + *target_;
        eye = middle.norm() > 0.2 ? Vector3d(middle.normalized()) : current_->unitOrthogonal();
    } else if (current_ || target_) {
        eye = current_ ? *current_ : *target_;
    }
    // As little turned about the line of sight as possible, so that the picture does not spin while the body moves.
    const Vector3d before = R_screen_.row(0).transpose();
    Vector3d right = before - before.dot(eye) * eye;
    right = right.norm() > 1e-3 ? Vector3d(right.normalized()) : Vector3d(eye.unitOrthogonal());
    R_screen_.row(0) = right.transpose();
    R_screen_.row(1) = eye.cross(right).transpose();
    R_screen_.row(2) = eye.transpose();
}

void GravitySphere::paintEvent(QPaintEvent*) {
    const Theme theme = Theme::current();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const double radius = 0.5 * std::min(width(), height()) - 12;
    const QPointF centre(0.5 * width(), 0.5 * height());
    const auto place = [&](const Vector3d& direction) {
        const Vector3d p = R_screen_ * direction;
        return QPointF(centre.x() + radius * p.x(), centre.y() - radius * p.y());
    };
    const auto isInFront = [&](const Vector3d& direction) { return (R_screen_ * direction).z() >= 0; };

    QRadialGradient shade(centre - QPointF(0.3 * radius, 0.35 * radius), 1.5 * radius);
    shade.setColorAt(0, theme.isDark ? QColor("#39404d") : QColor("#ffffff"));
    shade.setColorAt(1, theme.isDark ? QColor("#1d2129") : QColor("#d6dae2"));
    painter.setPen(QPen(theme.line, 1.5));
    painter.setBrush(shade);
    painter.drawEllipse(centre, radius, radius);

    // The module's own axes as great circles, to give the sphere a feel of turning.
    painter.setBrush(Qt::NoBrush);
    for (int axis = 0; axis < 3; ++axis) {
        QPainterPath front;
        bool isDrawing = false;
        for (int i = 0; i <= 72; ++i) {
            const double angle = i * 5 * kDegree;
            Vector3d p = Vector3d::Zero();
            p[(axis + 1) % 3] = std::cos(angle);
            p[(axis + 2) % 3] = std::sin(angle);
            if (!isInFront(p)) {
                isDrawing = false;
                continue;
            }
            isDrawing ? front.lineTo(place(p)) : front.moveTo(place(p));
            isDrawing = true;
        }
        painter.setPen(QPen(theme.line, 1));
        painter.drawPath(front);
    }
    for (const Vector3d& direction : covered_) {
        const bool front = isInFront(direction);
        painter.setPen(QPen(theme.good, 1.5));
        painter.setBrush(front ? QBrush(theme.good) : QBrush(Qt::NoBrush));
        painter.setOpacity(front ? 1 : 0.4);
        painter.drawEllipse(place(direction), 5, 5);
    }
    painter.setOpacity(1);
    if (current_ && target_) {
        QPainterPath way;
        const auto points = arcBetween(*current_, *target_);
        way.moveTo(place(points.front()));
        for (const Vector3d& point : points)
            way.lineTo(place(point));
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(theme.attention, 2.5, Qt::DashLine));
        painter.drawPath(way);
        const QPointF tip = place(points.back());
        const QPointF before = place(points[points.size() - 4]);
        const double angle = std::atan2(tip.y() - before.y(), tip.x() - before.x());
        painter.setPen(Qt::NoPen);
        painter.setBrush(theme.attention);
        const auto corner = [&](double turn) {
            return tip - QPointF(13 * std::cos(angle + turn), 13 * std::sin(angle + turn));
        };
        painter.drawPolygon(QPolygonF{tip, corner(0.45), corner(-0.45)});
    }
    if (target_) {
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(theme.attention, 3));
        painter.drawEllipse(place(*target_), 14, 14);
    }
    if (current_) {
        painter.setPen(QPen(theme.isDark ? Qt::black : Qt::white, 1.5));
        painter.setBrush(theme.text);
        painter.drawEllipse(place(*current_), 8, 8);
    }
}

}  // namespace skincal
