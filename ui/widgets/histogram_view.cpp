#include "ui/widgets/histogram_view.h"

#include <QPainter>
#include <algorithm>
#include <cmath>

#include "ui/widgets/theme.h"

namespace skincal {

HistogramView::HistogramView(QWidget* parent) : QWidget(parent) {
    setAccessibleName(tr("Histogram of brightness"));
    setToolTip(
        tr("Pixels by brightness, dark on the left, on a logarithmic scale. LEDs should not be clipped (orange)."));
}

void HistogramView::setFigures(const PictureFigures& figures) {
    figures_ = figures;
    update();
}

void HistogramView::paintEvent(QPaintEvent*) {
    const Theme theme = Theme::current();
    QPainter painter(this);
    painter.setPen(QPen(theme.line, 1));
    painter.setBrush(theme.panel);
    painter.drawRect(rect().adjusted(0, 0, -1, -1));
    if (figures_.pixels == 0)
        return;
    const QRectF plot = QRectF(rect()).adjusted(4, 4, -4, -4);
    const double highest = std::log1p(*std::max_element(figures_.histogram.begin(), figures_.histogram.end()));
    const double wide = plot.width() / static_cast<double>(figures_.histogram.size());
    for (std::size_t level = 0; level < figures_.histogram.size(); ++level) {
        const double high = plot.height() * std::log1p(figures_.histogram.at(level)) / highest;
        const bool isClipped = level >= kBrightLevel || level <= kDarkLevel;
        painter.fillRect(QRectF(plot.left() + wide * static_cast<double>(level), plot.bottom() - high,
                                isClipped ? std::max(2.0, wide) : wide + 0.5, high),
                         isClipped ? theme.attention : theme.good);
    }
}

}  // namespace skincal
