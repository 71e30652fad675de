#pragma once

#include <QWidget>

#include "core/vision/picture_figures.h"

namespace skincal {

/// How bright the pixels of a picture are; what is clipped at either end stands out.
class HistogramView : public QWidget {
    Q_OBJECT
  public:
    explicit HistogramView(QWidget* parent = nullptr);

    void setFigures(const PictureFigures& figures);

    [[nodiscard]] QSize sizeHint() const override { return {260, 110}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {140, 70}; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    PictureFigures figures_;
};

}  // namespace skincal
