#pragma once

#include <sys/types.h>

namespace skincal {

/// An X display for programs that draw without a screen: where DISPLAY is not set, starts Xvfb on a free display,
/// sets DISPLAY, and stops it at the end. Does nothing where there is a display, or no Xvfb.
class HeadlessDisplay {
  public:
    HeadlessDisplay();
    ~HeadlessDisplay();
    HeadlessDisplay(const HeadlessDisplay&) = delete;
    HeadlessDisplay& operator=(const HeadlessDisplay&) = delete;

  private:
    pid_t server_ = -1;
};

}  // namespace skincal
