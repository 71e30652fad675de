#include "ui/widgets/board_picture.h"

#include <QPainter>
#include <algorithm>

#include "ui/widgets/theme.h"

namespace skincal {

BoardPicture::BoardPicture(QWidget* parent) : PictureView(parent) {
    setAccessibleName(tr("Camera picture with the calibration board"));
    setToolTip(tr("Tinted: where corners of boards that were taken lie. A lens is only known where there were some."));
}

void BoardPicture::setCoverage(int columns, int rows, std::vector<int> counts) {
    columns_ = columns;
    rows_ = rows;
    counts_ = std::move(counts);
    const auto covered = static_cast<int>(std::count_if(counts_.begin(), counts_.end(), [](int n) { return n > 0; }));
    setAccessibleDescription(tr("%1 of %2 parts of the picture covered").arg(covered).arg(columns * rows));
    update();
}

void BoardPicture::setCorners(std::vector<QPointF> pixels, const QColor& colour) {
    corners_ = std::move(pixels);
    cornerColour_ = colour;
    update();
}

void BoardPicture::setChosen(std::vector<QPointF> pixels, const QColor& colour) {
    chosen_ = std::move(pixels);
    chosenColour_ = colour;
    update();
}

void BoardPicture::paintEvent(QPaintEvent* event) {
    PictureView::paintEvent(event);
    if (image().isNull())
        return;
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    paintCoverage(painter);
    const auto dots = [&](const std::vector<QPointF>& pixels, const QColor& colour, double radius) {
        // A dark rim keeps them apart from white squares.
        painter.setPen(QPen(QColor(0, 0, 0, 170), 1));
        painter.setBrush(colour);
        for (const QPointF& pixel : pixels)
            painter.drawEllipse(toWidget(pixel), radius, radius);
    };
    dots(chosen_, chosenColour_, 3);
    dots(corners_, cornerColour_, 4);
}

void BoardPicture::paintCoverage(QPainter& painter) const {
    if (counts_.size() != static_cast<std::size_t>(columns_ * rows_))
        return;
    const QRectF picture(toWidget({-0.5, -0.5}), toWidget({image().width() - 0.5, image().height() - 0.5}));
    const double w = picture.width() / columns_;
    const double h = picture.height() / rows_;
    // The picture's own brightness does not follow the theme: nor do these.
    const QColor covered = Theme::dark().good;
    constexpr double kMost = 12;  // corners from which on a cell is as tinted as can be
    for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
            const int count = counts_[static_cast<std::size_t>(row * columns_ + column)];
            if (count == 0)
                continue;
            QColor tint = covered;
            tint.setAlphaF(static_cast<float>(0.10 + 0.18 * std::min(1.0, count / kMost)));
            painter.fillRect(QRectF(picture.left() + w * column, picture.top() + h * row, w, h), tint);
        }
    }
    painter.setPen(QPen(QColor(255, 255, 255, 45), 1));
    for (int column = 1; column < columns_; ++column)
        painter.drawLine(QPointF(picture.left() + w * column, picture.top()),
                         QPointF(picture.left() + w * column, picture.bottom()));
    for (int row = 1; row < rows_; ++row)
        painter.drawLine(QPointF(picture.left(), picture.top() + h * row),
                         QPointF(picture.right(), picture.top() + h * row));
}

}  // namespace skincal
