#include "ui/presenters/board_presenter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QAbstractItemModelTester>
#include <QSignalSpy>

#include "tests/ui/presenters/desk.h"
#include "ui/presenters/board_model.h"
#include "ui/presenters/board_words.h"
#include "ui/presenters/lens_words.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;
using test::Desk;
using test::waitFor;

/// A camera of half the size: four times as quick to draw.
Scenario smallCamera() {
    Scenario scenario = *findScenario("coded");
    CameraModel& camera = scenario.camera;
    camera.width /= 2;
    camera.height /= 2;
    camera.fx /= 2;
    camera.fy /= 2;
    camera.cx = (camera.cx + 0.5) / 2 - 0.5;
    camera.cy = (camera.cy + 0.5) / 2 - 0.5;
    return scenario;
}

class BoardDesk : public testing::Test {
  protected:
    BoardDesk() : desk(smallCamera()), boards(std::make_unique<BoardPresenter>(desk.workbench, desk.scan)) {
        desk.workbench.chooseCamera(0);
        desk.scan.setActive(true);
    }

    [[nodiscard]] std::size_t taken() const { return boards->boards().views().size(); }
    [[nodiscard]] bool take(std::size_t count) {
        boards->start();
        return waitFor([&] { return taken() >= count; });
    }
    [[nodiscard]] bool takeUntilUsable() {
        boards->start();
        return waitFor([&] { return boards->canAccept(); });
    }
    /// All that the collector asks for.
    [[nodiscard]] bool takeEnough() {
        boards->start();
        return waitFor([&] { return boards->wish().isEmpty() && boards->canAccept(); });
    }

    Desk desk;
    std::unique_ptr<BoardPresenter> boards;
};

void expectNear(double found, double truth, double sigma) {
    EXPECT_NEAR(found, truth, 4 * sigma) << "as far as it says itself";
}

TEST_F(BoardDesk, FindsTheRigsLensWithinItsOwnUncertainty) {
    const CameraModel truth = desk.rig.world().scenario.camera;
    BoardPlan chess;
    chess.kind = BoardKind::Chessboard;
    for (const BoardPlan& plan : {BoardPlan{}, chess}) {
        boards->setPlan(plan);
        ASSERT_TRUE(takeEnough());
        boards->stop();
        ASSERT_TRUE(waitFor([&] { return boards->canAccept(); }));
        const CameraCalibration& calibration = *boards->calibration();
        EXPECT_LT(calibration.rms_px, 0.25);
        ASSERT_TRUE(calibration.sigma);
        EXPECT_LT(calibration.sigma->fx, 0.003 * truth.fx);
        EXPECT_LT(calibration.sigma->fy, 0.003 * truth.fy);
        expectNear(calibration.camera.fx, truth.fx, calibration.sigma->fx);
        expectNear(calibration.camera.fy, truth.fy, calibration.sigma->fy);
        expectNear(calibration.camera.cx, truth.cx, calibration.sigma->cx);
        expectNear(calibration.camera.cy, truth.cy, calibration.sigma->cy);
        EXPECT_TRUE(calibration.rejected.empty());
    }
}

TEST_F(BoardDesk, AcceptedItIsOneUndoableDecisionThatSaysWhereItIsFrom) {
    EXPECT_FALSE(boards->canAccept());
    boards->accept();
    EXPECT_FALSE(desk.session().decisions().camera);
    ASSERT_TRUE(takeUntilUsable());
    boards->stop();
    ASSERT_TRUE(waitFor([&] { return boards->canAccept(); }));
    const CameraModel found = boards->calibration()->camera;
    boards->accept();
    ASSERT_TRUE(desk.session().decisions().camera);
    EXPECT_EQ(desk.session().decisions().camera->fx, found.fx);
    EXPECT_THAT(desk.session().undoStack().undoText().toStdString(), testing::ContainsRegex("from [0-9]+ boards, rms"));
    const CameraOrigin& origin = desk.session().decisions().cameraOrigin;
    EXPECT_EQ(origin.kind, CameraOrigin::Kind::Calibrated);
    EXPECT_EQ(origin.rms_px, boards->calibration()->rms_px);
    EXPECT_THAT(sentenceOf(origin).toStdString(),
                testing::MatchesRegex("calibrated from [0-9]+ boards, rms .* px, on 20..-..-.."));
    desk.session().undoStack().undo();
    EXPECT_FALSE(desk.session().decisions().camera);
    EXPECT_EQ(desk.session().decisions().cameraOrigin, CameraOrigin());
    desk.session().undoStack().redo();
    EXPECT_EQ(desk.session().decisions().camera->fx, found.fx);
}

TEST_F(BoardDesk, SaysWhyABoardIsRefusedAndWhenOneIsTaken) {
    std::set<std::string> said;
    const QObject here;
    QObject::connect(boards.get(), &BoardPresenter::sightChanged, &here,
                     [&] { said.insert(boards->sight().sentence.toStdString()); });
    // One that nobody holds.
    const auto hold = std::exchange(desk.workbench.hands->holdBoard, nullptr);
    boards->start();
    ASSERT_TRUE(waitFor([&] { return boards->sight().kind == BoardSight::Kind::Refused; }));
    EXPECT_FALSE(boards->sight().view);
    EXPECT_THAT(boards->sight().sentence.toStdString(), testing::HasSubstr("No such board"));
    boards->stop();
    EXPECT_EQ(boards->sight().sentence, "");
    desk.workbench.hands->holdBoard = hold;
    const auto wish = boards->wish();
    EXPECT_FALSE(wish.isEmpty());
    ASSERT_TRUE(take(3));
    EXPECT_THAT(said, testing::Contains("Board 2 taken."));
    EXPECT_THAT(said, testing::Contains(sentenceOf(OfferOutcome::Moving).toStdString()));
    // Again from the first place: all of it is known by now.
    ASSERT_TRUE(waitFor([&] { return taken() >= 12; }));
    desk.rig.holdBoard(boards->plan());
    ASSERT_TRUE(waitFor([&] { return said.contains(sentenceOf(OfferOutcome::Redundant).toStdString()); }));
}

TEST(BoardPresenter, OutOfFocusNoBoardIsTaken) {
    Scenario scenario = smallCamera();
    scenario.pictures.blur_px = 2.5;
    Desk desk(scenario);
    std::set<std::string> said;
    BoardPresenter boards(desk.workbench, desk.scan);
    // Squares so large that their edges show all of the blur.
    BoardPlan plan;
    plan.kind = BoardKind::Chessboard;
    plan.columns = 6;
    plan.rows = 4;
    boards.setPlan(plan);
    desk.workbench.chooseCamera(0);
    QObject::connect(&boards, &BoardPresenter::sightChanged, &boards, [&] {
        said.insert(boards.sight().sentence.left(7).toStdString());
        EXPECT_FALSE(boards.sight().view);
    });
    boards.start();
    pass(desk.rig.clock(), 2s);
    EXPECT_TRUE(waitFor([&] { return said.contains("Blurred"); }));
    EXPECT_TRUE(boards.boards().views().empty());
}

TEST_F(BoardDesk, StopsInTheMiddleAndGoesOn) {
    ASSERT_TRUE(take(2));
    boards->stop();
    EXPECT_FALSE(boards->isLooking());
    EXPECT_FALSE(desk.rig.heldBoard());
    const std::size_t before = taken();
    pass(desk.rig.clock(), 3s);
    EXPECT_EQ(taken(), before) << "what was being searched is late";
    EXPECT_FALSE(boards->sight().view);
    ASSERT_TRUE(take(before + 1));
}

TEST_F(BoardDesk, MayBeDestroyedAtAnyTime) {
    for (std::size_t count = 0; count <= BoardPresenter::kLeastBoards; ++count) {
        boards = std::make_unique<BoardPresenter>(desk.workbench, desk.scan);
        ASSERT_TRUE(take(count));
        boards.reset();
        EXPECT_FALSE(desk.rig.heldBoard());
    }
    pass(desk.rig.clock(), 1s);
}

TEST_F(BoardDesk, ACameraThatIsPulledOrChangedEndsIt) {
    const QSignalSpy interrupted(boards.get(), &BoardPresenter::interrupted);
    ASSERT_TRUE(take(2));
    desk.rig.pullCamera();
    ASSERT_TRUE(waitFor([&] { return interrupted.count() == 1; }));
    EXPECT_THAT(interrupted.at(0).at(0).toString().toStdString(), testing::HasSubstr("unplugged"));
    EXPECT_FALSE(boards->isLooking());
    EXPECT_FALSE(desk.rig.heldBoard());
    EXPECT_GE(taken(), 2U) << "it is the same camera once it is plugged in again";
    desk.rig.plugCamera();
    const std::size_t before = taken();
    ASSERT_TRUE(take(before + 1));
    desk.workbench.chooseCamera(1);
    EXPECT_EQ(interrupted.count(), 2);
    EXPECT_FALSE(boards->isLooking());
    EXPECT_EQ(taken(), 0U) << "these were of another lens";
}

TEST_F(BoardDesk, ARemovedBoardIsOutAndTheRestIsCalibratedAnew) {
    BoardModel model(*boards);
    const QAbstractItemModelTester tester(&model, QAbstractItemModelTester::FailureReportingMode::Fatal);
    ASSERT_TRUE(take(BoardPresenter::kLeastBoards + 1));
    boards->stop();
    ASSERT_TRUE(waitFor([&] { return boards->calibration() && !boards->isCalibrating(); }));
    const auto rows = static_cast<std::size_t>(model.rowCount());
    EXPECT_EQ(rows, taken());
    EXPECT_EQ(boards->calibration()->boards.size(), rows);
    boards->remove(1);
    EXPECT_EQ(static_cast<std::size_t>(model.rowCount()), rows - 1);
    EXPECT_EQ(model.index(0, BoardModel::Residual).data().toString(), "–");
    ASSERT_TRUE(waitFor([&] { return boards->calibration() != nullptr; }));
    EXPECT_EQ(boards->calibration()->boards.size(), rows - 1);
    EXPECT_GT(model.index(0, BoardModel::Residual).data().toString().toDouble(), 0);
    while (taken() >= BoardPresenter::kLeastBoards)
        boards->remove(0);
    ASSERT_TRUE(waitFor([&] { return !boards->isCalibrating(); }));
    EXPECT_EQ(boards->calibration(), nullptr) << "too few";
    boards->clear();
    EXPECT_EQ(model.rowCount(), 0);
    // All of it can be taken back, step by step.
    while (boards->canTakeBack()) {
        const std::size_t before = taken();
        boards->takeBack();
        EXPECT_GT(taken(), before);
        EXPECT_EQ(static_cast<std::size_t>(model.rowCount()), taken());
    }
    EXPECT_EQ(taken(), rows);
    boards->takeBack();
    EXPECT_EQ(taken(), rows);
    ASSERT_TRUE(waitFor([&] { return boards->calibration() && !boards->isCalibrating(); }));
    EXPECT_EQ(boards->calibration()->boards.size(), rows);
}

TEST_F(BoardDesk, AnotherPlanForgetsTheBoardsAnotherLensDoesNot) {
    ASSERT_TRUE(take(BoardPresenter::kLeastBoards));
    boards->setPlan(boards->plan());
    EXPECT_GE(taken(), BoardPresenter::kLeastBoards);
    boards->stop();
    boards->setLens(DistortionModel::Equidistant);
    ASSERT_TRUE(waitFor([&] { return boards->calibration() && !boards->isCalibrating(); }));
    EXPECT_EQ(boards->calibration()->camera.distortionModel, DistortionModel::Equidistant);
    boards->start();
    BoardPlan other = boards->plan();
    other.columns = 7;
    boards->remove(0);
    EXPECT_TRUE(boards->canTakeBack());
    boards->setPlan(other);
    EXPECT_EQ(taken(), 0U);
    EXPECT_FALSE(boards->canTakeBack()) << "these are of another board";
    EXPECT_EQ(desk.rig.heldBoard()->plan().columns, 7) << "whoever holds it takes the other one";
    ASSERT_TRUE(take(1));
}

TEST(BoardWords, SayWhatIsWrongWithAPlan) {
    EXPECT_EQ(planFault({}), "");
    BoardPlan plan;
    plan.marker = 0.9999 * plan.square;
    EXPECT_THAT(planFault(plan).toStdString(), testing::HasSubstr("22.5 mm"));
    plan = {};
    plan.columns = 2;
    EXPECT_THAT(planFault(plan).toStdString(), testing::HasSubstr("squares"));
    plan = {};
    plan.columns = plan.rows = 20;
    EXPECT_THAT(planFault(plan).toStdString(), testing::HasSubstr("200"));
}

}  // namespace
}  // namespace skincal
