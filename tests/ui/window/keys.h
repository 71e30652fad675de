#pragma once

#include <QWidget>

#include "tests/ui/window/driven_window.h"

namespace skincal {

/// Somebody at the keyboard of a window, without a mouse: every key goes to what has the focus.
class Keys {
  public:
    /// The window becomes the active one, without which there is no focus.
    explicit Keys(DrivenWindow& driven);

    [[nodiscard]] QWidget* focused() const;
    void press(Qt::Key key, Qt::KeyboardModifiers modifiers = {});
    void type(const QString& text);
    /// Presses Tab until the control of this name has the focus. False where it never has.
    [[nodiscard]] bool tabTo(const char* name);
    /// The same, and then Return there, once it is enabled.
    [[nodiscard]] bool tabToAndPress(const char* name);
    /// All that Tab leads to from here until it comes round.
    [[nodiscard]] std::vector<QWidget*> round();

  private:
    DrivenWindow& driven_;
};

}  // namespace skincal
