#pragma once

#include <QWidget>
#include <optional>
#include <vector>

namespace skincal {

/// A few values over the last seconds, each in a colour of its own and with its name and number beside it. Each value
/// is a range, so that short peaks are seen however narrow the plot is. A click asks for a moment.
class TracePlot : public QWidget {
    Q_OBJECT
  public:
    struct Line {
        QString name;
        QString value;  ///< at the moment that is shown
        QColor colour;
        std::vector<std::pair<float, float>> ranges;  ///< the newest last; NaN where nothing is known
    };

    /// Beside the curves: numbers of the scale, and names, px.
    static constexpr int kLeft = 44;
    static constexpr int kRight = 176;

    explicit TracePlot(QWidget* parent = nullptr);

    /// The values at the bottom and the top; the scale grows where lines leave it.
    void setScale(double low, double high);
    /// How long the whole plot is, s.
    void setSpan(double seconds);
    void setLines(std::vector<Line> lines);
    /// Instead of lines.
    void setPlaceholder(const QString& text);
    /// The moment that is looked at, s before the newest; none is marked while it is live.
    void setShown(std::optional<double> ago);

    /// How many ranges are worth having: one for every other pixel.
    [[nodiscard]] std::size_t columns() const;

    [[nodiscard]] QSize sizeHint() const override { return {560, 210}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {240, 130}; }

  signals:
    void momentAsked(double ago);

  protected:
    void paintEvent(QPaintEvent* event) override;
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;

  private:
    [[nodiscard]] QRectF plotArea() const;
    void ask(const QPointF& position);
    void paintAxes(QPainter& painter, const QRectF& plot, double low, double high) const;
    void paintLine(QPainter& painter, const QRectF& plot, const Line& line, double low, double high) const;
    void paintNames(QPainter& painter, const QRectF& plot) const;

    QString placeholder_;
    double low_ = 0;
    double high_ = 1;
    double span_ = 30;
    std::vector<Line> lines_;
    std::optional<double> shown_;
};

}  // namespace skincal
