#include "tests/ui/window/keys.h"

#include <gtest/gtest.h>

#include <QApplication>
#include <algorithm>

namespace skincal {
namespace {

constexpr int kMost = 300;  // controls; who comes so far goes round in a trap

}  // namespace

Keys::Keys(DrivenWindow& driven) : driven_(driven) {
    driven.window.activateWindow();
    EXPECT_TRUE(QTest::qWaitForWindowActive(&driven.window));
}

QWidget* Keys::focused() const {
    QWidget* widget = QApplication::focusWidget();
    return widget != nullptr ? widget : &driven_.window;
}

void Keys::press(Qt::Key key, Qt::KeyboardModifiers modifiers) {
    QTest::keyClick(focused(), key, modifiers);
}

void Keys::type(const QString& text) {
    QTest::keyClicks(focused(), text);
}

bool Keys::tabTo(const char* name) {
    for (int i = 0; i < kMost; ++i) {
        if (focused()->objectName() == QLatin1String(name))
            return true;
        press(Qt::Key_Tab);
    }
    return false;
}

bool Keys::tabToAndPress(const char* name) {
    // Tab passes by what is disabled.
    const auto* button = driven_.find<QWidget>(name);
    if (button == nullptr || !driven_.waitFor([&] { return button->isEnabled(); }) || !tabTo(name))
        return false;
    press(Qt::Key_Return);
    return true;
}

std::vector<QWidget*> Keys::round() {
    std::vector<QWidget*> met;
    while (met.size() < kMost && std::find(met.begin(), met.end(), focused()) == met.end()) {
        met.push_back(focused());
        press(Qt::Key_Tab);
    }
    return met;
}

}  // namespace skincal
