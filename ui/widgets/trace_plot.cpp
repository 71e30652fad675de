#include "ui/widgets/trace_plot.h"

#include <QLocale>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

#include "ui/widgets/theme.h"

namespace skincal {
namespace {

constexpr double kJoined_s = 0.5;

/// 1, 2 or 5 times a power of ten, so that about `steps` of them fill the range.
double roundStep(double range, double steps) {
    const double raw = range / steps;
    const double decade = std::pow(10, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (factor * decade >= raw - 1e-12)
            return factor * decade;
    }
    return 10 * decade;
}

}  // namespace

TracePlot::TracePlot(QWidget* parent) : QWidget(parent) {
    setCursor(Qt::CrossCursor);
}

void TracePlot::setScale(double low, double high) {
    low_ = low;
    high_ = high;
    update();
}

void TracePlot::setSpan(double seconds) {
    span_ = seconds;
    update();
}

void TracePlot::setLines(std::vector<Line> lines) {
    lines_ = std::move(lines);
    QStringList words;
    for (const Line& line : lines_)
        words << line.name + u' ' + line.value;
    setAccessibleDescription(words.isEmpty() ? placeholder_ : words.join(QStringLiteral(", ")));
    update();
}

void TracePlot::setPlaceholder(const QString& text) {
    placeholder_ = text;
    update();
}

void TracePlot::setShown(std::optional<double> ago) {
    shown_ = ago;
    update();
}

QRectF TracePlot::plotArea() const {
    const int line = fontMetrics().height();
    const double wide = width() - kLeft - kRight;
    const double top = 0.5 * line + 2;
    return {1.0 * kLeft, top, std::max(10.0, wide), std::max(10.0, height() - top - line - 8)};
}

std::size_t TracePlot::columns() const {
    return static_cast<std::size_t>(std::max(10.0, plotArea().width() / 2));
}

void TracePlot::ask(const QPointF& position) {
    const QRectF plot = plotArea();
    emit momentAsked(span_ * std::clamp((plot.right() - position.x()) / plot.width(), 0.0, 1.0));
}

void TracePlot::mousePressEvent(QMouseEvent* event) {
    if (event->button() == Qt::LeftButton)
        ask(event->position());
}

void TracePlot::mouseMoveEvent(QMouseEvent* event) {
    if (event->buttons().testFlag(Qt::LeftButton))
        ask(event->position());
}

void TracePlot::paintAxes(QPainter& painter, const QRectF& plot, double low, double high) const {
    const Theme theme = Theme::current();
    const int line = fontMetrics().height();
    const double step = roundStep(high - low, std::clamp(plot.height() / 34, 2.0, 5.0));
    for (double value = std::ceil(low / step - 1e-9) * step; value <= high + 1e-9 * step; value += step) {
        const double y = plot.bottom() - (value - low) / (high - low) * plot.height();
        painter.setPen(QPen(theme.line, 1));
        painter.drawLine(QPointF(plot.left(), y), QPointF(plot.right(), y));
        painter.setPen(theme.muted);
        painter.drawText(QRectF(0, y - line, kLeft - 6, 2 * line), Qt::AlignRight | Qt::AlignVCenter,
                         QLocale().toString(std::abs(value) < 1e-9 * step ? 0.0 : value, 'g', 4));
    }
    const double seconds = roundStep(span_, std::clamp(plot.width() / 90, 2.0, 6.0));
    for (double ago = 0; ago <= span_ + 1e-9; ago += seconds) {
        const double x = plot.right() - ago / span_ * plot.width();
        painter.setPen(QPen(theme.line, 1));
        painter.drawLine(QPointF(x, plot.bottom()), QPointF(x, plot.bottom() + 3));
        painter.setPen(theme.muted);
        const QString text = ago == 0 ? tr("newest") : tr("−%1 s").arg(QLocale().toString(ago, 'g', 3));
        painter.drawText(QRectF(x - 60, plot.bottom() + 4, 120, line), Qt::AlignCenter, text);
    }
}

void TracePlot::paintLine(QPainter& painter, const QRectF& plot, const Line& line, double low, double high) const {
    const double wide = plot.width() / static_cast<double>(std::max<std::size_t>(1, line.ranges.size()));
    const auto y = [&](float value) {
        return plot.bottom() - (static_cast<double>(value) - low) / (high - low) * plot.height();
    };
    const double joined = std::max(1.5, kJoined_s / span_ * static_cast<double>(line.ranges.size()));
    QPainterPath path;
    double last = -1e9;
    for (std::size_t i = 0; i < line.ranges.size(); ++i) {
        const auto [least, most] = line.ranges[i];
        if (std::isnan(least))
            continue;
        const auto at = static_cast<double>(i);
        const double x = plot.left() + (at + 0.5) * wide;
        // By way of the nearer end: a peak shows at its full height, and noise is no zigzag.
        const bool isFalling = at - last <= joined && path.currentPosition().y() < 0.5 * (y(least) + y(most));
        const float first = isFalling ? most : least;
        at - last > joined ? path.moveTo(x, y(first)) : path.lineTo(x, y(first));
        if (y(least) - y(most) > 1)
            path.lineTo(x, y(isFalling ? least : most));
        last = at;
    }
    QPen pen(line.colour, 1.8);
    pen.setJoinStyle(Qt::RoundJoin);
    painter.setPen(pen);
    painter.setBrush(Qt::NoBrush);
    painter.drawPath(path);
}

void TracePlot::paintNames(QPainter& painter, const QRectF& plot) const {
    const Theme theme = Theme::current();
    const int line = fontMetrics().height();
    double y = plot.top();
    QFont bold = font();
    bold.setBold(true);
    for (const Line& each : lines_) {
        painter.setPen(QPen(each.colour, 3));
        painter.drawLine(QPointF(plot.right() + 10, y + line / 2.0), QPointF(plot.right() + 28, y + line / 2.0));
        painter.setPen(theme.text);
        painter.drawText(QRectF(plot.right() + 34, y, kRight - 34, line), Qt::AlignLeft | Qt::AlignVCenter, each.name);
        painter.setFont(bold);
        painter.drawText(QRectF(plot.right() + 34, y, kRight - 36, line), Qt::AlignRight | Qt::AlignVCenter,
                         each.value);
        painter.setFont(font());
        y += line + 6;
    }
}

void TracePlot::paintEvent(QPaintEvent*) {
    const Theme theme = Theme::current();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QRectF plot = plotArea();
    double low = low_;
    double high = high_;
    for (const Line& line : lines_) {
        for (const auto& [least, most] : line.ranges) {
            if (std::isnan(least))
                continue;
            low = std::min(low, static_cast<double>(least));
            high = std::max(high, 1.05 * static_cast<double>(most));
        }
    }
    paintAxes(painter, plot, low, high);
    if (lines_.empty()) {
        painter.setPen(theme.muted);
        painter.drawText(plot.adjusted(8, 0, -8, 0), Qt::AlignCenter | Qt::TextWordWrap, placeholder_);
    }
    painter.save();
    painter.setClipRect(plot.adjusted(0, -2, 0, 2));
    for (const Line& line : lines_)
        paintLine(painter, plot, line, low, high);
    painter.restore();
    if (shown_) {
        const double x = plot.right() - *shown_ / span_ * plot.width();
        painter.setPen(QPen(theme.attention, 1.5, Qt::DashLine));
        painter.drawLine(QPointF(x, plot.top() - 3), QPointF(x, plot.bottom()));
    }
    paintNames(painter, plot);
}

}  // namespace skincal
