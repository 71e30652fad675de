#pragma once

#include <QImage>
#include <QPolygonF>
#include <QWidget>
#include <optional>
#include <vector>

#include "core/geometry/ids.h"
#include "ui/widgets/module_keys.h"

namespace skincal {

/// A mark on a picture.
struct PictureMark {
    QPointF pixel;
    QColor colour;
    std::optional<ModuleId> module{};   ///< what a click on it selects
    bool isCrossed = false;             ///< what does not count
    bool isNamed = false;               ///< with the module's number beside it where no other mark is near
    std::optional<QPointF> expected{};  ///< where the body has it; a line leads there
    double radius = 7;                  ///< of its ring, on the screen
};

/// An outline on a picture, under the marks.
struct PictureShape {
    QPolygonF outline;  ///< px, closed by itself
    QColor colour;
    ModuleId module;
    bool isDim = false;  ///< drawn faintly and broken: what the picture can't show
};

/// A camera's picture, as large as the widget allows, with marks that can be clicked. The wheel zooms, a drag shifts.
/// Keys: arrows go from mark to mark, or shift where there is none to choose; Return or Space does what a click does;
/// + and - zoom, 0 shows all.
class PictureView : public QWidget {
    Q_OBJECT
  public:
    explicit PictureView(QWidget* parent = nullptr);

    void setImage(const QImage& image);
    [[nodiscard]] const QImage& image() const { return image_; }
    void setMarks(std::vector<PictureMark> marks);
    [[nodiscard]] const std::vector<PictureMark>& marks() const { return marks_; }
    void setShapes(std::vector<PictureShape> shapes);
    [[nodiscard]] const std::vector<PictureShape>& shapes() const { return shapes_; }
    void setSelected(std::optional<ModuleId> module);
    /// What stands in the middle while there is no picture.
    void setPlaceholder(const QString& text);

    /// Where a pixel is drawn; pixel (0, 0) is the centre of the top-left one.
    [[nodiscard]] QPointF toWidget(const QPointF& pixel) const;
    /// Where the keys are.
    [[nodiscard]] std::optional<ModuleId> current() const { return current_; }
    [[nodiscard]] double zoom() const { return zoom_; }

    [[nodiscard]] QSize sizeHint() const override { return {640, 360}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {240, 140}; }

  signals:
    void markClicked(skincal::ModuleId module);

  protected:
    void paintEvent(QPaintEvent* event) override;
    void wheelEvent(QWheelEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;

  private:
    [[nodiscard]] QTransform transform() const;
    [[nodiscard]] bool hasRoom(const PictureMark& mark) const;
    void paintShapes(QPainter& painter) const;
    void paintFocus(QPainter& painter) const;
    /// What a click can choose.
    [[nodiscard]] std::vector<ModulePlace> places() const;
    void setCurrent(std::optional<ModuleId> module);
    void zoomAbout(const QPointF& position, double factor);
    void shiftBy(const QPointF& way);
    void showAll();
    /// The rest of keyPressEvent.
    [[nodiscard]] bool moveByKey(int key);

    QImage image_;
    std::vector<PictureMark> marks_;
    std::vector<PictureShape> shapes_;
    std::optional<ModuleId> selected_;
    std::optional<ModuleId> current_;
    QString placeholder_;
    double zoom_ = 1;
    QPointF shift_;
    QPointF pressedAt_;
    bool isDragging_ = false;
};

}  // namespace skincal
