// What can be done with a mouse can be done with keys.

#include <gtest/gtest.h>

#include <QAction>
#include <QCheckBox>
#include <QListView>
#include <QSignalSpy>
#include <QTabWidget>
#include <QTableView>
#include <set>

#include "core/workflow/simulated_recording.h"
#include "tests/ui/window/keys.h"
#include "ui/scene3d/body_view_widget.h"
#include "ui/widgets/contact_table.h"
#include "ui/widgets/network_view.h"
#include "ui/widgets/picture_view.h"
#include "ui/widgets/theme.h"

namespace skincal {
namespace {

/// A window with a body in it, and somebody at its keyboard.
class Keyboard : public ::testing::Test {
  protected:
    void SetUp() override {
        driven_.session().load(openedFrom(recordingOf(buildWorld(*findScenario("arm"), 1))));
        ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
    }
    [[nodiscard]] std::size_t poses() {
        return posesOf(driven_.session().measured(), driven_.session().decisions()).size();
    }
    [[nodiscard]] BodyViewWidget& body() { return driven_.window.bodyView(); }

    DrivenWindow driven_;
    Keys keys_{driven_};
};

TEST_F(Keyboard, TabLeadsToEveryControlOfEveryPageAndOutOfItAgain) {
    for (const Step step : kSteps) {
        keys_.press(static_cast<Qt::Key>(Qt::Key_1 + static_cast<int>(step)), Qt::ControlModifier);
        ASSERT_EQ(driven_.window.step(), step);
        const std::vector<QWidget*> met = keys_.round();
        for (QWidget* widget : driven_.window.findChildren<QWidget*>()) {
            const bool isThere = widget->isVisible() && widget->isEnabled() && widget->window() == &driven_.window;
            if (!isThere || (widget->focusPolicy() & Qt::TabFocus) != Qt::TabFocus || widget->focusProxy() != nullptr)
                continue;
            EXPECT_TRUE(std::find(met.begin(), met.end(), widget) != met.end())
                << nameOf(step).toStdString() << ": " << widget->metaObject()->className() << ' '
                << widget->objectName().toStdString();
        }
    }
}

TEST_F(Keyboard, ShortcutsLeadToStepsAndPartsOfTheWindow) {
    keys_.press(Qt::Key_5, Qt::ControlModifier);
    EXPECT_EQ(driven_.window.step(), Step::Views);
    keys_.press(Qt::Key_Left, Qt::AltModifier);
    EXPECT_EQ(driven_.window.step(), Step::Scan);
    keys_.press(Qt::Key_Right, Qt::AltModifier);
    keys_.press(Qt::Key_Right, Qt::AltModifier);
    EXPECT_EQ(driven_.window.step(), Step::Result);
    EXPECT_TRUE(driven_.window.centralWidget()->isAncestorOf(keys_.focused())) << "the page has the keys";

    std::set<QString> met;
    for (int area = 0; area < 4; ++area) {
        keys_.press(Qt::Key_F6);
        const QWidget* at = keys_.focused();
        met.insert(at == &body() ? QStringLiteral("body") : at->objectName());
    }
    EXPECT_TRUE(met.contains("steps"));
    EXPECT_TRUE(met.contains("problems"));
    EXPECT_TRUE(met.contains("body"));
    const QWidget* before = keys_.focused();
    keys_.press(Qt::Key_F6);
    keys_.press(Qt::Key_F6, Qt::ShiftModifier);
    EXPECT_EQ(keys_.focused(), before);

    const bool wasDark = Theme::current().isDark;
    keys_.press(Qt::Key_T, Qt::ControlModifier);
    EXPECT_NE(Theme::current().isDark, wasDark);
    keys_.press(Qt::Key_T, Qt::ControlModifier);
    EXPECT_EQ(Theme::current().isDark, wasDark);
}

TEST_F(Keyboard, ArrowsGoThroughTheListOfStepsAndStayThere) {
    keys_.press(Qt::Key_1, Qt::ControlModifier);
    ASSERT_TRUE(keys_.tabTo("steps"));
    for (const Step step : kSteps) {
        EXPECT_EQ(driven_.window.step(), step);
        keys_.press(Qt::Key_Down);
        EXPECT_EQ(keys_.focused()->objectName(), "steps");
    }
}

TEST_F(Keyboard, SpaceCapturesAPoseUnlessTheFocusedControlHasAUseForIt) {
    ASSERT_TRUE(driven_.connectSkin());
    keys_.press(Qt::Key_2, Qt::ControlModifier);
    EXPECT_EQ(keys_.focused()->objectName(), "capture");
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.find<QPushButton>("capture")->isEnabled(); }));
    QCheckBox* automatic = nullptr;
    for (auto* box : driven_.window.findChildren<QCheckBox*>()) {
        if (box->text().startsWith("Capture by itself"))
            automatic = box;
    }
    ASSERT_NE(automatic, nullptr);
    if (automatic->isChecked()) {
        automatic->setFocus();
        keys_.press(Qt::Key_Space);
    }
    EXPECT_FALSE(automatic->isChecked()) << "the box has the space bar";
    for (int turn = 0; turn < 20; ++turn)
        QCoreApplication::processEvents();
    const std::size_t before = poses();
    keys_.press(Qt::Key_Space);
    EXPECT_TRUE(automatic->isChecked());
    keys_.press(Qt::Key_Return);
    EXPECT_FALSE(automatic->isChecked()) << "Return presses, too";
    EXPECT_EQ(poses(), before);
    // In the list of steps and in 3D it is nobody's.
    ASSERT_TRUE(keys_.tabTo("steps"));
    ASSERT_TRUE(driven_.waitFor([&] {
        keys_.press(Qt::Key_Space);
        return poses() > before;
    }));
    const std::size_t between = poses();
    body().setFocus();
    EXPECT_TRUE(driven_.waitFor([&] {
        keys_.press(Qt::Key_Space);
        return poses() > between;
    }));
}

TEST_F(Keyboard, ModulesOfTheNetworkAreChosenByArrowsAndReturn) {
    ASSERT_TRUE(driven_.connectSkin());
    keys_.press(Qt::Key_1, Qt::ControlModifier);
    auto* network = driven_.window.findChild<NetworkView*>();
    network->setFocus(Qt::TabFocusReason);
    keys_.press(Qt::Key_Home);
    const auto first = network->current();
    ASSERT_TRUE(first);
    keys_.press(Qt::Key_Right);
    keys_.press(Qt::Key_PageDown);
    ASSERT_NE(network->current(), first);
    EXPECT_EQ(network->accessibleDescription(), QStringLiteral("Module %1").arg(network->current()->value));
    const QImage unlit = network->grab().toImage();
    keys_.press(Qt::Key_Return);
    EXPECT_EQ(body().selected(), std::vector{*network->current()});
    EXPECT_TRUE(driven_.waitFor([&] { return !driven_.rig.litAt(RigClock::Time::max()).empty(); })) << "its LED blinks";
    EXPECT_NE(network->grab().toImage(), unlit);
}

TEST_F(Keyboard, MarksOfAPictureAreChosenByArrowsAndReturn) {
    keys_.press(Qt::Key_6, Qt::ControlModifier);
    auto* tabs = driven_.find<QTabWidget>("resultTabs");
    tabs->setCurrentIndex(1);
    auto* picture = driven_.find<PictureView>("overlay");
    ASSERT_TRUE(driven_.waitFor([&] { return !picture->shapes().empty(); }));
    ASSERT_TRUE(keys_.tabTo("overlay"));
    const QImage without = picture->grab().toImage();
    keys_.press(Qt::Key_Down);
    ASSERT_TRUE(picture->current());
    EXPECT_NE(picture->grab().toImage(), without) << "it shows where the keys are";
    keys_.press(Qt::Key_PageDown);
    const ModuleId module = *picture->current();
    EXPECT_EQ(picture->accessibleDescription(), QStringLiteral("Module %1").arg(module.value));
    keys_.press(Qt::Key_Space);
    EXPECT_EQ(body().selected(), std::vector{module});
    keys_.press(Qt::Key_Plus);
    EXPECT_GT(picture->zoom(), 1);
    for (int i = 0; i < 12; ++i)
        keys_.press(Qt::Key_Plus);
    for (int i = 0; i < 5; ++i) {
        keys_.press(Qt::Key_PageDown);
        const auto& marks = picture->marks();
        const auto mark = std::find_if(marks.begin(), marks.end(),
                                       [&](const PictureMark& each) { return each.module == picture->current(); });
        if (mark != marks.end()) {
            EXPECT_TRUE(picture->rect().contains(picture->toWidget(mark->pixel).toPoint())) << "it is brought in sight";
        }
    }
    keys_.press(Qt::Key_0);
    EXPECT_EQ(picture->zoom(), 1);
}

TEST_F(Keyboard, ModulesAreChosenAndMeasuredIn3D) {
    std::vector<ModuleId> modules;
    for (const BodyModule& module : driven_.session().solution()->body.modules)
        modules.push_back(module.id);
    std::sort(modules.begin(), modules.end());
    keys_.press(Qt::Key_6, Qt::ControlModifier);
    body().setFocus(Qt::TabFocusReason);
    keys_.press(Qt::Key_PageDown);
    EXPECT_EQ(body().accessibleDescription(), QStringLiteral("Module %1").arg(modules[0].value));
    keys_.press(Qt::Key_PageDown);
    EXPECT_TRUE(body().selected().empty()) << "going is not choosing";
    keys_.press(Qt::Key_Return);
    EXPECT_EQ(body().selected(), std::vector{modules[1]});

    const QSignalSpy measured(&body(), &BodyViewWidget::measured);
    ASSERT_TRUE(keys_.tabToAndPress("measure"));
    body().setFocus(Qt::TabFocusReason);
    keys_.press(Qt::Key_Return);
    keys_.press(Qt::Key_PageUp);
    keys_.press(Qt::Key_Return);
    ASSERT_EQ(measured.count(), 1);
    const auto ledOf = [&](ModuleId module) { return body().layoutShown().find(module)->led(); };
    EXPECT_NEAR(measured.front().at(2).toDouble(), (ledOf(modules[0]) - ledOf(modules[1])).norm(), 1e-9);
}

TEST(KeyboardTable, ALineOfContactsIsChosenByReturn) {
    ContactTable table;
    table.setContacts({{ModuleId{5}, 2.0, {}, {}}, {ModuleId{3}, 1.0, {}, {}}});
    table.show();
    const QSignalSpy clicked(&table, &ContactTable::moduleClicked);
    table.setCurrentCell(0, 0);
    QTest::keyClick(&table, Qt::Key_Down);
    QTest::keyClick(&table, Qt::Key_Return);
    ASSERT_EQ(clicked.count(), 1);
    EXPECT_EQ(clicked.front().front().value<ModuleId>(), ModuleId{3});
    QTest::keyClick(&table, Qt::Key_Down);
    QTest::keyClick(&table, Qt::Key_Return);
    EXPECT_EQ(clicked.count(), 1) << "an empty line has no module";
}

}  // namespace
}  // namespace skincal
