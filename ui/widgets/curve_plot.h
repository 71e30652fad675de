#pragma once

#include <QWidget>
#include <optional>
#include <vector>

namespace skincal {

/// A few numbers that should fall, on a logarithmic scale, with the newest written out.
class CurvePlot : public QWidget {
    Q_OBJECT
  public:
    explicit CurvePlot(QWidget* parent = nullptr);

    void setTitle(const QString& title);
    /// What the abscissa counts, below it.
    void setAbscissa(const QString& text);
    void setUnit(const QString& unit);
    /// One after the other, from 1 on; nothing where there is no number yet. Positive.
    void setValues(std::vector<std::optional<double>> values);
    /// A line to get below, with what it means written above it.
    void setGoal(std::optional<double> goal, const QString& meaning = {});
    [[nodiscard]] const QString& goalText() const { return goalText_; }

    [[nodiscard]] QSize sizeHint() const override { return {260, 170}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {160, 110}; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    QString title_, abscissa_, unit_, goalText_;
    std::vector<std::optional<double>> values_;
    std::optional<double> goal_;
};

}  // namespace skincal
