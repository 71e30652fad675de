#include "ui/scene3d/scene_overlay.h"

#include <vtkCamera.h>
#include <vtkMatrix4x4.h>

#include <QFontMetricsF>
#include <QLinearGradient>
#include <QPainter>
#include <algorithm>
#include <cmath>

#include "ui/scene3d/colour_map.h"

namespace skincal {
namespace {

constexpr double kPadding = 9;
// Of the legend, in heights of its letters.
constexpr double kLine = 1.35;
constexpr double kSwatch = 0.75;
constexpr double kSwatchGap = 7;

bool hasBar(const Legend& legend) {
    return !legend.low.isEmpty() || !legend.high.isEmpty();
}

QColor toQt(const Rgb& colour) {
    return {colour[0], colour[1], colour[2]};
}

}  // namespace

SceneOverlay::SceneOverlay(vtkCamera& camera, QWidget* parent) : QWidget(parent), camera_(camera) {
    setAttribute(Qt::WA_TransparentForMouseEvents);
    setAttribute(Qt::WA_NoSystemBackground);
    setFocusPolicy(Qt::NoFocus);
}

void SceneOverlay::setContent(OverlayContent content) {
    content_ = std::move(content);
    update();
}

QColor SceneOverlay::ink() const {
    return content_.dark ? QColor(234, 236, 240) : QColor(33, 36, 43);
}

QColor SceneOverlay::softInk() const {
    return content_.dark ? QColor(172, 178, 188) : QColor(88, 94, 106);
}

QColor SceneOverlay::ground() const {
    return content_.dark ? QColor(24, 27, 32, 205) : QColor(255, 255, 255, 215);
}

std::optional<QPointF> SceneOverlay::project(const Vector3d& point) const {
    if (width() <= 0 || height() <= 0)
        return std::nullopt;
    const double aspect = static_cast<double>(width()) / height();
    const double in[] = {point.x(), point.y(), point.z(), 1};
    double out[4];
    camera_.GetCompositeProjectionTransformMatrix(aspect, -1, 1)->MultiplyPoint(in, out);
    if (out[3] <= 0)
        return std::nullopt;
    return QPointF(0.5 * (1 + out[0] / out[3]) * width(), 0.5 * (1 - out[1] / out[3]) * height());
}

void SceneOverlay::paintEvent(QPaintEvent* /*event*/) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setFont(font());
    if (content_.focus) {
        painter.setPen(QPen(content_.dark ? QColor(99, 179, 255) : QColor(20, 104, 200), 2));
        painter.drawRect(QRectF(rect()).adjusted(1, 1, -1, -1));
    }
    if (!content_.empty.isEmpty()) {
        paintEmpty(painter);
        return;
    }
    paintMeasure(painter);
    paintLabels(painter);
    paintAxes(painter);
    paintScale(painter);
    paintCaption(painter);
    paintLegend(painter);
}

void SceneOverlay::paintEmpty(QPainter& painter) const {
    // Three cells in outline say what is going to be here before anyone has read a word.
    const double size = std::min(width(), height()) / 14.0;
    const QPointF middle(width() / 2.0, height() / 2.0 - 1.2 * size);
    QColor line = softInk();
    line.setAlpha(130);
    painter.setPen(QPen(line, 2, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
    const double pitch = 2.15 * size * std::cos(30 * kDegree);
    for (int cell = 0; cell < 3; ++cell) {
        const QPointF centre = middle + QPointF((cell - 1) * 0.5 * pitch * (cell == 1 ? 0 : 1),
                                                (cell == 1 ? -1 : 0) * pitch * std::sin(60 * kDegree));
        QPolygonF hexagon;
        for (int k = 0; k < 6; ++k) {
            const double angle = (60 * k + 30) * kDegree;
            hexagon << centre + size * QPointF(std::cos(angle), std::sin(angle));
        }
        painter.drawPolygon(hexagon);
    }
    painter.setPen(softInk());
    painter.drawText(QRectF(0.1 * width(), middle.y() + 2.1 * size, 0.8 * width(), 0.4 * height()),
                     Qt::AlignHCenter | Qt::AlignTop | Qt::TextWordWrap, content_.empty);
}

void SceneOverlay::paintCaption(QPainter& painter) const {
    if (content_.caption.isEmpty())
        return;
    // Between axes and scale bar, so that neither is covered.
    const double side = std::max(120.0, 0.18 * width());
    const QRectF room(side, 0, std::max(80.0, width() - 2 * side), height());
    const QFontMetricsF metrics(painter.font());
    const QRectF text = metrics.boundingRect(room, Qt::AlignHCenter | Qt::TextWordWrap, content_.caption);
    QRectF box(0, 0, text.width() + 2 * kPadding, text.height() + kPadding);
    box.moveCenter(QPointF(width() / 2.0, 0));
    box.moveBottom(height() - kMargin);
    painter.setPen(Qt::NoPen);
    painter.setBrush(ground());
    painter.drawRoundedRect(box, 6, 6);
    painter.setPen(ink());
    painter.drawText(box, Qt::AlignCenter | Qt::TextWordWrap, content_.caption);
}

QSizeF SceneOverlay::legendSize() const {
    const Legend& legend = content_.legend;
    QFont bold = font();
    bold.setBold(true);
    const QFontMetricsF metrics(font());
    const double line = kLine * metrics.height();
    double width = QFontMetricsF(bold).horizontalAdvance(legend.title);
    double height = legend.title.isEmpty() ? 0 : line;
    for (const auto* entries : {&legend.entries, &legend.more}) {
        for (const LegendEntry& entry : *entries) {
            width = std::max(width, kSwatch * metrics.height() + kSwatchGap + metrics.horizontalAdvance(entry.text));
            height += line;
        }
    }
    if (hasBar(legend)) {
        width = std::max({width, 130.0, metrics.horizontalAdvance(legend.low + "      " + legend.high)});
        height += 1.8 * line;
    }
    return height > 0 ? QSizeF(width + 2 * kPadding, height + 1.4 * kPadding) : QSizeF(0, 0);
}

void SceneOverlay::paintLegend(QPainter& painter) const {
    const Legend& legend = content_.legend;
    const QSizeF size = legendSize();
    if (size.isEmpty())
        return;
    QFont bold = font();
    bold.setBold(true);
    const double letters = QFontMetricsF(font()).height();
    const double line = kLine * letters;
    const double swatch = kSwatch * letters;
    const double width = size.width() - 2 * kPadding;
    const QRectF box(QPointF(kMargin, kMargin), size);
    painter.setPen(Qt::NoPen);
    painter.setBrush(ground());
    painter.drawRoundedRect(box, 6, 6);

    QRectF row(box.left() + kPadding, box.top() + 0.7 * kPadding, width, line);
    if (!legend.title.isEmpty()) {
        painter.setFont(bold);
        painter.setPen(ink());
        painter.drawText(row, Qt::AlignLeft | Qt::AlignVCenter, legend.title);
        painter.setFont(font());
        row.translate(0, line);
    }
    const auto drawEntries = [&](const std::vector<LegendEntry>& entries) {
        for (const LegendEntry& entry : entries) {
            double left = row.left();
            if (entry.colour.isValid()) {
                painter.setPen(Qt::NoPen);
                painter.setBrush(entry.colour);
                painter.drawRoundedRect(QRectF(left, row.center().y() - swatch / 2, swatch, swatch), 2.5, 2.5);
                left += swatch + kSwatchGap;
            }
            painter.setPen(entry.colour.isValid() ? ink() : softInk());
            painter.drawText(QRectF(left, row.top(), width, line), Qt::AlignLeft | Qt::AlignVCenter, entry.text);
            row.translate(0, line);
        }
    };
    drawEntries(legend.entries);
    if (hasBar(legend)) {
        const QRectF strip(row.left(), row.top() + 0.2 * line, width, 0.55 * line);
        QLinearGradient gradient(strip.topLeft(), strip.topRight());
        for (int i = 0; i <= 16; ++i)
            gradient.setColorAt(
                i / 16.0, toQt(legend.isDiverging ? divergingColour(i / 16.0) : valueColour(i / 16.0, content_.dark)));
        painter.setPen(Qt::NoPen);
        painter.setBrush(gradient);
        painter.drawRoundedRect(strip, 2.5, 2.5);
        row.translate(0, 0.8 * line);
        painter.setPen(ink());
        painter.drawText(row, Qt::AlignLeft | Qt::AlignVCenter, legend.low);
        painter.drawText(row, Qt::AlignRight | Qt::AlignVCenter, legend.high);
        if (legend.isDiverging)
            painter.drawText(row, Qt::AlignCenter, QStringLiteral("0"));
        row.translate(0, line);
    }
    drawEntries(legend.more);
}

void SceneOverlay::paintLabels(QPainter& painter) const {
    const QFontMetricsF metrics(painter.font());
    for (const SceneLabel& label : content_.labels) {
        const auto at = project(label.where);
        if (!at || !QRectF(rect()).contains(*at))
            continue;
        QRectF box(0, 0, metrics.horizontalAdvance(label.text) + 10, metrics.height() + 4);
        box.moveCenter(*at + QPointF(0, label.below_px));
        // Words at the edge stay whole.
        box.moveLeft(std::clamp(box.left(), 3.0, std::max(3.0, width() - 3 - box.width())));
        painter.setPen(Qt::NoPen);
        QColor behind = ground();
        behind.setAlpha(label.strong ? 235 : 150);
        painter.setBrush(behind);
        painter.drawRoundedRect(box, 5, 5);
        painter.setPen(label.strong ? ink() : softInk());
        painter.drawText(box, Qt::AlignCenter, label.text);
    }
}

}  // namespace skincal
