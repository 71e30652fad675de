#pragma once

#include <QColor>
#include <QPalette>

namespace skincal {

/// Colours with a meaning, told apart by people who see red and green alike: blue is good, orange asks for attention,
/// what is wrong has a shape of its own besides.
struct Theme {
    bool isDark = true;
    QColor window, panel, line, text, muted;
    QColor accent;  ///< what can be pressed, what is selected
    QColor good;
    QColor attention;
    QColor bad;

    [[nodiscard]] QPalette palette() const;
    /// For what the palette does not reach: borders, headings, lists.
    [[nodiscard]] QString styleSheet() const;

    [[nodiscard]] static Theme light();
    [[nodiscard]] static Theme dark();
    /// That of the application's palette.
    [[nodiscard]] static Theme current();
};

/// Eight colours for patches, as the 3D view has them; repeats.
[[nodiscard]] QColor patchTint(unsigned patch);

}  // namespace skincal
