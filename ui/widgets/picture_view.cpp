#include "ui/widgets/picture_view.h"

#include <QPainter>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ui/widgets/theme.h"

namespace skincal {

PictureView::PictureView(QWidget* parent) : QWidget(parent) {
    setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Expanding);
    setAccessibleName(tr("Camera picture"));
    setToolTip(tr("What the camera sees. The wheel or + and - zoom, a drag or the arrow keys shift, 0 shows all."));
    setMouseTracking(false);
    setFocusPolicy(Qt::StrongFocus);
}

void PictureView::setImage(const QImage& image) {
    if (image.size() != image_.size()) {
        zoom_ = 1;
        shift_ = {};
    }
    image_ = image;
    update();
}

void PictureView::setMarks(std::vector<PictureMark> marks) {
    marks_ = std::move(marks);
    update();
}

void PictureView::setShapes(std::vector<PictureShape> shapes) {
    shapes_ = std::move(shapes);
    update();
}

void PictureView::setSelected(std::optional<ModuleId> module) {
    selected_ = module;
    update();
}

void PictureView::setPlaceholder(const QString& text) {
    placeholder_ = text;
    update();
}

QTransform PictureView::transform() const {
    if (image_.isNull())
        return {};
    const double fit =
        std::min(static_cast<double>(width()) / image_.width(), static_cast<double>(height()) / image_.height());
    const double scale = fit * zoom_;
    QTransform result;
    result.translate(0.5 * width() + shift_.x(), 0.5 * height() + shift_.y());
    result.scale(scale, scale);
    result.translate(-0.5 * image_.width(), -0.5 * image_.height());
    return result;
}

QPointF PictureView::toWidget(const QPointF& pixel) const {
    return transform().map(pixel + QPointF(0.5, 0.5));
}

void PictureView::paintShapes(QPainter& painter) const {
    for (const PictureShape& shape : shapes_) {
        const QPolygonF outline = transform().map(shape.outline.translated(0.5, 0.5));
        const bool isSelected = selected_ == shape.module;
        QColor line = shape.colour;
        QColor fill = shape.colour;
        line.setAlpha(shape.isDim && !isSelected ? 130 : 255);
        fill.setAlpha(shape.isDim ? 0 : isSelected ? 90 : 40);
        // Dark under light is seen on every ground.
        if (!shape.isDim || isSelected) {
            painter.setBrush(Qt::NoBrush);
            painter.setPen(QPen(QColor(0, 0, 0, 150), isSelected ? 5 : 3));
            painter.drawPolygon(outline);
        }
        painter.setBrush(fill);
        painter.setPen(QPen(line, isSelected ? 3 : 1.5, shape.isDim ? Qt::DotLine : Qt::SolidLine));
        painter.drawPolygon(outline);
    }
}

bool PictureView::hasRoom(const PictureMark& mark) const {
    // A number takes so much; where there are more marks than this, it is crowded anyway.
    constexpr double kName = 30;
    constexpr std::size_t kMany = 300;
    const QPointF at = toWidget(mark.pixel);
    return marks_.size() < kMany && std::none_of(marks_.begin(), marks_.end(), [&](const PictureMark& other) {
               const QPointF way = toWidget(other.pixel) - at;
               return &other != &mark && std::hypot(way.x(), way.y()) < kName;
           });
}

void PictureView::paintEvent(QPaintEvent*) {
    const Theme theme = Theme::current();
    QPainter painter(this);
    painter.setClipRect(rect());
    painter.fillRect(rect(), theme.isDark ? QColor("#111318") : QColor("#e3e6eb"));
    if (image_.isNull()) {
        painter.setPen(theme.muted);
        painter.drawText(rect().adjusted(16, 16, -16, -16), Qt::AlignCenter | Qt::TextWordWrap, placeholder_);
        paintFocus(painter);
        return;
    }
    painter.setRenderHint(QPainter::SmoothPixmapTransform, zoom_ < 4);
    painter.setTransform(transform());
    painter.drawImage(QPointF(0, 0), image_);
    painter.resetTransform();
    painter.setRenderHint(QPainter::Antialiasing);
    paintShapes(painter);
    for (const PictureMark& mark : marks_) {
        const QPointF at = toWidget(mark.pixel);
        const bool isSelected = selected_ && selected_ == mark.module;
        painter.setPen(QPen(mark.colour, isSelected ? 3 : 1.6));
        painter.setBrush(Qt::NoBrush);
        const double radius = isSelected ? 1.5 * mark.radius : mark.radius;
        painter.drawEllipse(at, radius, radius);
        if (mark.isCrossed) {
            painter.drawLine(at + QPointF(-radius, -radius), at + QPointF(radius, radius));
            painter.drawLine(at + QPointF(-radius, radius), at + QPointF(radius, -radius));
        }
        if (mark.expected)
            painter.drawLine(at, toWidget(*mark.expected));
        if (mark.module && (isSelected || (mark.isNamed && hasRoom(mark)) || zoom_ > 1.5)) {
            painter.setPen(mark.colour);
            painter.drawText(at + QPointF(radius + 2, -radius + 4), QString::number(mark.module->value));
        }
    }
    paintFocus(painter);
}

void PictureView::paintFocus(QPainter& painter) const {
    if (!hasFocus())
        return;
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(Theme::current().accent, 2));
    painter.drawRect(rect().adjusted(1, 1, -1, -1));
    for (const ModulePlace& place : places()) {
        if (place.module != current_)
            continue;
        constexpr double kHalf = 15;
        const QRectF box(place.at - QPointF(kHalf, kHalf), QSizeF(2 * kHalf, 2 * kHalf));
        // Light on dark is seen on every ground.
        for (const auto& [colour, width] : {std::pair(QColor(0, 0, 0, 170), 4.0), std::pair(QColor(Qt::white), 1.6)}) {
            painter.setPen(QPen(colour, width));
            painter.drawRoundedRect(box, 4, 4);
        }
        const QString number = QString::number(place.module.value);
        const QRectF ground(box.topRight() + QPointF(3, 0),
                            QSizeF(fontMetrics().horizontalAdvance(number) + 8, fontMetrics().height() + 2));
        painter.fillRect(ground, QColor(0, 0, 0, 190));
        painter.drawText(ground, Qt::AlignCenter, number);
    }
}

}  // namespace skincal
