#pragma once

#include <QObject>

namespace skincal {

/// Keys where the focus is, in every window of the program: Return presses the button that has it, as Space does, and
/// Space goes to a control that has a use for it before it is anybody's shortcut.
class KeyFilter : public QObject {
    Q_OBJECT
  public:
    using QObject::QObject;

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;
};

}  // namespace skincal
