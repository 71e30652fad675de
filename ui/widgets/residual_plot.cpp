#include "ui/widgets/residual_plot.h"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "ui/widgets/theme.h"

namespace skincal {
namespace {

/// 1, 2 or 5 times a power of ten, the smallest that is not below.
double roundUp(double value) {
    const double decade = std::pow(10, std::floor(std::log10(value)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * decade >= value * (1 - 1e-9))
            return factor * decade;
    }
    return 10 * decade;
}

}  // namespace

ResidualPlot::ResidualPlot(QWidget* parent) : QWidget(parent) {
    setAccessibleName(tr("Residuals of the corners"));
    setToolTip(
        tr("Where each corner was seen, relative to where the calibrated camera has it. Round and centred is "
           "noise; a cloud beside the middle is a board that was bent or moved."));
}

void ResidualPlot::setClouds(std::vector<Cloud> clouds) {
    clouds_ = std::move(clouds);
    update();
}

void ResidualPlot::setSelected(std::optional<std::size_t> cloud) {
    selected_ = cloud;
    update();
}

void ResidualPlot::setPlaceholder(const QString& text) {
    placeholder_ = text;
    update();
}

/// All but the farthest two of a hundred fit.
double ResidualPlot::reach() const {
    std::vector<double> lengths;
    for (std::size_t i = 0; i < clouds_.size(); ++i) {
        if (!clouds_[i].isUsed && selected_ != i)
            continue;
        for (const QPointF& r : clouds_[i].residuals)
            lengths.push_back(std::hypot(r.x(), r.y()));
    }
    if (lengths.empty())
        return 1;
    const auto place = lengths.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(lengths.size() - 1));
    std::nth_element(lengths.begin(), place, lengths.end());
    return std::clamp(1.15 * *place, 0.01, 1e4);
}

void ResidualPlot::paintEvent(QPaintEvent*) {
    const Theme theme = Theme::current();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(theme.line, 1));
    painter.setBrush(theme.panel);
    painter.drawRoundedRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4);
    if (clouds_.empty()) {
        painter.setPen(theme.muted);
        painter.drawText(rect().adjusted(12, 12, -12, -12), Qt::AlignCenter | Qt::TextWordWrap, placeholder_);
        return;
    }
    painter.setClipRect(rect().adjusted(1, 1, -1, -1));
    const double range = reach();
    const double scale = 0.5 * (std::min(width(), height()) - 8) / range;
    const QPointF middle(0.5 * width(), 0.5 * height());
    painter.setBrush(Qt::NoBrush);
    painter.drawLine(QPointF(0, middle.y()), QPointF(width(), middle.y()));
    painter.drawLine(QPointF(middle.x(), 0), QPointF(middle.x(), height()));
    const double step = roundUp(range / 2.5);
    const double farthest = std::hypot(width(), height()) / (2 * scale);
    for (int ring = 1; ring * step < farthest; ++ring)
        painter.drawEllipse(middle, ring * step * scale, ring * step * scale);
    painter.setPen(Qt::NoPen);
    for (const bool isFront : {false, true}) {
        for (std::size_t i = 0; i < clouds_.size(); ++i) {
            if ((selected_ == i) != isFront)
                continue;
            QColor colour = clouds_[i].sign.colour;
            colour.setAlphaF(!selected_ ? 0.75F : isFront ? 1.0F : 0.18F);
            painter.setBrush(colour);
            const double radius = isFront ? 2.8 : 2;
            for (const QPointF& r : clouds_[i].residuals)
                paintShape(painter, clouds_[i].sign.shape, middle + scale * r, radius);
        }
    }
    painter.setPen(theme.muted);
    painter.drawText(rect().adjusted(8, 5, -8, -5), Qt::AlignTop | Qt::AlignLeft, tr("Residuals"));
    // Written last and on a ground of its own: points are everywhere.
    const QFontMetricsF metrics(font());
    for (int ring = 1; ring * step <= range; ++ring) {
        const QString text = ring == 1 ? tr("%1 px").arg(step) : QString::number(ring * step);
        QRectF place(middle.x() + ring * step * scale + 2, middle.y() + 2, metrics.horizontalAdvance(text) + 4,
                     metrics.height());
        if (place.right() > width() - 2)
            place.moveRight(place.left() - 4);
        QColor ground = theme.panel;
        ground.setAlpha(200);
        painter.fillRect(place, ground);
        painter.setPen(theme.muted);
        painter.drawText(place, Qt::AlignCenter, text);
    }
}

}  // namespace skincal
