#include "ui/widgets/curve_plot.h"

#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

#include "ui/widgets/theme.h"

namespace skincal {

CurvePlot::CurvePlot(QWidget* parent) : QWidget(parent) {}

void CurvePlot::setTitle(const QString& title) {
    title_ = title;
    setAccessibleName(title);
}

void CurvePlot::setAbscissa(const QString& text) {
    abscissa_ = text;
}

void CurvePlot::setUnit(const QString& unit) {
    unit_ = unit;
}

void CurvePlot::setValues(std::vector<std::optional<double>> values) {
    values_ = std::move(values);
    update();
}

void CurvePlot::setGoal(std::optional<double> goal, const QString& meaning) {
    goal_ = goal;
    goalText_ = meaning;
    update();
}

void CurvePlot::paintEvent(QPaintEvent*) {
    const Theme theme = Theme::current();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const QFontMetrics metrics(font());
    const int line = metrics.height();
    painter.setPen(theme.muted);
    painter.drawText(0, line - metrics.descent(), title_);
    const QRectF plot(44, line + 8, width() - 54, height() - 2 * line - 22);

    double low = goal_.value_or(1);
    double high = low;
    std::optional<double> newest;
    for (const auto& value : values_) {
        if (!value)
            continue;
        newest = value;
        low = std::min(low, *value);
        high = std::max(high, *value);
    }
    const double bottom = std::floor(std::log10(low) - 0.01);
    const double top = std::max(bottom + 1, std::ceil(std::log10(high) + 0.01));
    const auto y = [&](double value) {
        return plot.bottom() - (std::log10(value) - bottom) / (top - bottom) * plot.height();
    };
    const auto count = std::max<std::size_t>(6, values_.size());
    const auto x = [&](std::size_t i) {
        return plot.left() + plot.width() * static_cast<double>(i) / static_cast<double>(count - 1);
    };
    for (double decade = bottom; decade <= top + 0.5; ++decade) {
        const double at = y(std::pow(10, decade));
        painter.setPen(QPen(theme.line, 1));
        painter.drawLine(QPointF(plot.left(), at), QPointF(plot.right(), at));
        painter.setPen(theme.muted);
        painter.drawText(QRectF(0, at - line, 40, 2 * line), Qt::AlignRight | Qt::AlignVCenter,
                         QString::number(std::pow(10, decade)) + unit_);
    }
    painter.drawText(QRectF(plot.left(), plot.bottom() + 4, plot.width(), line), Qt::AlignCenter, abscissa_);
    if (goal_) {
        painter.setPen(QPen(theme.attention, 1.5, Qt::DashLine));
        painter.drawLine(QPointF(plot.left(), y(*goal_)), QPointF(plot.right(), y(*goal_)));
        painter.drawText(QRectF(plot.left(), y(*goal_) - line - 2, plot.width(), line),
                         Qt::AlignRight | Qt::AlignBottom, goalText_);
    }
    QPainterPath path;
    bool isDrawing = false;
    for (std::size_t i = 0; i < values_.size(); ++i) {
        if (!values_[i])
            continue;
        const QPointF point(x(i), y(*values_[i]));
        isDrawing ? path.lineTo(point) : path.moveTo(point);
        isDrawing = true;
        painter.setPen(Qt::NoPen);
        painter.setBrush(theme.good);
        painter.drawEllipse(point, 3.5, 3.5);
    }
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(theme.good, 2));
    painter.drawPath(path);
    if (newest) {
        QFont bold = font();
        bold.setBold(true);
        painter.setFont(bold);
        painter.setPen(theme.text);
        painter.drawText(QRectF(0, 0, width() - 4, line + 4), Qt::AlignRight, QString::number(*newest, 'g', 2) + unit_);
    }
}

}  // namespace skincal
