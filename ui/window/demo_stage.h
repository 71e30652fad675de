#pragma once

#include <QObject>
#include <QPointer>
#include <QTimer>

#include "ui/scene3d/body_words.h"
#include "ui/scene3d/scene_glyphs.h"
#include "ui/scene3d/touch_filter.h"

namespace skincal {

class BodyViewWidget;
class DemoPage;
class DemoPresenter;

/// What the body does while the demo is shown: it takes the colours and heights of what the skin feels, can be touched
/// with the mouse, turns slowly, fills the screen. Afterwards it is as it was before.
class DemoStage : public QObject {
    Q_OBJECT
  public:
    /// All three outlive this.
    DemoStage(DemoPresenter& presenter, DemoPage& page, BodyViewWidget& view, QObject* parent);

    [[nodiscard]] bool isFullScreen() const { return place_ != nullptr; }
    void setFullScreen(bool full);

  signals:
    void activeChanged(bool active);

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    void arrange();
    void enter();
    void leave();
    void showPicture();
    [[nodiscard]] std::vector<ContactMark> contactMarks() const;
    void showSelection();
    void tellTheWayBack();

    DemoPresenter& presenter_;
    DemoPage& page_;
    BodyViewWidget& view_;
    TouchFilter touch_;
    QTimer orbit_;
    QPointer<QWidget> place_;  ///< holds the view's place while that fills the screen
    ColourMode before_ = ColourMode::Patch;
    std::vector<ModuleId> selectedBefore_;
    bool isActive_ = false;
};

}  // namespace skincal
