// What the window is made of: its size, its buttons, how it begins.

#include <gtest/gtest.h>

#include <QAction>
#include <QComboBox>
#include <QHeaderView>
#include <QLabel>
#include <QTableView>

#include "core/workflow/simulated_recording.h"
#include "tests/ui/window/driven_window.h"
#include "ui/presenters/detection_model.h"
#include "ui/scene3d/body_view_widget.h"
#include "ui/widgets/curve_plot.h"
#include "ui/widgets/theme.h"

namespace skincal {
namespace {

bool isPrimary(const QPushButton* button) {
    return button->property("primary").toBool();
}

TEST(Frame, NoPageWidensTheWindow) {
    DrivenWindow driven;
    ASSERT_TRUE(driven.connectSkin());
    ASSERT_TRUE(driven.useMakersIntrinsics());
    driven.window.resize(1100, 720);
    for (const Step step : kSteps) {
        driven.window.showStep(step);
        for (int turn = 0; turn < 10; ++turn)
            QCoreApplication::processEvents();
        EXPECT_EQ(driven.window.size(), QSize(1100, 720)) << nameOf(step).toStdString();
        if (step == Step::Camera)
            driven.takePicture("n-camera");
        if (step == Step::Scan)
            driven.takePicture("n-scan");
    }
}

TEST(Frame, TheThemesButtonSaysWhatItGives) {
    DrivenWindow driven;
    auto* theme = driven.find<QAction>("theme");
    ASSERT_NE(theme, nullptr);
    driven.window.setDark(true);
    for (int time = 0; time < 2; ++time) {
        EXPECT_TRUE(theme->text().startsWith("Light"));
        theme->trigger();
        EXPECT_FALSE(Theme::current().isDark);
        EXPECT_TRUE(theme->text().startsWith("Dark"));
        theme->trigger();
        EXPECT_TRUE(Theme::current().isDark);
    }
}

TEST(Frame, TheNextSensibleStepIsTheHighlightedOne) {
    DrivenWindow driven;
    auto* connect = driven.find<QPushButton>("connect");
    auto* next = driven.find<QPushButton>("next");
    EXPECT_TRUE(isPrimary(connect));
    EXPECT_FALSE(isPrimary(next));
    ASSERT_TRUE(driven.connectSkin());
    EXPECT_FALSE(isPrimary(connect)) << "it disconnects now";
    EXPECT_TRUE(isPrimary(next));
    ASSERT_TRUE(driven.capturePoses(2));
    EXPECT_TRUE(isPrimary(driven.find<QPushButton>("turn")));
    EXPECT_TRUE(driven.find<QLabel>("poseVerdict")->text().startsWith("Not enough"));
    ASSERT_TRUE(driven.capturePoses(5));
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    EXPECT_TRUE(driven.find<QLabel>("poseVerdict")->text().contains("Enough"));
    EXPECT_FALSE(isPrimary(driven.find<QPushButton>("turn")));
    EXPECT_FALSE(driven.find<CurvePlot>("forecast")->goalText().isEmpty());
    // Ready to scan it does not ask for what comes before.
    ASSERT_TRUE(driven.useMakersIntrinsics());
    ASSERT_TRUE(driven.waitFor(
        [&] { return driven.steps().states()[static_cast<std::size_t>(Step::Scan)].reason == StepReason::FirstView; }));
}

TEST(Frame, BegunOnTheRigBothDevicesAreChosenAndTheSkinIsConnected) {
    DrivenWindow driven;
    EXPECT_EQ(driven.workbench.chosenSkin(), -1) << "without being asked it chooses nothing";
    driven.window.begin({0, 0});
    EXPECT_EQ(driven.workbench.chosenCamera(), 0);
    ASSERT_TRUE(driven.waitFor([&] { return driven.workbench.isSkinReady(); }));
    EXPECT_EQ(driven.window.step(), Step::Connect);
}

TEST(Frame, TheMakersIntrinsicsCanBeHadBack) {
    DrivenWindow driven;
    ASSERT_TRUE(driven.useMakersIntrinsics());
    auto* makers = driven.find<QPushButton>("makersIntrinsics");
    EXPECT_FALSE(makers->isEnabled()) << "they are in use";
    EXPECT_EQ(driven.session().decisions().cameraOrigin.kind, CameraOrigin::Kind::Nominal);
    EXPECT_FALSE(driven.session().decisions().cameraOrigin.date.empty());
    driven.session().decide("calibrate", [](Decisions& decisions) {
        decisions.camera->fx += 1;
        decisions.cameraOrigin = {CameraOrigin::Kind::Calibrated, "", 12, 0.2, "2026-11-26"};
    });
    EXPECT_TRUE(makers->isEnabled());
    ASSERT_TRUE(driven.click("makersIntrinsics"));
    EXPECT_EQ(driven.session().decisions().cameraOrigin.kind, CameraOrigin::Kind::Nominal);
}

TEST(Frame, APoseThatIsDroppedStaysSelectedAndItsMarksGoWithThePage) {
    DrivenWindow driven;
    driven.session().load(openedFrom(recordingOf(buildWorld(*findScenario("arm"), 1))));
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    driven.window.showStep(Step::Pose);
    QTableView* poses = nullptr;
    for (auto* table : driven.window.findChildren<QTableView*>()) {
        if (table->accessibleName() == "Captured poses")
            poses = table;
    }
    ASSERT_NE(poses, nullptr);
    poses->selectRow(2);
    const auto marked = driven.window.bodyView().selected();
    EXPECT_FALSE(marked.empty());
    ASSERT_TRUE(driven.click("dropPose"));
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    ASSERT_EQ(poses->selectionModel()->selectedRows().size(), 1);
    EXPECT_EQ(poses->selectionModel()->selectedRows().first().row(), 2);
    EXPECT_EQ(driven.find<QPushButton>("dropPose")->text(), "Take pose back");
    poses->clearSelection();
    EXPECT_TRUE(driven.window.bodyView().selected().empty());
    poses->selectRow(0);
    EXPECT_FALSE(driven.window.bodyView().selected().empty());
    driven.window.showStep(Step::Camera);
    EXPECT_TRUE(driven.window.bodyView().selected().empty());
    driven.window.showStep(Step::Pose);
    EXPECT_FALSE(driven.window.bodyView().selected().empty());
}

TEST(Frame, WhyADetectionDoesNotCountIsReadWithoutScrolling) {
    DrivenWindow driven;
    driven.session().load(openedFrom(recordingOf(buildWorld(*findScenario("arm"), 1))));
    ASSERT_TRUE(driven.waitFor([&] { return driven.isSolved(); }));
    driven.window.showStep(Step::Scan);
    auto* views = driven.find<QComboBox>("views");
    views->setCurrentIndex(1);
    auto* table = driven.find<QTableView>("detections");
    ASSERT_TRUE(driven.waitFor([&] { return table->model()->rowCount() > 0; }));
    for (int turn = 0; turn < 10; ++turn)
        QCoreApplication::processEvents();
    const int left = table->columnViewportPosition(DetectionModel::Reason);
    const QFontMetrics metrics(table->font());
    EXPECT_LT(left + metrics.horizontalAdvance("two spots blink its word"), table->viewport()->width());
    table->selectRow(0);
    driven.takePicture("n-detections");
}

}  // namespace
}  // namespace skincal
