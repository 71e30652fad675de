#include "ui/presenters/board_sign.h"

#include <QPainter>

#include "ui/palette.h"

namespace skincal {

BoardSign boardSign(std::size_t board) {
    constexpr std::size_t kShapes = 4;
    return {QColor::fromRgb(kKinds.at(board % kKinds.size())),
            static_cast<BoardSign::Shape>(board / kKinds.size() % kShapes)};
}

void paintShape(QPainter& painter, BoardSign::Shape shape, const QPointF& centre, double radius) {
    // What has corners reaches farther for as much ink.
    const double r = 1.25 * radius;
    switch (shape) {
        case BoardSign::Shape::Disc:
            painter.drawEllipse(centre, radius, radius);
            return;
        case BoardSign::Shape::Square:
            painter.drawRect(QRectF(centre - QPointF(0.9 * radius, 0.9 * radius), QSizeF(1.8 * radius, 1.8 * radius)));
            return;
        case BoardSign::Shape::Triangle:
            painter.drawPolygon(
                QPolygonF{centre + QPointF(0, -r), centre + QPointF(r, 0.8 * r), centre + QPointF(-r, 0.8 * r)});
            return;
        case BoardSign::Shape::Diamond:
            painter.drawPolygon(QPolygonF{centre + QPointF(0, -r), centre + QPointF(r, 0), centre + QPointF(0, r),
                                          centre + QPointF(-r, 0)});
            return;
    }
}

QImage pictureOf(const BoardSign& sign) {
    constexpr int kSize = 16;
    constexpr int kRatio = 2;
    QImage image(kRatio * kSize, kRatio * kSize, QImage::Format_ARGB32_Premultiplied);
    image.setDevicePixelRatio(kRatio);
    image.fill(Qt::transparent);
    QPainter painter(&image);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(Qt::NoPen);
    painter.setBrush(sign.colour);
    paintShape(painter, sign.shape, QPointF(0.5 * kSize, 0.5 * kSize), 5.5);
    return image;
}

}  // namespace skincal
