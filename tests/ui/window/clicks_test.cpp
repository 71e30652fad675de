// Single controls, clicked: pausing a scan, dropping a view, letting a module blink, what is marked in 3D.

#include <gtest/gtest.h>

#include <QAction>
#include <QComboBox>
#include <QProgressBar>

#include "core/workflow/simulated_recording.h"
#include "tests/ui/window/driven_window.h"
#include "ui/scene3d/body_view_widget.h"
#include "ui/widgets/network_view.h"

namespace skincal {
namespace {

TEST(Clicks, AScanIsPausedAndGoesOn) {
    DrivenWindow driven;
    ASSERT_TRUE(driven.connectSkin());
    ASSERT_TRUE(driven.capturePoses(3));
    ASSERT_TRUE(driven.useMakersIntrinsics());
    ASSERT_TRUE(driven.goTo(Step::Scan));
    ASSERT_TRUE(driven.click("scan"));
    auto* progress = driven.find<QProgressBar>("scanProgress");
    ASSERT_TRUE(driven.waitFor([&] { return progress->value() > 5; }));
    ASSERT_TRUE(driven.click("pause"));
    auto* pause = driven.find<QPushButton>("pause");
    ASSERT_TRUE(driven.waitFor([&] { return pause->text() == "Resume"; }));
    const int stood = progress->value();
    ASSERT_LT(stood, 100);
    // As much as would have been enough to go on.
    int pictures = 0;
    QObject::connect(driven.workbench.camera(), &FrameSource::frameArrived, pause, [&] { ++pictures; });
    ASSERT_TRUE(driven.waitFor([&] { return pictures > 10; }));
    EXPECT_EQ(progress->value(), stood);
    EXPECT_TRUE(driven.session().measured().views.empty());
    ASSERT_TRUE(driven.click("pause"));
    EXPECT_EQ(pause->text(), "Pause");
    ASSERT_TRUE(driven.waitFor([&] { return driven.session().measured().views.size() == 1; }));
    EXPECT_FALSE(driven.session().measured().views.front().decoded.found.empty()) << "nothing was lost by it";
}

TEST(Clicks, ADroppedViewCountsNoMoreUntilItIsTakenBack) {
    DrivenWindow driven;
    driven.session().load(openedFrom(recordingOf(buildWorld(*findScenario("arm"), 1))));
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    ASSERT_TRUE(driven.goTo(Step::Scan));
    auto* views = driven.find<QComboBox>("views");
    EXPECT_FALSE(driven.find<QPushButton>("dropView")->isEnabled()) << "the camera's picture is no view";
    QTest::keyClick(views, Qt::Key_End);
    const auto used = [&] {
        const auto& all = driven.session().solution()->body.views;
        return std::count_if(all.begin(), all.end(),
                             [](const BodyView& view) { return view.T_body_camera.has_value(); });
    };
    const auto before = used();
    ASSERT_TRUE(driven.click("dropView"));
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    EXPECT_EQ(driven.session().decisions().droppedViews.count(views->currentText().toStdString()), 1U);
    EXPECT_EQ(used(), before - 1);
    EXPECT_EQ(driven.find<QPushButton>("dropView")->text(), "Take view back");
    driven.find<QAction>("undo")->trigger();
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    EXPECT_EQ(used(), before);
    EXPECT_EQ(driven.find<QPushButton>("dropView")->text(), "Drop view");
}

TEST(Clicks, AModuleOfTheNetworkBlinks) {
    DrivenWindow driven;
    ASSERT_TRUE(driven.connectSkin());
    auto* network = driven.window.findChild<NetworkView*>();
    ASSERT_FALSE(network->network().modules.empty());
    const FlatModule& module = network->network().modules.back();
    EXPECT_TRUE(driven.rig.litAt(RigClock::Time::max()).empty());
    QTest::mouseClick(network, Qt::LeftButton, {}, network->toWidget(module.centre).toPoint());
    ASSERT_TRUE(driven.waitFor([&] { return !driven.rig.litAt(RigClock::Time::max()).empty(); }));
    EXPECT_EQ(driven.rig.litAt(RigClock::Time::max()).front().module, module.module);
    EXPECT_EQ(driven.window.bodyView().selected(), std::vector{module.module});
    EXPECT_TRUE(driven.waitFor([&] { return driven.rig.litAt(RigClock::Time::max()).empty(); }))
        << "and goes out again";
}

TEST(Clicks, WhatAStepMarksInTheBodyGoesWithIt) {
    DrivenWindow driven;
    driven.session().load(openedFrom(recordingOf(buildWorld(*findScenario("arm"), 1))));
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    auto* network = driven.window.findChild<NetworkView*>();
    ASSERT_TRUE(driven.goTo(Step::Connect));
    QTest::mouseClick(network, Qt::LeftButton, {},
                      network->toWidget(network->network().modules.front().centre).toPoint());
    ASSERT_EQ(driven.window.bodyView().selected().size(), 1U);
    ASSERT_TRUE(driven.goTo(Step::Result));
    EXPECT_TRUE(driven.window.bodyView().selected().empty());
}

}  // namespace
}  // namespace skincal
