#pragma once

#include <QColor>
#include <QPointF>
#include <QSizeF>
#include <QString>
#include <QWidget>
#include <optional>
#include <vector>

#include "core/geometry/se3.h"

class vtkCamera;

namespace skincal {

/// What a colour means.
struct LegendEntry {
    QColor colour;
    QString text;
};

struct Legend {
    QString title;
    std::vector<LegendEntry> entries;
    QString low, high;              ///< ends of a colour bar; no bar where both are empty
    bool isDiverging = false;       ///< the bar: colours to both sides of 0
    std::vector<LegendEntry> more;  ///< below it: what else is drawn
};

/// Words at a place of the scene.
struct SceneLabel {
    Vector3d where = Vector3d::Zero();
    QString text;
    bool strong = false;  ///< on a ground of its own, before others
    double below_px = 0;  ///< how far below the place its middle is
};

struct OverlayContent {
    QString empty;    ///< in the middle, instead of everything else
    QString caption;  ///< below, on what the scene shows
    Legend legend;
    std::vector<SceneLabel> labels;
    std::vector<Vector3d> measure;  ///< one or two points that are marked and joined, in front of everything
    QColor measureColour;
    bool axes = false;   ///< of the scene, x, y and z
    bool scale = false;  ///< a bar of a round length
    bool dark = true;
    bool focus = false;  ///< a frame that shows where keys go
};

/// Words, legend, axes and scale bar above a scene, in Qt's fonts and the user's language. Lets the mouse through. Is
/// painted anew with every frame of the scene, and follows its camera so.
class SceneOverlay : public QWidget {
    Q_OBJECT
  public:
    /// @param camera  of the scene below, which has this widget's size; outlives this.
    SceneOverlay(vtkCamera& camera, QWidget* parent);

    void setContent(OverlayContent content);
    [[nodiscard]] const OverlayContent& content() const { return content_; }

    /// The size of the legend's box, in the upper left corner; none where it has nothing to say.
    [[nodiscard]] QSizeF legendSize() const;

    /// Where a point of the scene appears, in this widget's coordinates; nothing behind the spectator.
    [[nodiscard]] std::optional<QPointF> project(const Vector3d& point) const;

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    void paintLegend(QPainter& painter) const;
    void paintMeasure(QPainter& painter) const;
    void paintLabels(QPainter& painter) const;
    void paintAxes(QPainter& painter) const;
    void paintScale(QPainter& painter) const;
    void paintCaption(QPainter& painter) const;
    void paintEmpty(QPainter& painter) const;
    [[nodiscard]] double pixelsPerMetre() const;
    [[nodiscard]] QColor ink() const;
    [[nodiscard]] QColor softInk() const;
    [[nodiscard]] QColor ground() const;

    static constexpr double kMargin = 14;  ///< about what stands in the corners, px

    vtkCamera& camera_;
    OverlayContent content_;
};

}  // namespace skincal
