// Whoever hears the window rather than sees it, and whoever asks by resting the mouse, is told of every control what it
// is and what it is for.

#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QAccessible>
#include <QComboBox>
#include <QDialog>
#include <QHeaderView>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QProgressBar>
#include <QScrollBar>
#include <QTabBar>
#include <QTabWidget>

#include "core/workflow/simulated_recording.h"
#include "tests/ui/window/driven_window.h"
#include "ui/pages/address_dialog.h"
#include "ui/pages/page.h"
#include "ui/pages/video_dialog.h"
#include "ui/scene3d/body_view_widget.h"

namespace skincal {
namespace {

template <class... Classes>
bool isAnyOf(const QObject* widget) {
    return ((qobject_cast<const Classes*>(widget) != nullptr) || ...);
}

/// Parts of Qt's own controls, which speak for them.
bool isPart(const QWidget* widget) {
    if (isAnyOf<QHeaderView, QScrollBar>(widget) || widget->objectName().startsWith("qt_"))
        return true;
    for (const QWidget* parent = widget->parentWidget(); parent != nullptr; parent = parent->parentWidget()) {
        if (isAnyOf<QComboBox, QAbstractSpinBox, QAbstractItemView, QTabBar, BodyViewWidget>(parent))
            return true;
    }
    return false;
}

/// A drawing of ours: nothing in it but what it paints.
bool isDrawing(const QWidget* widget) {
    return QByteArray(widget->metaObject()->className()).startsWith("skincal::") && !isAnyOf<Page, QDialog>(widget) &&
           (widget->findChildren<QWidget*>().isEmpty() || isAnyOf<BodyViewWidget>(widget));
}

bool isControl(const QWidget* widget) {
    return !isPart(widget) && (isAnyOf<QAbstractButton, QComboBox, QAbstractSlider, QAbstractSpinBox, QLineEdit,
                                       QAbstractItemView, QPlainTextEdit, QProgressBar, QTabWidget>(widget) ||
                               isDrawing(widget));
}

QString nameOfControl(QWidget* widget) {
    QAccessibleInterface* told = QAccessible::queryAccessibleInterface(widget);
    return told == nullptr ? QString() : told->text(QAccessible::Name);
}

std::string wordsFor(const QWidget* widget) {
    std::string path = widget->metaObject()->className();
    if (!widget->objectName().isEmpty())
        path += " \"" + widget->objectName().toStdString() + '"';
    for (const QWidget* parent = widget->parentWidget(); parent != nullptr; parent = parent->parentWidget()) {
        if (isAnyOf<Page, QDialog>(parent))
            return path + " of " + parent->metaObject()->className();
    }
    return path;
}

/// @return how many there were.
int expectAllDescribed(const QWidget& window) {
    int controls = 0;
    for (QWidget* widget : window.findChildren<QWidget*>()) {
        if (!isControl(widget))
            continue;
        ++controls;
        const QString name = nameOfControl(widget);
        EXPECT_FALSE(name.trimmed().isEmpty()) << wordsFor(widget) << " has no name";
        // A sentence, not the name once more.
        EXPECT_GE(widget->toolTip().simplified().count(u' '), 2) << wordsFor(widget) << " does not say what it is for";
        EXPECT_NE(widget->toolTip(), name) << wordsFor(widget);
    }
    return controls;
}

TEST(Described, EveryControlOfEveryPage) {
    DrivenWindow driven;
    constexpr int kAtLeast = 70;
    EXPECT_GT(expectAllDescribed(driven.window), kAtLeast) << "as it begins";
    // Words follow what there is.
    driven.session().load(openedFrom(recordingOf(buildWorld(*findScenario("arm"), 1))));
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    ASSERT_TRUE(driven.connectSkin());
    for (const Step step : kSteps) {
        ASSERT_TRUE(driven.goTo(step));
        EXPECT_GT(expectAllDescribed(driven.window), kAtLeast) << nameOf(step).toStdString();
    }
}

TEST(Described, EveryControlOfEveryDialog) {
    DrivenWindow driven;
    ASSERT_TRUE(driven.goTo(Step::Camera));
    ASSERT_TRUE(driven.click("calibrateHere"));
    const auto* calibration = driven.find<QDialog>("calibration");
    ASSERT_NE(calibration, nullptr);
    EXPECT_GT(expectAllDescribed(*calibration), 15);
    const AddressDialog address;
    EXPECT_EQ(expectAllDescribed(address), 3);
    const VideoDialog video;
    EXPECT_EQ(expectAllDescribed(video), 4);
}

}  // namespace
}  // namespace skincal
