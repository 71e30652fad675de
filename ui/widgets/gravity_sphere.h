#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "core/geometry/se3.h"

namespace skincal {

/// Which way up the body has been: directions of one module's frame on a sphere that is seen from outside. Filled dots
/// are covered, the large one is where the body is now, the ring is where it should be next, and an arrow leads there.
class GravitySphere : public QWidget {
    Q_OBJECT
  public:
    explicit GravitySphere(QWidget* parent = nullptr);

    /// Unit vectors.
    void setCovered(std::vector<Vector3d> directions);
    void setCurrent(const std::optional<Vector3d>& direction);
    void setTarget(const std::optional<Vector3d>& direction);

    [[nodiscard]] QSize sizeHint() const override { return {260, 260}; }
    [[nodiscard]] QSize minimumSizeHint() const override { return {160, 160}; }

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    void turnToFace();

    std::vector<Vector3d> covered_;
    std::optional<Vector3d> current_;
    std::optional<Vector3d> target_;
    Matrix3d R_screen_ = Matrix3d::Identity();  ///< screen x right, y up, z towards the eye
};

}  // namespace skincal
