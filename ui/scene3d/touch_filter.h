#pragma once

#include <QObject>

#include "ui/scene3d/scene_layout.h"

namespace skincal {

class BodyViewWidget;

/// While it is on, the left button presses on the body rather than turn it: a press that begins on a board is a touch,
/// and follows the mouse until the button is let go. One that begins beside the body, or with Shift, turns and shifts
/// as ever.
class TouchFilter : public QObject {
    Q_OBJECT
  public:
    /// @param view  outlives this.
    explicit TouchFilter(BodyViewWidget& view, QObject* parent = nullptr);

    /// Ends a touch where it is turned off.
    void setOn(bool on);
    [[nodiscard]] bool isOn() const { return isOn_; }

  signals:
    void touched(skincal::ModuleId module, const skincal::Vector3d& point_u);
    /// The button was let go, or the mouse has left the body.
    void released();

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    void follow(const QPointF& position);
    void end();

    BodyViewWidget& view_;
    bool isOn_ = false;
    bool isPressed_ = false;
    bool isTouching_ = false;
};

}  // namespace skincal
