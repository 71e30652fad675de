#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <QSignalSpy>

#include "core/workflow/simulated_recording.h"
#include "tests/ui/presenters/desk.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;
using test::Desk;
using test::waitFor;
using Phase = ScanRun::Phase;

/// Calls `what` the first time that the scan is there, from inside the signal: nothing is missed.
void when(Desk& desk, Phase phase, std::size_t frame, std::function<void()> what) {
    auto done = std::make_shared<bool>(false);
    QObject::connect(&desk.scan, &ScanPresenter::stateChanged, &desk.scan, [&desk, phase, frame, what, done] {
        const ScanRun& run = desk.scan.state();
        if (!*done && run.phase == phase && run.taken() >= frame) {
            *done = true;
            what();
        }
    });
}

void expectSpotsNearTruth(Desk& desk, const ScannedView& view) {
    const World& world = desk.rig.world();
    const auto index = world.skin.indexById();
    Visibility any;
    any.maxAngle = 89 * kDegree;
    EXPECT_GT(view.decoded.found.size(), 5U);
    for (const LedDetection& led : view.decoded.found) {
        const auto truth = visiblePixel(world, desk.rig.cameraPose(), 0, index.at(led.module), any);
        ASSERT_TRUE(truth);
        EXPECT_LT((led.pixel - *truth).norm(), 0.2);
    }
}

std::vector<ModuleId> idsOf(const Skin& skin) {
    std::vector<ModuleId> ids;
    for (const SkinModule& module : skin.modules)
        ids.push_back(module.id);
    return ids;
}

TEST(ScanPresenter, TellsWhatIsInTheWay) {
    Desk desk;
    EXPECT_THAT(desk.scan.obstacle().toStdString(), testing::HasSubstr("skin is not connected"));
    ASSERT_TRUE(desk.connectSkin());
    EXPECT_THAT(desk.scan.obstacle().toStdString(), testing::HasSubstr("No camera"));
    desk.workbench.chooseCamera(0);
    EXPECT_THAT(desk.scan.obstacle().toStdString(), testing::HasSubstr("intrinsics"));
    CameraModel camera = desk.rig.world().scenario.camera;
    camera.width = 640;
    desk.session().decide("intrinsics", [&](Decisions& decisions) { decisions.camera = camera; });
    EXPECT_THAT(desk.scan.obstacle().toStdString(), testing::HasSubstr("no pictures yet"));
    desk.scan.start();
    EXPECT_EQ(desk.scan.state().phase, Phase::Idle);
    desk.scan.setActive(true);
    ASSERT_TRUE(waitFor([&] { return !desk.scan.picture().empty(); }));
    EXPECT_THAT(desk.scan.obstacle().toStdString(), testing::HasSubstr("640"));
    desk.session().undoStack().undo();
    ASSERT_TRUE(desk.startCamera());
    EXPECT_EQ(desk.scan.obstacle(), "");
    // An old picture's time must not pass for the present.
    desk.scan.setActive(false);
    EXPECT_FALSE(desk.scan.picture().empty());
    EXPECT_THAT(desk.scan.obstacle().toStdString(), testing::HasSubstr("no pictures yet"));
    desk.scan.setActive(true);
    ASSERT_TRUE(waitFor([&] { return desk.scan.obstacle().isEmpty(); }));
}

TEST(ScanPresenter, AScanIsAViewWhoseSpotsAreWhereTheyAre) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    const QSignalSpy scanned(&desk.scan, &ScanPresenter::scanned);
    for (int view = 0; view < 2; ++view) {
        ASSERT_TRUE(desk.scanHere());
        EXPECT_EQ(desk.scan.state().phase, Phase::Done);
        EXPECT_EQ(desk.scan.done(), 1);
        const ScannedView& last = desk.session().measured().views.back();
        EXPECT_EQ(desk.scan.shownView(), last.name);
        EXPECT_EQ(last.pictures->size(), desk.scan.picturesOfAScan());
        EXPECT_LT(scanned.back().at(1).toDouble(), 0.5) << "the camera stood";
        expectSpotsNearTruth(desk, last);
        ASSERT_TRUE(desk.moveCamera());
    }
    EXPECT_TRUE(desk.isDark());
}

TEST(ScanPresenter, CancelledInAnyPhaseItLeavesNothingBehind) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    const std::uint64_t revision = desk.session().revision();
    const std::size_t last = desk.scan.picturesOfAScan() - 1;
    const auto cancelIn = [&](Phase phase, std::size_t frame) {
        bool isCancelled = false;
        when(desk, phase, frame, [&] {
            isCancelled = true;
            desk.scan.cancel();
        });
        desk.scan.start();
        ASSERT_TRUE(waitFor([&] { return isCancelled || !desk.isScanning(); }));
        ASSERT_TRUE(isCancelled);
        EXPECT_EQ(desk.scan.state().phase, Phase::Idle);
        pass(desk.rig.clock(), 3s);
        EXPECT_EQ(desk.scan.state().phase, Phase::Idle);
        EXPECT_TRUE(desk.isDark());
        EXPECT_TRUE(desk.session().measured().views.empty());
        EXPECT_EQ(desk.session().revision(), revision);
    };
    cancelIn(Phase::Timing, 0);
    cancelIn(Phase::Timing, 1);
    cancelIn(Phase::Streaming, 2);
    cancelIn(Phase::Streaming, last);
    cancelIn(Phase::Decoding, 0);
    // A camera so late that light can't be timed.
    desk.rig.setCameraLatency(5s);
    cancelIn(Phase::Lighting, 0);
    cancelIn(Phase::Settling, 3);
    desk.rig.setCameraLatency(80ms);
    ASSERT_TRUE(desk.scanHere()) << "and the next one goes through";
    expectSpotsNearTruth(desk, desk.session().measured().views.back());
}

TEST(ScanPresenter, WhatAKnockSpoiltIsLookedForAgain) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    const std::size_t pictures = desk.scan.picturesOfAScan();
    when(desk, Phase::Streaming, pictures / 2, [&] {
        EXPECT_TRUE(desk.scan.wanted().empty());
        desk.rig.moveCamera(desk.rig.cameraPose() * makeIsometry(so3Exp({0.3 * kDegree, 0, 0}), Vector3d::Zero()));
    });
    std::size_t wanted = 0;
    when(desk, Phase::Streaming, pictures + 1, [&] { wanted = desk.scan.wanted().size(); });
    ASSERT_TRUE(desk.scanHere());
    EXPECT_EQ(wanted, desk.session().measured().skin.modules.size());
    EXPECT_TRUE(desk.scan.wanted().empty()) << "it is over";
    const ScannedView& view = desk.session().measured().views.back();
    EXPECT_EQ(view.frames.front().look, 0U);
    EXPECT_EQ(view.frames.back().look, 1U);
    EXPECT_EQ(view.pictures->size(), view.frames.size());
    expectSpotsNearTruth(desk, view);
    // Read from its files it is the same.
    const auto again = decodeScan(view.frames, view.pictures, idsOf(desk.session().measured().skin), {});
    ASSERT_TRUE(again);
    ASSERT_EQ(again->view.decoded.found.size(), view.decoded.found.size());
    for (std::size_t i = 0; i < view.decoded.found.size(); ++i)
        EXPECT_EQ(again->view.decoded.found[i].pixel, view.decoded.found[i].pixel);
}

TEST(ScanPresenter, LooksOnceWhereThatIsAskedOrNothingIsOpen) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    ASSERT_TRUE(desk.scanHere());
    EXPECT_EQ(desk.session().measured().views.back().frames.back().look, 0U) << "those not seen are out of sight";
    const std::size_t visible = desk.session().measured().views.back().decoded.found.size();
    desk.scan.setLooksAgain(false);
    when(desk, Phase::Streaming, desk.scan.picturesOfAScan() / 2, [&] {
        desk.rig.moveCamera(desk.rig.cameraPose() * makeIsometry(so3Exp({0.3 * kDegree, 0, 0}), Vector3d::Zero()));
    });
    ASSERT_TRUE(desk.scanHere());
    EXPECT_EQ(desk.session().measured().views.back().frames.back().look, 0U);
    EXPECT_LT(desk.session().measured().views.back().decoded.found.size(), visible) << "some are open";
}

TEST(ScanPresenter, NoMorePicturesAreTakenThanFitIntoTheMemory) {
    const cv::Mat grey(720, 1280, CV_8UC1);
    EXPECT_TRUE(fitIntoMemory(2003, grey)) << "1,000 modules one at a time";
    EXPECT_FALSE(fitIntoMemory(20'003, grey));
    EXPECT_FALSE(fitIntoMemory(2003, cv::Mat(720, 1280, CV_8UC3)));
    EXPECT_FALSE(fitIntoMemory(2003, cv::Mat(2160, 3840, CV_8UC1)));
}

TEST(ScanPresenter, LightsOneAtATimeWhereThatIsAsked) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    const std::size_t modules = desk.session().measured().skin.modules.size();
    const std::size_t byWords = desk.scan.picturesOfAScan();
    desk.scan.setCode(ScanCode::OneAtATime);
    EXPECT_EQ(desk.scan.picturesOfAScan(), 2 * modules + 3);
    ASSERT_TRUE(desk.scanHere());
    const ScannedView& view = desk.session().measured().views.back();
    EXPECT_TRUE(desk.scan.state().isTimed) << "at the camera's rate";
    ASSERT_EQ(view.frames.size(), 2 * modules + 3);
    EXPECT_LE(std::count_if(view.frames.begin(), view.frames.end(),
                            [](const FrameInfo& frame) { return frame.lit.size() > 1; }),
              1);
    expectSpotsNearTruth(desk, view);
    desk.scan.setCode(ScanCode::Words);
    ASSERT_TRUE(desk.scanHere());
    EXPECT_EQ(desk.session().measured().views.back().frames.size(), byWords);
}

TEST(ScanPresenter, PausesAndGoesOn) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    when(desk, Phase::Streaming, 5, [&] { desk.scan.pause(); });
    desk.scan.start();
    ASSERT_TRUE(waitFor([&] { return desk.scan.state().phase == Phase::Paused; }));
    const std::size_t taken = desk.scan.state().taken();
    // Elsewhere meanwhile: the camera is still needed.
    desk.scan.setActive(false);
    pass(desk.rig.clock(), 5s);
    EXPECT_EQ(desk.scan.state().phase, Phase::Paused);
    EXPECT_EQ(desk.scan.state().taken(), taken);
    EXPECT_TRUE(desk.isDark());
    desk.scan.resume();
    ASSERT_TRUE(waitFor([&] { return !desk.isScanning(); }));
    ASSERT_EQ(desk.session().measured().views.size(), 1U);
    expectSpotsNearTruth(desk, desk.session().measured().views.back());

    desk.scan.setActive(true);
    ASSERT_TRUE(waitFor([&] { return desk.scan.obstacle().isEmpty(); }));
    when(desk, Phase::Streaming, 2, [&] { desk.scan.pause(); });
    desk.scan.start();
    ASSERT_TRUE(waitFor([&] { return desk.scan.state().phase == Phase::Paused; }));
    desk.scan.setActive(false);
    const auto* camera = qobject_cast<SimulatedCamera*>(desk.workbench.camera());
    EXPECT_TRUE(camera->isRunning());
    desk.scan.cancel();
    EXPECT_FALSE(camera->isRunning()) << "nobody needs its pictures";
}

TEST(ScanPresenter, FailsWithAReasonWhereSomethingIsPulled) {
    for (const Phase phase : {Phase::Timing, Phase::Streaming, Phase::Paused}) {
        for (const bool isSkin : {true, false}) {
            Desk desk;
            ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
            const QSignalSpy cameraFailed(&desk.scan, &ScanPresenter::cameraFailed);
            when(desk, phase == Phase::Paused ? Phase::Streaming : phase, phase == Phase::Timing ? 1 : 2, [&] {
                if (phase == Phase::Paused)
                    desk.scan.pause();
                isSkin ? desk.rig.pullSkin() : desk.rig.pullCamera();
            });
            desk.scan.start();
            ASSERT_TRUE(waitFor([&] { return desk.scan.state().phase == Phase::Failed; }));
            EXPECT_TRUE(desk.scan.why().contains(isSkin ? "disconnected" : "unplugged"))
                << desk.scan.why().toStdString();
            pass(desk.rig.clock(), 2s);
            EXPECT_EQ(cameraFailed.count(), isSkin ? 0 : 1) << "said once";
            EXPECT_TRUE(desk.session().measured().views.empty());
            EXPECT_FALSE(desk.scan.obstacle().isEmpty());
            desk.rig.plugSkin();
            desk.rig.plugCamera();
            ASSERT_TRUE(desk.connectSkin());
            desk.scan.setActive(false);
            desk.scan.setActive(true);
            ASSERT_TRUE(waitFor([&] { return desk.scan.obstacle().isEmpty(); }));
            ASSERT_TRUE(desk.scanHere());
        }
    }
}

TEST(ScanPresenter, BreaksOffWhereCameraOrSkinBecomesAnother) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    when(desk, Phase::Streaming, 2, [&] {
        QMetaObject::invokeMethod(
            &desk.workbench, [&] { desk.workbench.chooseCamera(1); }, Qt::QueuedConnection);
    });
    desk.scan.start();
    ASSERT_TRUE(waitFor([&] { return desk.scan.state().phase == Phase::Failed; }));
    EXPECT_EQ(desk.scan.state().fault, ScanRun::Fault::OtherCamera);
    EXPECT_TRUE(desk.scan.why().contains("another camera"));
    ASSERT_TRUE(waitFor([&] { return desk.scan.obstacle().isEmpty(); }));
    // A file that is opened meanwhile is of another body.
    OpenedRecording other{desk.session().measured(), desk.session().decisions()};
    when(desk, Phase::Decoding, 0, [&] { desk.session().load(other); });
    desk.scan.start();
    ASSERT_TRUE(waitFor([&] { return desk.scan.state().phase == Phase::Failed; }));
    pass(desk.rig.clock(), 1s);
    EXPECT_TRUE(desk.session().measured().views.empty());
}

TEST(ScanPresenter, NobodyBlinksDuringAScan) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    const QSignalSpy blinking(&desk.connection, &ConnectPresenter::blinking);
    const ModuleId module = desk.rig.world().skin.modules.front().id;
    when(desk, Phase::Streaming, 2, [&] { desk.connection.blink(module); });
    ASSERT_TRUE(desk.scanHere());
    EXPECT_EQ(blinking.count(), 0);
    expectSpotsNearTruth(desk, desk.session().measured().views.back());
    desk.connection.blink(module);
    EXPECT_EQ(blinking.count(), 1);
}

TEST(ScanPresenter, ScansAViewAgainInItsPlace) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    ASSERT_TRUE(desk.scanHere());
    const std::string name = desk.session().measured().views.front().name;
    const auto pictures = desk.session().measured().views.front().pictures;
    ASSERT_TRUE(desk.moveCamera());
    desk.scan.start(name);
    ASSERT_TRUE(waitFor([&] { return !desk.isScanning(); }));
    ASSERT_EQ(desk.session().measured().views.size(), 1U);
    const ScannedView& view = desk.session().measured().views.front();
    EXPECT_EQ(view.name, name);
    EXPECT_EQ(view.decoded.name, name);
    EXPECT_NE(view.pictures, pictures);
    expectSpotsNearTruth(desk, view);
    desk.session().undoStack().undo();
    EXPECT_EQ(desk.session().measured().views.front().pictures, pictures);
    desk.session().undoStack().redo();
    EXPECT_NE(desk.session().measured().views.front().pictures, pictures);
}

TEST(ScanPresenter, SaysHowFarTheCameraMoved) {
    Desk desk;
    desk.scan.setLooksAgain(false);  // it would be mended
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    when(desk, Phase::Streaming, desk.scan.picturesOfAScan() / 2, [&] { desk.rig.knockCamera(8); });
    double moved = -1;
    QObject::connect(&desk.scan, &ScanPresenter::scanned, &desk.scan,
                     [&](const std::string&, double moved_px, std::size_t) { moved = moved_px; });
    desk.scan.start();
    ASSERT_TRUE(waitFor([&] { return !desk.isScanning(); }));
    EXPECT_NEAR(moved, 8, 1);
}

TEST(ScanPresenter, TellsDuringTheScanThatTheCameraMoved) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    when(desk, Phase::Streaming, 6, [&] { desk.rig.knockCamera(8); });
    when(desk, Phase::Streaming, 14, [&] { desk.scan.pause(); });
    desk.scan.start();
    ASSERT_TRUE(waitFor([&] { return desk.scan.state().phase == Phase::Paused; }));
    ASSERT_TRUE(waitFor([&] { return desk.scan.movedSoFar_px().has_value(); }));
    EXPECT_NEAR(*desk.scan.movedSoFar_px(), 8, 1);
    desk.scan.cancel();
    EXPECT_FALSE(desk.scan.movedSoFar_px()) << "the next one begins anew";
    ASSERT_TRUE(desk.scanHere());
    LiveMotion motion;
    for (const cv::Mat& picture : *desk.session().measured().views.front().pictures)
        motion.add(picture);
    EXPECT_FALSE(motion.moved_px()) << "nobody touched it";
}

/// Problems that speak of the camera's motion, each with the view that it opens.
std::vector<std::string> motions(const ProblemModel& problems) {
    std::vector<std::string> views;
    for (int row = 0; row < problems.rowCount(); ++row) {
        const Problem& problem = problems.problemAt(row);
        if (problem.text.startsWith(QStringLiteral("The camera moved by"))) {
            EXPECT_EQ(problem.step, Step::Scan);
            EXPECT_EQ(problem.severity, Problem::Severity::Warning);
            EXPECT_TRUE(problem.text.contains(problem.view.c_str())) << problem.text.toStdString();
            views.push_back(problem.view);
        }
    }
    return views;
}

TEST(ScanPresenter, AMotionIsAProblemOfThatScanAlone) {
    Desk desk;
    desk.scan.setLooksAgain(false);  // it would be mended
    ASSERT_TRUE(desk.connectSkin() && desk.startCamera());
    when(desk, Phase::Streaming, desk.scan.picturesOfAScan() / 2, [&] { desk.rig.knockCamera(8); });
    ASSERT_TRUE(desk.scanHere());
    const std::string knocked = desk.scan.shownView();
    EXPECT_EQ(motions(desk.problems), std::vector{knocked});
    desk.scan.setDropped(knocked, true);
    EXPECT_TRUE(motions(desk.problems).empty()) << "what does not count needs no mending";
    desk.session().undoStack().undo();
    EXPECT_EQ(motions(desk.problems), std::vector{knocked});

    ASSERT_TRUE(desk.scanHere());
    EXPECT_EQ(motions(desk.problems), std::vector{knocked}) << "the next view was still";
    ASSERT_NE(desk.scan.shownView(), knocked);
    // Scanned again at rest it is mended; undone, the old scan is back with its problem.
    desk.scan.start(knocked);
    ASSERT_TRUE(waitFor([&] { return !desk.isScanning(); }));
    EXPECT_TRUE(motions(desk.problems).empty());
    desk.session().undoStack().undo();
    EXPECT_EQ(motions(desk.problems), std::vector{knocked});

    // Another recording has a view of the same name, and nothing to do with it.
    Scenario scenario = *findScenario("coded");
    scenario.views.scan = ScanKind::Detections;
    OpenedRecording other = openedFrom(recordingOf(buildWorld(scenario, 2)));
    ASSERT_EQ(other.measured.views.front().name, knocked);
    desk.session().load(std::move(other));
    EXPECT_TRUE(motions(desk.problems).empty());
}

}  // namespace
}  // namespace skincal
