// Every kind of decision, made by clicks and keys, taken back and made again.

#include <gtest/gtest.h>

#include <QApplication>
#include <QComboBox>
#include <QListView>
#include <QTableView>
#include <set>

#include "tests/ui/window/driven_window.h"
#include "ui/presenters/detection_model.h"

namespace skincal {
namespace {

/// A session with one decision of every kind, each made by clicks and keys.
class Decided : public ::testing::Test {
  protected:
    [[nodiscard]] bool selectInTable(const char* accessibleName, int row) {
        for (auto* table : driven_.window.findChildren<QTableView*>()) {
            if (table->accessibleName() != QLatin1String(accessibleName) || !table->isVisible())
                continue;
            const QModelIndex index = table->model()->index(row, 0);
            table->scrollTo(index);
            QTest::mouseClick(table->viewport(), Qt::LeftButton, {}, table->visualRect(index).center());
            return table->selectionModel()->isRowSelected(row);
        }
        return false;
    }
    [[nodiscard]] bool showView(const char* key) {
        auto* views = driven_.find<QComboBox>("views");
        views->setFocus();
        QTest::keyClick(views, *key == '0' ? Qt::Key_Home : Qt::Key_End);
        if (*key == '0')
            QTest::keyClick(views, Qt::Key_Down);
        return driven_.find<QTableView>("detections")->model()->rowCount() > 0;
    }
    /// A shortcut of the window. There is no window manager that would make it the active one.
    void press(Qt::Key key, Qt::KeyboardModifiers modifiers) {
        QApplication::setActiveWindow(&driven_.window);
        QTest::keyClick(driven_.find<QListView>("problems"), key, modifiers);
    }
    [[nodiscard]] std::vector<Vector3d> places() {
        std::vector<Vector3d> places;
        for (const BodyModule& module : driven_.session().solution()->body.modules)
            places.push_back(module.T_body_module ? module.T_body_module->translation() : Vector3d(1e3, 0, 0));
        return places;
    }

    DrivenWindow driven_;
};

TEST_F(Decided, EveryKindIsUndoneAndRedoneByKeys) {
    Session& session = driven_.session();
    QUndoStack& undo = session.undoStack();
    std::vector<QString> steps;
    const auto made = [&](const char* text) {
        EXPECT_TRUE(undo.undoText().startsWith(QLatin1String(text)))
            << undo.undoText().toStdString() << " for " << text;
        EXPECT_FALSE(undo.canRedo());
        steps.push_back(undo.undoText());
    };
    ASSERT_TRUE(driven_.connectSkin());
    ASSERT_TRUE(driven_.capturePoses(4));
    made("Capture pose 4");
    ASSERT_TRUE(selectInTable("Captured poses", 1));
    ASSERT_TRUE(driven_.click("dropPose"));
    made("Drop pose 2");
    driven_.window.showStep(Step::Connect);
    ASSERT_TRUE(selectInTable("Links", 0));
    ASSERT_TRUE(driven_.click("callNeighbours"));
    EXPECT_EQ(session.decisions().links.size(), 1U);
    steps.push_back(undo.undoText());
    ASSERT_TRUE(driven_.useMakersIntrinsics());
    made("Use the maker's intrinsics");
    ASSERT_TRUE(driven_.scanHere());
    made("Scan view0");
    ASSERT_TRUE(driven_.moveCameraOn());
    ASSERT_TRUE(driven_.scanHere());
    made("Scan view1");

    ASSERT_TRUE(showView("0"));
    driven_.find<QTableView>("detections")->sortByColumn(DetectionModel::State, Qt::AscendingOrder);
    ASSERT_TRUE(selectInTable("Modules in this view", 0));
    ASSERT_TRUE(driven_.click("reject"));
    made("Reject 1 detection in view0");
    ASSERT_TRUE(driven_.click("accept")) << "what was rejected stays selected";
    made("Accept 1 detection in view0");
    ASSERT_TRUE(driven_.click("reject"));
    ASSERT_EQ(session.decisions().detections.size(), 1U);
    const auto oldPictures = session.findView("view0")->pictures;
    ASSERT_TRUE(driven_.click("scanAgain"));
    ASSERT_TRUE(driven_.waitFor([&] { return session.findView("view0")->pictures != oldPictures; }));
    made("Scan view0 again");
    EXPECT_TRUE(session.decisions().detections.empty()) << "it was about the other scan";
    ASSERT_TRUE(driven_.click("dropView"));
    made("Drop view0");
    EXPECT_EQ(session.decisions().droppedViews, std::set<std::string>{"view0"});

    ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
    const Decisions decided = session.decisions();
    const auto bodyBefore = places();
    const auto newPictures = session.findView("view0")->pictures;
    const int all = undo.count();
    for (int step = all; step > 0; --step) {
        EXPECT_EQ(undo.index(), step);
        press(Qt::Key_Z, Qt::ControlModifier);
    }
    EXPECT_FALSE(undo.canUndo());
    EXPECT_EQ(session.findView("view0")->pictures, oldPictures);
    EXPECT_TRUE(posesOf(session.measured(), session.decisions()).empty());
    EXPECT_EQ(session.decisions().droppedViews.size(), 2U) << "neither was scanned";
    EXPECT_TRUE(session.decisions().links.empty());
    EXPECT_TRUE(session.decisions().detections.empty());
    EXPECT_FALSE(session.decisions().camera);
    ASSERT_TRUE(driven_.waitFor([&] { return !session.solution() && !session.isSolving(); }));

    for (int step = 0; step < all; ++step)
        step % 2 == 0 ? press(Qt::Key_Y, Qt::ControlModifier)
                      : press(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
    EXPECT_FALSE(undo.canRedo());
    EXPECT_TRUE(session.decisions() == decided);
    EXPECT_EQ(session.findView("view0")->pictures, newPictures);
    ASSERT_TRUE(driven_.waitFor([&] { return driven_.isSolved(); }));
    EXPECT_EQ(places(), bodyBefore);
    EXPECT_GE(steps.size(), 10U);
}

TEST_F(Decided, ScanningAgainIsUndoneWithWhatWasDecidedAboutTheOldScan) {
    ASSERT_TRUE(driven_.connectSkin());
    ASSERT_TRUE(driven_.capturePoses(3));
    ASSERT_TRUE(driven_.useMakersIntrinsics());
    ASSERT_TRUE(driven_.scanHere());
    Session& session = driven_.session();
    driven_.find<QTableView>("detections")->sortByColumn(DetectionModel::State, Qt::AscendingOrder);
    ASSERT_TRUE(selectInTable("Modules in this view", 0));
    ASSERT_TRUE(driven_.click("reject"));
    const Decisions decided = session.decisions();
    const auto pictures = session.findView("view0")->pictures;
    ASSERT_TRUE(driven_.click("scanAgain"));
    ASSERT_TRUE(driven_.waitFor([&] { return session.findView("view0")->pictures != pictures; }));
    ASSERT_EQ(session.measured().views.size(), 1U);
    EXPECT_TRUE(session.decisions().detections.empty());
    press(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(session.findView("view0")->pictures, pictures);
    EXPECT_TRUE(session.decisions() == decided);
    const auto* rejected = driven_.find<QTableView>("detections")->model();
    int told = 0;
    for (int row = 0; row < rejected->rowCount(); ++row)
        told += rejected->index(row, DetectionModel::State).data().toString() == "rejected (your word)" ? 1 : 0;
    EXPECT_EQ(told, 1) << "the table follows";
    press(Qt::Key_Y, Qt::ControlModifier);
    EXPECT_NE(session.findView("view0")->pictures, pictures);
    EXPECT_TRUE(session.decisions().detections.empty());
}

}  // namespace
}  // namespace skincal
