#include "ui/widgets/theme.h"

#include <QGuiApplication>

#include "ui/palette.h"

namespace skincal {

Theme Theme::light() {
    return {false, "#f4f5f7", "#ffffff", "#d5d9e0", "#1b1f27", "#5d6675", "#1f62d0", "#1f62d0", "#b45309", "#b3261e"};
}

Theme Theme::dark() {
    return {true, "#1b1e24", "#242830", "#3a404b", "#e8eaee", "#9aa3b2", "#6aa5ff", "#6aa5ff", "#f5a524", "#ff7b72"};
}

Theme Theme::current() {
    return QGuiApplication::palette().color(QPalette::Window).lightness() < 128 ? dark() : light();
}

QPalette Theme::palette() const {
    QPalette palette;
    palette.setColor(QPalette::Window, window);
    palette.setColor(QPalette::Base, panel);
    palette.setColor(QPalette::AlternateBase, isDark ? panel.lighter(108) : panel.darker(103));
    palette.setColor(QPalette::Button, panel);
    palette.setColor(QPalette::ToolTipBase, panel);
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText, QPalette::ToolTipText})
        palette.setColor(role, text);
    palette.setColor(QPalette::PlaceholderText, muted);
    palette.setColor(QPalette::Highlight, accent);
    palette.setColor(QPalette::HighlightedText, isDark ? QColor("#0b1424") : QColor("#ffffff"));
    palette.setColor(QPalette::Link, accent);
    palette.setColor(QPalette::Mid, line);
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
        palette.setColor(QPalette::Disabled, role, isDark ? QColor("#69717f") : QColor("#9aa1ad"));
    palette.setColor(QPalette::Disabled, QPalette::Highlight, line);
    return palette;
}

QString Theme::styleSheet() const {
    return QStringLiteral(
               "QToolTip { border: 1px solid %1; padding: 4px; }"
               "QLabel#pageTitle { font-size: 17pt; font-weight: 600; }"
               "QLabel#pagePurpose, QLabel[muted=\"true\"] { color: %2; }"
               "QLabel[attention=\"true\"] { color: %8; }"
               "QLabel[good=\"true\"] { color: %4; font-weight: 600; }"
               "QLabel#instruction { font-size: 12pt; font-weight: 600; }"
               "QLabel[twoLines=\"true\"] { min-height: 2.6em; }"
               "QFrame#card { background: %3; border: 1px solid %1; border-radius: 6px; }"
               "QTableView, QListView, QPlainTextEdit { background: %3; border: 1px solid %1; border-radius: 4px; "
               "gridline-color: %1; }"
               "QHeaderView::section { background: %3; color: %2; border: none; border-bottom: 1px solid %1; "
               "padding: 4px 6px; }"
               "QPushButton { padding: 5px 12px; border: 1px solid %1; border-radius: 4px; background: %3; }"
               "QPushButton:hover:enabled { border-color: %4; }"
               "QTableView:focus, QListView:focus { border-color: %4; }"
               // As large as without it.
               "QPushButton:focus { border: 2px solid %4; padding: 4px 11px; }"
               "QPushButton:disabled { color: %5; }"
               "QPushButton:checked { background: %7; border-color: %4; }"
               "QPushButton[primary=\"true\"]:enabled { background: %4; color: %6; border-color: %4; font-weight: 600; "
               "}"
               "QPushButton[primary=\"true\"]:focus { border-color: %9; }"
               // Fusion fills the groove of a disabled slider with the accent, as if it could be moved.
               "QSlider::groove:horizontal:disabled { height: 3px; background: %1; border-radius: 1px; }"
               "QSlider::handle:horizontal:disabled { width: 11px; margin: -4px 0; background: %5; border-radius: 5px; "
               "}"
               "QSplitter::handle { background: %1; }"
               "QProgressBar { border: 1px solid %1; border-radius: 4px; background: %3; text-align: center; "
               "min-height: 18px; }"
               "QProgressBar::chunk { background: %4; border-radius: 3px; }"
               "QStatusBar { border-top: 1px solid %1; }"
               "QToolBar { border-bottom: 1px solid %1; spacing: 4px; padding: 3px; }")
        .arg(line.name(), muted.name(), panel.name(), accent.name(),
             isDark ? QStringLiteral("#69717f") : QStringLiteral("#9aa1ad"),
             isDark ? QStringLiteral("#0b1424") : QStringLiteral("#ffffff"),
             isDark ? QStringLiteral("#2d4468") : QStringLiteral("#d3e2fa"), attention.name(), text.name());
}

QColor patchTint(unsigned patch) {
    return QColor::fromRgb(kKinds.at(patch % kKinds.size()));
}

}  // namespace skincal
