// A skin so crowded that one look leaves some of its modules undecided, and what may happen while the next ones go on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/study/scan_study.h"
#include "tests/ui/presenters/desk.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;
using test::Desk;
using test::waitFor;
using Phase = ScanRun::Phase;

Scenario crowdedScenario() {
    // LEDs 3.5 px apart.
    Scenario scenario = scanWorld({Disturbance::Crowding, 3.5, 55, 0.8, ScanMethod::Coded}, 1).scenario;
    scenario.views.count = Scenario{}.views.count;
    return scenario;
}

class FurtherLook : public testing::Test {
  protected:
    FurtherLook() : desk_(crowdedScenario(), 1) {
        desk_.rig.moveCamera(scanWorld({Disturbance::Crowding, 3.5, 55, 0.8, ScanMethod::Coded}, 1).T_r_v[0]);
        EXPECT_TRUE(waitFor([&] { return desk_.rig.isCameraAtRest(); }));
        EXPECT_TRUE(desk_.connectSkin() && desk_.startCamera());
    }
    /// Scans, and does that once while modules are looked for again.
    void scanAnd(std::function<void()> what) {
        bool isDone = false;
        const QObject receiver;
        QObject::connect(&desk_.scan, &ScanPresenter::stateChanged, &receiver, [&] {
            if (!isDone && desk_.scan.state().isRunning() && !desk_.scan.wanted().empty()) {
                isDone = true;
                what();
            }
        });
        desk_.scan.start();
        ASSERT_TRUE(waitFor([&] { return isDone && !desk_.scan.isBusy(); }));
    }
    [[nodiscard]] const std::vector<ScannedView>& views() { return desk_.session().measured().views; }

    Desk desk_;
};

TEST_F(FurtherLook, FindsThoseThatTheFirstCouldNotTellApart) {
    std::vector<ModuleId> wanted;
    scanAnd([&] { wanted = desk_.scan.wanted(); });
    ASSERT_EQ(views().size(), 1U);
    const ViewDetections& view = views()[0].decoded;
    EXPECT_GT(views()[0].frames.back().look, 0U);
    std::size_t found = 0;
    const auto index = desk_.rig.world().skin.indexById();
    for (const LedDetection& led : view.found) {
        const auto truth = visiblePixel(desk_.rig.world(), desk_.rig.cameraPose(), 0, index.at(led.module), {});
        ASSERT_TRUE(truth);
        EXPECT_LT((led.pixel - *truth).norm(), 0.3);
        found += std::find(wanted.begin(), wanted.end(), led.module) != wanted.end() ? 1 : 0;
    }
    EXPECT_GT(2 * found, wanted.size());
    EXPECT_TRUE(desk_.isDark());
}

TEST_F(FurtherLook, BrokenOffItTakesNothingFromTheFirst) {
    scanAnd([&] { desk_.workbench.chooseCamera(1); });
    EXPECT_EQ(desk_.scan.state().phase, Phase::Failed);
    EXPECT_TRUE(desk_.scan.isKept());
    ASSERT_EQ(views().size(), 1U);
    EXPECT_EQ(views()[0].frames.back().look, 0U);
    EXPECT_GT(views()[0].decoded.found.size(), 20U);
    EXPECT_TRUE(desk_.isDark());
}

TEST_F(FurtherLook, CancelledItEndsWithWhatThereIs) {
    scanAnd([&] { desk_.scan.cancel(); });
    EXPECT_EQ(desk_.scan.state().phase, Phase::Idle);
    ASSERT_EQ(views().size(), 1U);
    EXPECT_GT(views()[0].decoded.found.size(), 20U);
    EXPECT_TRUE(desk_.isDark());
}

TEST_F(FurtherLook, PausedItGoesOn) {
    bool isPaused = false;
    scanAnd([&] {
        desk_.scan.pause();
        isPaused = desk_.scan.state().phase == Phase::Paused;
        pass(desk_.rig.clock(), 3s);
        desk_.scan.resume();
    });
    EXPECT_TRUE(isPaused);
    ASSERT_EQ(views().size(), 1U);
    EXPECT_GT(views()[0].frames.back().look, 0U);
}

TEST_F(FurtherLook, AnotherDocumentGetsNothingOfIt) {
    OpenedRecording other{desk_.session().measured(), desk_.session().decisions()};
    scanAnd([&] { desk_.session().load(other); });
    EXPECT_EQ(desk_.scan.state().phase, Phase::Failed);
    EXPECT_FALSE(desk_.scan.isKept());
    EXPECT_TRUE(views().empty());
    EXPECT_FALSE(desk_.session().isModified());
}

}  // namespace
}  // namespace skincal
