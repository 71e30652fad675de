// How the window is worked without a mouse.

#include <QAbstractItemView>
#include <QApplication>
#include <QListView>
#include <QPushButton>
#include <QShortcut>
#include <QStackedWidget>
#include <algorithm>

#include "ui/pages/page.h"
#include "ui/scene3d/body_view_widget.h"
#include "ui/window/key_filter.h"
#include "ui/window/main_window.h"
#include "ui/window/problem_list.h"

namespace skincal {

void MainWindow::buildKeys() {
    qApp->installEventFilter(new KeyFilter(this));
    const auto add = [this](const QKeySequence& keys, auto work) {
        connect(new QShortcut(keys, this), &QShortcut::activated, this, work);
    };
    // Not the buttons' own shortcuts, which go with every new text.
    add(QKeySequence(Qt::ALT | Qt::Key_Left), [this] { back_->isVisible() ? back_->click() : void(); });
    add(QKeySequence(Qt::ALT | Qt::Key_Right), [this] { next_->isVisible() ? next_->click() : void(); });
    for (const Step step : kSteps) {
        const auto digit = static_cast<Qt::Key>(Qt::Key_1 + static_cast<int>(step));
        add(QKeySequence(Qt::CTRL | digit), [this, step] {
            showStep(step);
            focusPage();
        });
    }
    add(QKeySequence(Qt::Key_F6), [this] { focusArea(1); });
    add(QKeySequence(Qt::SHIFT | Qt::Key_F6), [this] { focusArea(-1); });
    // Tab leads on, arrows go from cell to cell: who comes in by Tab must get out by it.
    for (auto* view : findChildren<QAbstractItemView*>())
        view->setTabKeyNavigation(false);
}

void MainWindow::focusPage() {
    Page& page = *pages_.at(static_cast<std::size_t>(step()));
    const auto canHaveIt = [](const QWidget* widget) {
        return widget->isVisible() && widget->isEnabled() && (widget->focusPolicy() & Qt::TabFocus) != 0;
    };
    QWidget* first = page.mainControl();
    if (first == nullptr || !canHaveIt(first)) {
        first = nullptr;
        for (auto* button : page.findChildren<QPushButton*>()) {
            if (first == nullptr && button->property("primary").toBool() && canHaveIt(button))
                first = button;
        }
    }
    for (QWidget* next = page.nextInFocusChain(); first == nullptr && next != &page; next = next->nextInFocusChain()) {
        if (page.isAncestorOf(next) && canHaveIt(next))
            first = next;
    }
    if (first != nullptr)
        first->setFocus(Qt::ShortcutFocusReason);
}

void MainWindow::focusArea(int way) {
    const std::array<QWidget*, 4> areas{stepList_, stack_, body_, findChild<ProblemList*>()};
    const QWidget* now = focusWidget();
    const auto at = std::find_if(areas.begin(), areas.end(), [now](const QWidget* area) {
        return now != nullptr && (area == now || area->isAncestorOf(now));
    });
    const auto count = static_cast<int>(areas.size());
    const int from = at == areas.end() ? (way > 0 ? -1 : 0) : static_cast<int>(at - areas.begin());
    QWidget* next = areas.at(static_cast<std::size_t>((from + way + count) % count));
    if (next == stack_)
        focusPage();
    else
        next->setFocus(Qt::ShortcutFocusReason);
}

}  // namespace skincal
