#include "ui/window/key_filter.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSpinBox>
#include <QComboBox>
#include <QKeyEvent>
#include <QLineEdit>
#include <QPlainTextEdit>

namespace skincal {
namespace {

bool hasUseForSpace(const QObject* control) {
    if (const auto* view = qobject_cast<const QAbstractItemView*>(control)) {
        // Where the arrow keys select, there is nothing left for Space to do.
        const QItemSelectionModel* selection = view->selectionModel();
        return view->selectionMode() != QAbstractItemView::SingleSelection ||
               (selection != nullptr && !selection->isSelected(selection->currentIndex()));
    }
    return qobject_cast<const QAbstractButton*>(control) != nullptr ||
           qobject_cast<const QComboBox*>(control) != nullptr || qobject_cast<const QLineEdit*>(control) != nullptr ||
           qobject_cast<const QAbstractSpinBox*>(control) != nullptr ||
           qobject_cast<const QPlainTextEdit*>(control) != nullptr;
}

}  // namespace

bool KeyFilter::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() != QEvent::ShortcutOverride && event->type() != QEvent::KeyPress)
        return false;
    auto* key = static_cast<QKeyEvent*>(event);
    if (event->type() == QEvent::ShortcutOverride) {
        if (key->key() != Qt::Key_Space || key->modifiers() != Qt::NoModifier || !hasUseForSpace(watched))
            return false;
        key->accept();
        return true;
    }
    if (key->key() != Qt::Key_Return && key->key() != Qt::Key_Enter)
        return false;
    auto* button = qobject_cast<QAbstractButton*>(watched);
    if (button == nullptr || (key->modifiers() & ~Qt::KeypadModifier) != Qt::NoModifier)
        return false;
    if (!key->isAutoRepeat())
        button->click();
    return true;
}

}  // namespace skincal
