#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "ui/presenters/board_sign.h"

namespace skincal {

/// Residuals in two dimensions as points, whose colour and shape tell where they come from, about a cross at zero. Both
/// axes have one scale, and circles of round radii show it. A cloud that is round and centred is noise; an elongated or
/// shifted one is an error that is not.
class ResidualPlot : public QWidget {
    Q_OBJECT
  public:
    struct Cloud {
        BoardSign sign;
        std::vector<QPointF> residuals;  ///< px; y downwards, as in pictures
        bool isUsed = true;              ///< others don't decide about the scale
    };

    explicit ResidualPlot(QWidget* parent = nullptr);

    void setClouds(std::vector<Cloud> clouds);
    /// Stands out, others fade.
    void setSelected(std::optional<std::size_t> cloud);
    /// What stands there while there are no clouds.
    void setPlaceholder(const QString& text);

    [[nodiscard]] QSize sizeHint() const override { return {220, 200}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {170, 140}; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    [[nodiscard]] double reach() const;

    std::vector<Cloud> clouds_;
    std::optional<std::size_t> selected_;
    QString placeholder_;
};

}  // namespace skincal
