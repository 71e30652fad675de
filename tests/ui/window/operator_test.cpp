// What an operator does besides going straight on: rejects, drops, overrules, goes back, cancels, pulls cables.

#include <gtest/gtest.h>

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <QListView>
#include <QTableView>
#include <set>

#include "core/geometry/random.h"
#include "core/workflow/simulated_recording.h"
#include "tests/ui/window/driven_window.h"
#include "ui/presenters/detection_model.h"

namespace skincal {
namespace {

/// The body of a simulated recording, opened in the window.
class Opened : public ::testing::Test {
  protected:
    void open(const std::string& scenario, const std::function<void(OpenedRecording&)>& change = {}) {
        world_ = buildWorld(*findScenario(scenario), 1);
        OpenedRecording opened = openedFrom(recordingOf(world_));
        if (change)
            change(opened);
        driven_.session().load(std::move(opened));
        ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
    }

    [[nodiscard]] double errorOf(ModuleId module, ModuleId reference) {
        const BodyModel& body = driven_.session().solution()->body;
        const auto index = world_.skin.indexById();
        const auto poseOf = [&](ModuleId id) { return *body.modules.at(index.at(id)).T_body_module; };
        const Vector3d ours = (poseOf(reference).inverse() * poseOf(module)).translation();
        const Vector3d truth =
            (world_.T_r_u[index.at(reference)].inverse() * world_.T_r_u[index.at(module)]).translation();
        return (ours - truth).norm();
    }

    /// A row of the list of problems that says this; clicked.
    [[nodiscard]] bool clickProblem(const QString& text) {
        auto* list = driven_.find<QListView>("problems");
        for (int row = 0; row < list->model()->rowCount(); ++row) {
            const QModelIndex index = list->model()->index(row, 0);
            if (!index.data().toString().contains(text, Qt::CaseInsensitive))
                continue;
            list->scrollTo(index);
            QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, list->visualRect(index).center());
            return true;
        }
        return false;
    }
    [[nodiscard]] bool hasProblem(const QString& text) {
        const auto* model = driven_.find<QListView>("problems")->model();
        for (int row = 0; row < model->rowCount(); ++row) {
            if (model->index(row, 0).data().toString().contains(text, Qt::CaseInsensitive))
                return true;
        }
        return false;
    }
    void press(const char* action) { driven_.find<QAction>(action)->trigger(); }

    DrivenWindow driven_;
    World world_;
};

TEST_F(Opened, RejectingPlantedFalseDetectionsImprovesTheModel) {
    // All spots of one patch are off in one of two views, as in a mirror: which of the two is right nothing can tell.
    std::set<ModuleId> planted;
    ModuleId reference;
    open("freeform", [&](OpenedRecording& opened) {
        const World world = buildWorld(*findScenario("freeform"), 1);
        auto& views = opened.measured.views;
        views.resize(2);
        const auto index = world.skin.indexById();
        for (LedDetection& spot : views[1].decoded.found) {
            if (world.patchOf[index.at(spot.module)] == 1) {
                spot.pixel += Vector2d(12, -7);
                planted.insert(spot.module);
            } else {
                reference = spot.module;
            }
        }
    });
    ASSERT_FALSE(planted.empty());
    const ModuleId victim = *planted.begin();
    const double before = errorOf(victim, reference);
    driven_.window.showStep(Step::Scan);
    auto* table = driven_.find<QTableView>("detections");
    auto* views = driven_.find<QComboBox>("views");
    views->setFocus();
    QTest::keyClick(views, Qt::Key_End);
    ASSERT_TRUE(driven_.waitFor([&] { return table->model()->rowCount() > 0; }));
    table->sortByColumn(DetectionModel::Module, Qt::AscendingOrder);
    for (int row = 0; row < table->model()->rowCount(); ++row) {
        const QModelIndex index = table->model()->index(row, DetectionModel::Module);
        if (!planted.contains(ModuleId{index.data().toUInt()}))
            continue;
        table->scrollTo(index);
        QTest::mouseClick(table->viewport(), Qt::LeftButton, Qt::ControlModifier, table->visualRect(index).center());
    }
    ASSERT_TRUE(driven_.click("reject"));
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
    EXPECT_EQ(driven_.session().decisions().detections.size(), planted.size());
    EXPECT_LT(errorOf(victim, reference), 0.7 * before);
    press("undo");
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
    EXPECT_NEAR(errorOf(victim, reference), before, 1e-6) << "one step of undo takes all of it back";
}

TEST_F(Opened, AShakenPoseIsAProblemThatLeadsToWhereItIsDropped) {
    open("freeform", [](OpenedRecording& opened) {
        Random random(1, "shaken pose");
        int last = 0;
        for (const GravityReading& reading : opened.measured.gravity)
            last = std::max(last, reading.pose);
        for (GravityReading& reading : opened.measured.gravity) {
            if (reading.pose == last)
                reading.acceleration += 1.0 * random.normal3();
        }
    });
    ASSERT_TRUE(hasProblem("pose")) << "the shaken pose is named";
    ASSERT_TRUE(clickProblem("pose"));
    EXPECT_EQ(driven_.window.step(), Step::Pose);
    ASSERT_TRUE(driven_.click("dropPose"));
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
    EXPECT_EQ(driven_.session().decisions().droppedPoses.size(), 1U);
    for (const Finding& finding : driven_.session().solution()->body.quality.findings)
        EXPECT_NE(finding.kind, Finding::Kind::ShakenPose);
}

TEST_F(Opened, ACableIsOverruledAndTheWordTakenBack) {
    open("arm");
    const auto patches = driven_.session().solution()->body.patches.size();
    driven_.window.showStep(Step::Connect);
    auto* links = driven_.find<QTableView>("links");
    const QModelIndex cable = links->model()->index(0, 0);
    QTest::mouseClick(links->viewport(), Qt::LeftButton, {}, links->visualRect(cable).center());
    ASSERT_TRUE(driven_.click("callNeighbours"));
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
    EXPECT_LT(driven_.session().solution()->body.patches.size(), patches) << "two patches have become one";
    press("undo");
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
    EXPECT_EQ(driven_.session().solution()->body.patches.size(), patches);
}

TEST_F(Opened, UndoingAllAndRedoingAllGivesTheSameBodies) {
    open("freeform");
    const auto posesOfBody = [&] {
        std::vector<Vector3d> places;
        for (const BodyModule& module : driven_.session().solution()->body.modules)
            places.push_back(module.T_body_module ? module.T_body_module->translation() : Vector3d(1e3, 0, 0));
        return places;
    };
    const auto atFirst = posesOfBody();
    Session& session = driven_.session();
    session.decide("drop a pose", [](Decisions& decisions) { decisions.droppedPoses.insert(2); });
    session.decide("drop a view",
                   [&](Decisions& decisions) { decisions.droppedViews.insert(session.measured().views.back().name); });
    const LedDetection& spot = session.measured().views.front().decoded.found.front();
    session.decide("reject", [&](Decisions& decisions) {
        const std::string& view = session.measured().views.front().name;
        decisions.detections[{view, spot.module}] = {view, spot.module, "rejected", ""};
    });
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
    const auto atLast = posesOfBody();
    while (session.undoStack().canUndo())
        press("undo");
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
    EXPECT_EQ(posesOfBody(), atFirst);
    while (session.undoStack().canRedo())
        press("redo");
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
    EXPECT_EQ(posesOfBody(), atLast);
}

TEST_F(Opened, WhatIsFilteredAndSelectedIsRejectedInBulk) {
    std::set<ModuleId> planted;
    open("freeform", [&](OpenedRecording& opened) {
        auto& found = opened.measured.views.front().decoded.found;
        for (const std::size_t k : {2U, 9U, 14U}) {
            found.at(k).pixel += Vector2d(6, 4);
            planted.insert(found.at(k).module);
        }
    });
    driven_.window.showStep(Step::Scan);
    auto* views = driven_.find<QComboBox>("views");
    views->setFocus();
    QTest::keyClick(views, Qt::Key_Home);
    QTest::keyClick(views, Qt::Key_Down);
    auto* table = driven_.find<QTableView>("detections");
    const int all = table->model()->rowCount();
    ASSERT_GT(all, 20);
    auto* limit = driven_.find<QDoubleSpinBox>("residualLimit");
    limit->setFocus();
    limit->selectAll();
    QTest::keyClicks(limit, "3");
    QTest::keyClick(limit, Qt::Key_Return);
    EXPECT_EQ(table->model()->rowCount(), all) << "a limit alone hides nothing";
    auto* above = driven_.find<QCheckBox>("residualAbove");
    above->setFocus();
    QTest::keyClick(above, Qt::Key_Space);
    EXPECT_EQ(table->model()->rowCount(), static_cast<int>(planted.size()));
    EXPECT_EQ(driven_.find<QLabel>("shownCount")->text(), QStringLiteral("%1 of %2").arg(planted.size()).arg(all));
    table->setFocus();
    QTest::keyClick(table, Qt::Key_A, Qt::ControlModifier);
    ASSERT_TRUE(driven_.click("reject"));
    std::set<ModuleId> rejected;
    for (const auto& [key, decision] : driven_.session().decisions().detections)
        rejected.insert(key.module);
    EXPECT_EQ(rejected, planted) << "what is not shown is not touched";
    QTest::keyClick(above, Qt::Key_Space);
    EXPECT_EQ(table->model()->rowCount(), all);
    auto* number = driven_.find<QLineEdit>("findModule");
    QTest::keyClicks(number, QString::number(planted.begin()->value));
    EXPECT_LT(table->model()->rowCount(), all);
    EXPECT_GE(table->model()->rowCount(), 1);
}

TEST(Interrupted, ScanningFromTheViewsPageScans) {
    DrivenWindow driven;
    ASSERT_TRUE(driven.connectSkin());
    ASSERT_TRUE(driven.capturePoses(3));
    ASSERT_TRUE(driven.useMakersIntrinsics());
    ASSERT_TRUE(driven.scanHere());
    ASSERT_TRUE(driven.moveCameraOn());
    ASSERT_TRUE(driven.waitFor([&] { return driven.find<QPushButton>("scanHere")->isEnabled(); }));
    ASSERT_TRUE(driven.click("scanHere"));
    EXPECT_EQ(driven.window.step(), Step::Scan);
    EXPECT_TRUE(driven.waitFor([&] { return driven.session().measured().views.size() == 2; }));
}

TEST(Interrupted, CancelAtEveryStepLeavesNothingBehind) {
    DrivenWindow driven;
    ASSERT_TRUE(driven.click("connect"));
    ASSERT_TRUE(driven.click("connect")) << "cancels while it opens or explores";
    EXPECT_FALSE(driven.workbench.isSkinReady());
    EXPECT_TRUE(driven.session().measured().skin.modules.empty());
    ASSERT_TRUE(driven.connectSkin());
    ASSERT_TRUE(driven.capturePoses(3));
    ASSERT_TRUE(driven.useMakersIntrinsics());
    driven.window.showStep(Step::Scan);
    ASSERT_TRUE(driven.click("scan"));
    ASSERT_TRUE(driven.click("scan")) << "cancels";
    EXPECT_TRUE(driven.session().measured().views.empty());
    ASSERT_TRUE(driven.scanHere()) << "and can be begun again";
    EXPECT_EQ(driven.session().measured().views.size(), 1U);
}

TEST(Interrupted, PulledCablesAreProblemsAndThingsGoOnOncePluggedIn) {
    DrivenWindow driven;
    ASSERT_TRUE(driven.connectSkin());
    ASSERT_TRUE(driven.capturePoses(3));
    ASSERT_TRUE(driven.useMakersIntrinsics());
    driven.window.showStep(Step::Scan);
    ASSERT_TRUE(driven.click("scan"));
    driven.rig.pullSkin();
    const auto statusOf = [&](Step step) { return driven.steps().states()[static_cast<std::size_t>(step)].status; };
    ASSERT_TRUE(driven.waitFor([&] { return statusOf(Step::Connect) == StepStatus::NeedsAttention; }));
    EXPECT_TRUE(driven.session().measured().views.empty());
    EXPECT_EQ(posesOf(driven.session().measured(), driven.session().decisions()).size(), 3U) << "nothing is lost";
    driven.rig.plugSkin();
    ASSERT_TRUE(driven.connectSkin());
    EXPECT_EQ(posesOf(driven.session().measured(), driven.session().decisions()).size(), 3U);
    driven.window.showStep(Step::Scan);
    ASSERT_TRUE(driven.click("scan"));
    driven.rig.pullCamera();
    ASSERT_TRUE(driven.waitFor([&] { return statusOf(Step::Camera) == StepStatus::NeedsAttention; }));
    EXPECT_TRUE(driven.session().measured().views.empty());
    driven.rig.plugCamera();
    driven.window.showStep(Step::Camera);
    ASSERT_TRUE(driven.waitFor([&] { return statusOf(Step::Camera) == StepStatus::Done; }));
    ASSERT_TRUE(driven.scanHere());
}

TEST(Interrupted, TheWindowMayBeClosedInTheMiddleOfAnything) {
    for (int stage = 0; stage < 5; ++stage) {
        auto driven = std::make_unique<DrivenWindow>();
        if (stage == 0) {
            ASSERT_TRUE(driven->click("connect"));
        }
        if (stage >= 1) {
            ASSERT_TRUE(driven->connectSkin());
        }
        if (stage >= 2) {
            ASSERT_TRUE(driven->capturePoses(3));
        }
        if (stage >= 3) {
            ASSERT_TRUE(driven->useMakersIntrinsics());
            driven->window.showStep(Step::Scan);
            ASSERT_TRUE(driven->click("scan"));
        }
        if (stage == 4) {
            ASSERT_TRUE(driven->waitFor([&] { return driven->session().measured().views.size() == 1; }));
        }
        driven->window.close();
        driven.reset();
    }
}

}  // namespace
}  // namespace skincal
