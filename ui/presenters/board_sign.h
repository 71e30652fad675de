#pragma once

#include <QColor>
#include <QImage>
#include <QPointF>
#include <cstddef>

class QPainter;

namespace skincal {

/// By what a calibration board is known in list and plots: one of eight colours that the colour-blind tell apart, and
/// after those another shape. No two of the first 32 are alike.
struct BoardSign {
    enum class Shape { Disc, Square, Triangle, Diamond };

    QColor colour;
    Shape shape = Shape::Disc;
};

[[nodiscard]] BoardSign boardSign(std::size_t board);

/// Filled with the painter's brush; all shapes take about as much room.
void paintShape(QPainter& painter, BoardSign::Shape shape, const QPointF& centre, double radius);

/// The sign alone, for lists; sharp on screens with twice as many pixels, too.
[[nodiscard]] QImage pictureOf(const BoardSign& sign);

}  // namespace skincal
