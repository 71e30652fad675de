#pragma once

#include "ui/widgets/picture_view.h"

namespace skincal {

/// A camera's picture with the calibration board that is seen in it, and a map of where boards have been.
class BoardPicture : public PictureView {
    Q_OBJECT
  public:
    explicit BoardPicture(QWidget* parent = nullptr);

    /// How many corners of kept boards each cell has, by rows from the top left.
    void setCoverage(int columns, int rows, std::vector<int> counts);
    /// Corners of the board in this very picture, and what to mark them with; none where none is seen.
    void setCorners(std::vector<QPointF> pixels, const QColor& colour);
    /// Those of a board that was taken before; none for none.
    void setChosen(std::vector<QPointF> pixels, const QColor& colour);

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    void paintCoverage(QPainter& painter) const;

    int columns_ = 1;
    int rows_ = 1;
    std::vector<int> counts_;
    std::vector<QPointF> corners_, chosen_;
    QColor cornerColour_, chosenColour_;
};

}  // namespace skincal
