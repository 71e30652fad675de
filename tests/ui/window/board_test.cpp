// The camera calibrated from a board that the rig's hands show, by clicks.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QAction>
#include <QComboBox>
#include <QLabel>
#include <QListView>
#include <QSpinBox>
#include <QTableView>
#include <QTemporaryDir>

#include "core/formats/camera_file.h"
#include "tests/ui/window/driven_window.h"
#include "ui/pages/calibration_dialog.h"

namespace skincal {
namespace {

class BoardWindow : public testing::Test {
  protected:
    [[nodiscard]] bool open() {
        driven.window.showStep(Step::Camera);
        return driven.click("calibrateHere") && dialog() != nullptr && dialog()->isVisible();
    }
    [[nodiscard]] CalibrationDialog* dialog() { return driven.find<CalibrationDialog>("calibration"); }
    [[nodiscard]] int taken() { return driven.find<QTableView>("boards")->model()->rowCount(); }
    [[nodiscard]] bool take(int count) {
        return driven.click("takeBoards") && driven.waitFor([&] { return taken() >= count; });
    }
    [[nodiscard]] bool canUse() { return driven.find<QPushButton>("useCalibration")->isEnabled(); }
    [[nodiscard]] std::string textOf(const char* label) { return driven.find<QLabel>(label)->text().toStdString(); }
    [[nodiscard]] std::string sentences() {
        std::string all;
        for (const QLabel* label : dialog()->findChildren<QLabel*>(QStringLiteral("instruction")))
            all += label->text().toStdString() + '\n';
        return all;
    }
    [[nodiscard]] bool isHeld() const { return driven.rig.heldBoard().has_value(); }

    DrivenWindow driven;
};

TEST_F(BoardWindow, LeadsFromABoardToIntrinsicsThatCanBeUndone) {
    ASSERT_TRUE(open());
    driven.takePictureOf(*dialog(), "9-board-start");
    EXPECT_FALSE(canUse());
    ASSERT_TRUE(take(6));
    EXPECT_TRUE(isHeld());
    EXPECT_FALSE(driven.find<QComboBox>("boardKind")->isEnabled()) << "boards of one kind only";
    driven.takePictureOf(*dialog(), "10-board-taking");
    ASSERT_TRUE(driven.waitFor([&] { return taken() >= 14 && canUse(); }));
    driven.takePictureOf(*dialog(), "11-board-done");
    // As small as it gets.
    const QSize before_px = dialog()->size();
    dialog()->resize(dialog()->minimumSizeHint());
    driven.takePictureOf(*dialog(), "15-board-small");
    EXPECT_LE(dialog()->width(), 1024);
    EXPECT_LE(dialog()->height(), 720) << "fits on a small screen";
    dialog()->resize(before_px);
    // What lies under the mouse is shown and removed.
    auto* table = driven.find<QTableView>("boards");
    table->scrollToTop();
    QTest::mouseClick(table->viewport(), Qt::LeftButton, {}, table->visualRect(table->model()->index(1, 0)).center());
    driven.takePictureOf(*dialog(), "12-board-chosen");
    ASSERT_TRUE(driven.click("takeBoards")) << "stops";
    EXPECT_FALSE(isHeld());
    const int before = taken();
    ASSERT_TRUE(driven.click("removeBoard"));
    EXPECT_EQ(taken(), before - 1);
    dialog()->activateWindow();
    ASSERT_TRUE(QTest::qWaitForWindowActive(dialog()));
    QTest::keyClick(dialog(), Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(taken(), before);
    QTest::mouseClick(table->viewport(), Qt::LeftButton, {}, table->visualRect(table->model()->index(1, 0)).center());
    ASSERT_TRUE(driven.click("removeBoard"));
    EXPECT_EQ(taken(), before - 1);
    ASSERT_TRUE(driven.waitFor([&] { return canUse(); })) << textOf("lensVerdict");

    const QTemporaryDir folder;
    dialog()->saveAs(folder.filePath("camera.yaml"), CameraFileKind::Ros);
    DrivenWindow::finishFiles();
    ASSERT_TRUE(driven.click("useCalibration"));
    EXPECT_FALSE(dialog()->isVisible());
    const auto& camera = driven.session().decisions().camera;
    ASSERT_TRUE(camera);
    const CameraModel& truth = driven.rig.world().scenario.camera;
    EXPECT_NEAR(camera->fx, truth.fx, 0.003 * truth.fx);
    EXPECT_NEAR(camera->fy, truth.fy, 0.003 * truth.fy);
    const auto saved = readCameraModel(folder.filePath("camera.yaml").toStdString());
    ASSERT_TRUE(saved) << saved.error().message();
    EXPECT_EQ(saved->fx, camera->fx);
    EXPECT_EQ(driven.steps().states()[static_cast<std::size_t>(Step::Camera)].status, StepStatus::Done);
    driven.takePicture("13-board-used");
    driven.find<QAction>("undo")->trigger();
    EXPECT_FALSE(driven.session().decisions().camera);
    driven.find<QAction>("redo")->trigger();
    EXPECT_TRUE(driven.session().decisions().camera);
}

TEST_F(BoardWindow, StoppedInTheMiddleAndClosedBoardsAreStillThere) {
    ASSERT_TRUE(open());
    ASSERT_TRUE(take(2));
    ASSERT_TRUE(driven.click("closeCalibration"));
    EXPECT_FALSE(isHeld());
    const int before = taken();
    ASSERT_TRUE(open());
    EXPECT_EQ(taken(), before);
    ASSERT_TRUE(take(before + 1));
    QTest::keyClick(dialog(), Qt::Key_Escape);
    EXPECT_FALSE(dialog()->isVisible());
    EXPECT_FALSE(isHeld());
    ASSERT_TRUE(open());
    ASSERT_TRUE(driven.click("startOver"));
    EXPECT_EQ(taken(), 0);
    EXPECT_TRUE(driven.find<QComboBox>("boardKind")->isEnabled());
    ASSERT_TRUE(driven.click("takeBoardBack"));
    EXPECT_GT(taken(), before);
    EXPECT_FALSE(driven.find<QPushButton>("takeBoardBack")->isEnabled());
}

TEST_F(BoardWindow, LeavingThePageEndsIt) {
    ASSERT_TRUE(open());
    ASSERT_TRUE(take(1));
    driven.window.showStep(Step::Scan);
    EXPECT_FALSE(dialog()->isVisible());
    EXPECT_FALSE(isHeld());
    ASSERT_TRUE(open());
    ASSERT_TRUE(take(2));
}

TEST_F(BoardWindow, APulledCameraEndsItWithAWordAndItGoesOnOncePluggedIn) {
    ASSERT_TRUE(open());
    ASSERT_TRUE(take(1));
    driven.rig.pullCamera();
    ASSERT_TRUE(driven.waitFor([&] { return !isHeld(); }));
    EXPECT_TRUE(dialog()->isVisible());
    EXPECT_THAT(sentences(), testing::HasSubstr("unplugged"));
    EXPECT_EQ(driven.find<QPushButton>("takeBoards")->text(), "Start");
    driven.takePictureOf(*dialog(), "14-board-unplugged");
    ASSERT_TRUE(driven.click("takeBoards"));
    ASSERT_TRUE(driven.waitFor([&] { return !isHeld(); })) << "still unplugged";
    EXPECT_THAT(sentences(), testing::HasSubstr("no camera"));
    driven.rig.plugCamera();
    ASSERT_TRUE(take(2));
}

TEST_F(BoardWindow, PrintsTheBoardThatIsDescribedAndSaysWhatCanBeNone) {
    ASSERT_TRUE(open());
    const QTemporaryDir folder;
    dialog()->printBoard(folder.filePath("board.pdf"));
    DrivenWindow::finishFiles();
    EXPECT_TRUE(QFile::exists(folder.filePath("board.pdf")));
    EXPECT_THAT(sentences(), testing::HasSubstr("Written"));
    dialog()->printBoard(folder.filePath("nowhere/board.pdf"));
    DrivenWindow::finishFiles();
    EXPECT_THAT(sentences(), testing::HasSubstr("can't be written"));
    dialog()->saveAs(folder.filePath("camera.yaml"), CameraFileKind::Ros);
    DrivenWindow::finishFiles();
    EXPECT_FALSE(QFile::exists(folder.filePath("camera.yaml"))) << "there is none yet";
    // 40 columns of squares need more markers than the dictionary has.
    driven.find<QSpinBox>("boardColumns")->setValue(40);
    EXPECT_FALSE(driven.find<QPushButton>("takeBoards")->isEnabled());
    EXPECT_FALSE(driven.find<QPushButton>("printBoard")->isEnabled());
    driven.find<QComboBox>("boardKind")->setCurrentIndex(1);
    EXPECT_TRUE(driven.find<QPushButton>("printBoard")->isEnabled());
}

}  // namespace
}  // namespace skincal
