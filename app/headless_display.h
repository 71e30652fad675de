#pragma once

#include <sys/types.h>

#include <string>

namespace skincal {

/// An X display for programs that draw, with or without a screen. Where DISPLAY names a display that opens and can
/// draw in 3D, that one is used; else starts Xvfb on a free display and sets DISPLAY, for as long as this lives. Xvfb
/// ends with this object, and with the program however that ends. The libraries that draw abort the program where
/// there is no display: ask complaint() first.
class HeadlessDisplay {
  public:
    HeadlessDisplay();
    ~HeadlessDisplay();
    HeadlessDisplay(const HeadlessDisplay&) = delete;
    HeadlessDisplay& operator=(const HeadlessDisplay&) = delete;

    /// A sentence where there is nothing to draw with, else empty.
    [[nodiscard]] const std::string& complaint() const { return complaint_; }

  private:
    void stop();

    pid_t server_ = -1;
    std::string before_;  ///< DISPLAY as it was
    std::string complaint_;
};

}  // namespace skincal
