#include "ui/presenters/view_preview.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QSignalSpy>

#include "tests/ui/presenters/desk.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;
using test::Desk;
using test::waitFor;
using Verdict = ViewPreview::Verdict;

/// A desk with a body of which the patches are known, and a camera that runs.
class Preview : public ::testing::Test {
  protected:
    void SetUp() override {
        ASSERT_TRUE(desk_.connectSkin());
        ASSERT_TRUE(desk_.capturePoses(4));
        ASSERT_TRUE(desk_.startCamera());
        ASSERT_TRUE(waitFor([&] { return desk_.isSolved(); }));
    }
    [[nodiscard]] bool look() {
        const QSignalSpy changed(&desk_.preview, &ViewPreview::changed);
        desk_.preview.setActive(true);
        return waitFor([&] { return changed.count() > 0 && desk_.preview.verdict() != Verdict::Unknown; });
    }

    Desk desk_;
};

TEST_F(Preview, CountsTheSpotsOfEachPatchWhereTheyAre) {
    ASSERT_TRUE(look());
    EXPECT_EQ(desk_.preview.verdict(), Verdict::Good) << desk_.preview.words().toStdString();
    const World& world = desk_.rig.world();
    const auto index = world.skin.indexById();
    const auto& patches = desk_.session().solution()->body.patches;
    ASSERT_EQ(desk_.preview.patches().size(), patches.size());
    std::size_t seen = 0;
    for (const SpotInSight& spot : desk_.preview.spots()) {
        double nearest = 1e9;
        for (const ModuleId module : patches[spot.patch].modules) {
            Visibility any;
            any.maxAngle = 89 * kDegree;
            if (const auto pixel = visiblePixel(world, desk_.rig.cameraPose(), 0, index.at(module), any))
                nearest = std::min(nearest, (*pixel - spot.pixel).norm());
        }
        EXPECT_LT(nearest, 2.0) << "of patch " << patches[spot.patch].id.value << " at " << spot.pixel.transpose();
        ++seen;
    }
    EXPECT_GT(seen, 5U);
    ASSERT_TRUE(desk_.scanHere());
    const std::size_t found = desk_.session().measured().views.back().decoded.found.size();
    EXPECT_LE(std::max(found, seen) - std::min(found, seen), 2U) << found << " found, " << seen << " foreseen";
}

TEST_F(Preview, LeavesTheLightsToAScanAndGoesOnAfterwards) {
    ASSERT_TRUE(look());
    const QSignalSpy changed(&desk_.preview, &ViewPreview::changed);
    ASSERT_TRUE(desk_.scanHere());
    for (const LedDetection& led : desk_.session().measured().views.back().decoded.found)
        EXPECT_GT(led.sigma_px, 0);
    const auto before = changed.count();
    EXPECT_TRUE(waitFor([&] { return changed.count() > before; }));
}

TEST_F(Preview, SaysThatAViewWasTakenFromHere) {
    ASSERT_TRUE(look());
    EXPECT_EQ(desk_.preview.verdict(), Verdict::Good);
    ASSERT_TRUE(desk_.scanHere());
    ASSERT_TRUE(waitFor([&] { return desk_.preview.verdict() == Verdict::SamePlace; }));
    const std::string view = desk_.session().measured().views.back().name;
    EXPECT_THAT(desk_.preview.words().toStdString(), testing::HasSubstr(view));
    // One that does not count is no reason to go elsewhere.
    desk_.session().decide("drop", [&](Decisions& decisions) { decisions.droppedViews.insert(view); });
    EXPECT_TRUE(waitFor([&] { return desk_.preview.verdict() == Verdict::Good; }));
    desk_.session().undoStack().undo();
    ASSERT_TRUE(waitFor([&] { return desk_.preview.verdict() == Verdict::SamePlace; }));
    ASSERT_TRUE(desk_.moveCamera());
    EXPECT_TRUE(waitFor([&] { return desk_.preview.verdict() == Verdict::Good; }))
        << desk_.preview.words().toStdString();
}

TEST_F(Preview, SaysThatNothingIsInThePicture) {
    // Away from the body.
    Isometry3d away = desk_.rig.cameraPose();
    away.linear() = away.linear() * so3Exp(Vector3d(0, 2.8, 0));
    desk_.rig.moveCamera(away);
    ASSERT_TRUE(waitFor([&] { return desk_.rig.isCameraAtRest(); }));
    ASSERT_TRUE(look());
    EXPECT_EQ(desk_.preview.verdict(), Verdict::Nothing);
    EXPECT_THAT(desk_.preview.words().toStdString(), testing::HasSubstr("no patch"));
    EXPECT_TRUE(desk_.preview.spots().empty());
}

TEST_F(Preview, StopsWithTheLightsOff) {
    ASSERT_TRUE(look());
    desk_.preview.setActive(false);
    EXPECT_EQ(desk_.preview.verdict(), Verdict::Unknown);
    EXPECT_EQ(desk_.preview.words(), "");
    pass(desk_.rig.clock(), 2s);
    EXPECT_TRUE(desk_.isDark());
    // In the middle of looking, too.
    desk_.preview.setActive(true);
    ASSERT_TRUE(waitFor([&] { return !desk_.isDark(); }));
    desk_.preview.setActive(false);
    pass(desk_.rig.clock(), 2s);
    EXPECT_TRUE(desk_.isDark());
}

TEST_F(Preview, APulledCableEndsItAndItGoesOnOncePluggedIn) {
    ASSERT_TRUE(look());
    desk_.rig.pullSkin();
    ASSERT_TRUE(waitFor([&] { return !desk_.workbench.isSkinReady(); }));
    ASSERT_TRUE(waitFor([&] { return desk_.preview.verdict() == Verdict::Unknown; })) << "what was seen is of before";
    desk_.rig.plugSkin();
    ASSERT_TRUE(desk_.connectSkin());
    const QSignalSpy changed(&desk_.preview, &ViewPreview::changed);
    EXPECT_TRUE(waitFor([&] { return changed.count() > 0 && desk_.preview.verdict() == Verdict::Good; }));
}

TEST_F(Preview, WithoutABodyThereIsNothingToSay) {
    ASSERT_TRUE(look());
    desk_.session().decide("no camera", [](Decisions& decisions) { decisions.camera.reset(); });
    EXPECT_TRUE(waitFor([&] { return desk_.preview.verdict() == Verdict::Unknown; }));
    desk_.session().undoStack().undo();
    EXPECT_TRUE(waitFor([&] { return desk_.preview.verdict() == Verdict::Good; }));
}

TEST_F(Preview, MakesWayForABlink) {
    ASSERT_TRUE(look());
    const QSignalSpy blinking(&desk_.connection, &ConnectPresenter::blinking);
    desk_.connection.blink(desk_.rig.world().skin.modules.front().id);
    ASSERT_TRUE(waitFor([&] { return blinking.count() > 3; }));
    const QSignalSpy changed(&desk_.preview, &ViewPreview::changed);
    ASSERT_TRUE(waitFor([&] { return changed.count() > 0; }));
    EXPECT_EQ(desk_.preview.verdict(), Verdict::Good) << desk_.preview.words().toStdString();
}

TEST_F(Preview, AScanShowsItsSpotsWhileItRuns) {
    std::size_t most = 0;
    std::set<ModuleId> known;
    QObject::connect(&desk_.scan, &ScanPresenter::spotsChanged, &desk_.scan, [&] {
        most = std::max(most, desk_.scan.spots().size());
        for (const LiveSpot& spot : desk_.scan.spots()) {
            if (spot.module)
                known.insert(*spot.module);
        }
    });
    ASSERT_TRUE(desk_.scanHere());
    const auto& found = desk_.session().measured().views.back().decoded.found;
    EXPECT_GE(most, found.size());
    std::size_t both = 0;
    for (const LedDetection& led : found)
        both += known.contains(led.module) ? 1 : 0;
    EXPECT_GE(10 * both, 9 * found.size()) << both << " of " << found.size();
}

}  // namespace
}  // namespace skincal
