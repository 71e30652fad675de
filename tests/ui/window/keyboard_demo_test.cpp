// The whole demo in a real window by keys alone.

#include <gtest/gtest.h>

#include <QApplication>
#include <QLineEdit>
#include <QTemporaryDir>

#include "tests/ui/window/keys.h"
#include "tests/ui/window/true_body.h"

namespace skincal {
namespace {

TEST(KeyboardDemo, LeadsFromConnectToAnExportedFile) {
    DrivenWindow driven;
    Keys keys(driven);
    ASSERT_TRUE(keys.tabToAndPress("connect"));
    ASSERT_TRUE(driven.waitFor([&] { return driven.workbench.isSkinReady(); }));

    keys.press(Qt::Key_Right, Qt::AltModifier);
    ASSERT_EQ(driven.window.step(), Step::Pose);
    const auto poses = [&] { return posesOf(driven.session().measured(), driven.session().decisions()).size(); };
    ASSERT_TRUE(driven.waitFor([&] { return poses() == 1; }));
    ASSERT_TRUE(driven.waitFor([&] { return driven.find<QPushButton>("turn")->isEnabled(); }));
    ASSERT_TRUE(keys.tabTo("turn"));
    for (std::size_t pose = 2; pose <= 8; ++pose) {
        keys.press(Qt::Key_Space);
        ASSERT_TRUE(driven.waitFor([&] { return poses() == pose; })) << "the button has the space bar, not the page";
    }
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));

    keys.press(Qt::Key_Right, Qt::AltModifier);
    ASSERT_EQ(driven.window.step(), Step::Camera);
    ASSERT_TRUE(keys.tabToAndPress("makersIntrinsics"));
    ASSERT_TRUE(driven.session().decisions().camera);

    keys.press(Qt::Key_Right, Qt::AltModifier);
    ASSERT_EQ(driven.window.step(), Step::Scan);
    const auto views = [&] { return driven.session().measured().views.size(); };
    ASSERT_TRUE(keys.tabToAndPress("scan"));
    ASSERT_TRUE(driven.waitFor([&] { return views() == 1; }));
    const auto isViewsDone = [&] {
        return driven.steps().states()[static_cast<std::size_t>(Step::Views)].status == StepStatus::Done;
    };
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    while (views() < 10 && !isViewsDone()) {
        const std::size_t before = views();
        keys.press(Qt::Key_Right, Qt::AltModifier);
        ASSERT_EQ(driven.window.step(), Step::Views);
        ASSERT_TRUE(driven.waitFor([&] { return driven.session().guidance() != nullptr; }));
        ASSERT_TRUE(keys.tabToAndPress("moveCamera"));
        ASSERT_TRUE(driven.waitFor([&] { return driven.rig.isCameraAtRest(); }));
        ASSERT_TRUE(keys.tabToAndPress("scanHere"));
        ASSERT_EQ(driven.window.step(), Step::Scan);
        ASSERT_TRUE(driven.waitFor([&] { return views() == before + 1; }));
        ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    }
    EXPECT_EQ(driven.patchesPlaced(), driven.session().solution()->body.patches.size());

    keys.press(Qt::Key_Right, Qt::AltModifier);
    ASSERT_EQ(driven.window.step(), Step::Result);
    keys.press(Qt::Key_7, Qt::ControlModifier);
    ASSERT_EQ(driven.window.step(), Step::Export);
    const QTemporaryDir folder;
    const QString file = folder.filePath("arm.body.json");
    ASSERT_TRUE(keys.tabTo("file"));
    keys.press(Qt::Key_A, Qt::ControlModifier);
    keys.type(file);
    keys.press(Qt::Key_Return);
    ASSERT_TRUE(driven.waitFor(
        [&] { return driven.steps().states()[static_cast<std::size_t>(Step::Export)].status == StepStatus::Done; }));
    expectTrueBody(file, driven.rig.world());
}

}  // namespace
}  // namespace skincal
