#pragma once

#include <QPushButton>
#include <QStyle>
#include <QVariant>

namespace skincal {

/// Whether a button is the one to press next, which the style sheet shows.
inline void setPrimary(QPushButton* button, bool primary) {
    if (button->property("primary").toBool() == primary)
        return;
    button->setProperty("primary", primary);
    button->style()->unpolish(button);
    button->style()->polish(button);
}

}  // namespace skincal
