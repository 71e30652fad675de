#pragma once

#include <QImage>
#include <QWidget>
#include <optional>

namespace skincal {

/// A few pixels of a picture, so large that each can be seen, with what was made of them drawn over it. Sharp on every
/// screen: pixels are drawn as squares of the screen's own dots.
class SpotCrop : public QWidget {
    Q_OBJECT
  public:
    explicit SpotCrop(const QString& name, QWidget* parent = nullptr);

    /// In pixels of the crop, the middle of its first pixel being (0, 0).
    struct Marks {
        std::optional<QPointF> centre{};     ///< a cross
        double width_px = 0;                 ///< radius of a circle about it; 0 for none
        std::optional<QPointF> predicted{};  ///< a diamond: where the body has it
    };
    void setPicture(const QImage& picture);
    void setMarks(const Marks& marks);
    void clear();
    [[nodiscard]] bool isEmpty() const { return picture_.isNull(); }
    [[nodiscard]] const Marks& marks() const { return marks_; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    QImage picture_;
    Marks marks_;
};

}  // namespace skincal
