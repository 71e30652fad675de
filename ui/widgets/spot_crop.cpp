#include "ui/widgets/spot_crop.h"

#include <QPainter>

#include "ui/widgets/theme.h"

namespace skincal {
namespace {

/// On a picture, which is dark whatever the theme; told apart by shape, too.
const QColor kFitted("#56c8ff");
const QColor kPredicted("#ffb020");

/// Seen on dark and on bright pixels alike.
template <class Draw>
void outlined(QPainter& painter, const QColor& colour, const Draw& draw) {
    painter.setPen(QPen(QColor(0, 0, 0, 160), 3));
    draw();
    painter.setPen(QPen(colour, 1.4));
    draw();
}

}  // namespace

SpotCrop::SpotCrop(const QString& name, QWidget* parent) : QWidget(parent) {
    setAccessibleName(name);
}

void SpotCrop::setPicture(const QImage& picture) {
    picture_ = picture;
    update();
}

void SpotCrop::setMarks(const Marks& marks) {
    marks_ = marks;
    update();
}

void SpotCrop::clear() {
    picture_ = {};
    marks_ = {};
    update();
}

void SpotCrop::paintEvent(QPaintEvent*) {
    const Theme theme = Theme::current();
    QPainter painter(this);
    painter.setPen(QPen(theme.line, 1));
    painter.setBrush(theme.panel);
    painter.drawRect(rect().adjusted(0, 0, -1, -1));
    if (picture_.isNull())
        return;
    const QRectF area = QRectF(rect()).adjusted(2, 2, -2, -2);
    painter.drawImage(area, picture_);  // not smooth: pixels stay squares
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setClipRect(area);
    painter.setBrush(Qt::NoBrush);
    const double scale = area.width() / picture_.width();
    const auto onScreen = [&](const QPointF& pixel) { return area.topLeft() + (pixel + QPointF(0.5, 0.5)) * scale; };
    if (marks_.predicted) {
        const QPointF at = onScreen(*marks_.predicted);
        constexpr double kSide = 11;  // about the cross
        outlined(painter, kPredicted, [&] {
            painter.drawPolygon(QPolygonF{
                {at + QPointF(0, -kSide), at + QPointF(kSide, 0), at + QPointF(0, kSide), at + QPointF(-kSide, 0)}});
        });
    }
    if (marks_.centre) {
        const QPointF at = onScreen(*marks_.centre);
        constexpr double kArm = 8;
        constexpr double kGap = 2;
        outlined(painter, kFitted, [&] {
            for (const QPointF& way : {QPointF(1, 0), QPointF(-1, 0), QPointF(0, 1), QPointF(0, -1)})
                painter.drawLine(at + kGap * way, at + kArm * way);
            if (marks_.width_px > 0)
                painter.drawEllipse(at, marks_.width_px * scale, marks_.width_px * scale);
        });
    }
}

}  // namespace skincal
