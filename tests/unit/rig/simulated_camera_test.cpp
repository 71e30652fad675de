#include "core/rig/simulated_camera.h"

#include <gtest/gtest.h>

#include <QSignalSpy>
#include <opencv2/core.hpp>

#include "core/rig/simulated_skin.h"
#include "core/simulation/renderer.h"
#include "tests/unit/rig/pass.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

class ASimulatedCamera : public testing::Test {
  protected:
    ASimulatedCamera() : rig(*findScenario("coded"), 4), skin(rig), camera(rig) {
        rig.setSpeed(0);
        skin.open();
        pass(rig.clock(), 50ms);
        QObject::connect(&camera, &FrameSource::frameArrived, &camera, [this](const CameraFrame& frame) {
            EXPECT_EQ(frame.time, rig.now()) << "at speed 0 pictures arrive at their own time";
            frames.push_back(frame);
        });
    }

    /// A module that the first view sees, and where.
    [[nodiscard]] std::pair<ModuleId, cv::Point> aVisibleLed() const {
        const World& world = rig.world();
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            if (const auto pixel = visiblePixel(world, 0, u))
                return {world.skin.modules[u].id, {cvRound(pixel->x()), cvRound(pixel->y())}};
        }
        throw std::runtime_error("no LED is visible");
    }

    SimulatedRig rig;
    SimulatedSkin skin;
    SimulatedCamera camera;
    std::vector<CameraFrame> frames;
};

double difference(const cv::Mat& a, const cv::Mat& b) {
    return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total());
}

TEST_F(ASimulatedCamera, GivesThirtyPicturesASecondOfItsWorld) {
    const auto start = rig.now();
    camera.start();
    camera.start();
    EXPECT_TRUE(frames.empty()) << "never from inside the call";
    pass(rig.clock(), 1s);
    ASSERT_EQ(frames.size(), 31U);
    const FrameRenderer renderer(rig.world(), 0, 1000);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        EXPECT_EQ(frames[i].sequence, i);
        EXPECT_EQ(frames[i].time, start + std::chrono::microseconds(i * 1'000'000 / 30));
        EXPECT_EQ(frames[i].image.type(), CV_8UC1);
        EXPECT_EQ(frames[i].image.size(), cv::Size(camera.format().width, camera.format().height));
        EXPECT_EQ(difference(frames[i].image, renderer.render({}, i)), 0);
    }
}

TEST_F(ASimulatedCamera, StopsAndGoesOnCounting) {
    const QSignalSpy stopped(&camera, &FrameSource::stopped);
    camera.stop();
    camera.start();
    pass(rig.clock(), 110ms);
    EXPECT_EQ(stopped.count(), 0);
    camera.stop();
    camera.stop();
    pass(rig.clock(), 1s);
    EXPECT_EQ(stopped.count(), 1);
    const std::size_t before = frames.size();
    EXPECT_EQ(before, 4U);
    camera.start();
    pass(rig.clock(), 110ms);
    ASSERT_EQ(frames.size(), 8U);
    for (std::size_t i = 0; i < frames.size(); ++i)
        EXPECT_EQ(frames[i].sequence, i);
    EXPECT_GT(frames[4].time, frames[3].time + 1s);
}

TEST_F(ASimulatedCamera, ShowsALedAfterTheLatencyAndNotBefore) {
    const auto [module, place] = aVisibleLed();
    camera.start();
    for (const auto latency : {80ms, 0ms, 33ms, 200ms}) {
        rig.setCameraLatency(latency);
        EXPECT_EQ(rig.cameraLatency(), latency);
        for (const bool on : {true, false}) {
            pass(rig.clock(), 317ms);
            frames.clear();
            const auto commanded = rig.now();
            skin.light(on ? std::vector<LitModule>{{module, std::nullopt}} : std::vector<LitModule>{});
            pass(rig.clock(), 500ms);
            ASSERT_GE(frames.size(), 15U);
            for (const CameraFrame& frame : frames) {
                const bool shows = frame.image.at<unsigned char>(place) > 220;
                const bool changed = frame.time >= commanded + latency;
                EXPECT_EQ(shows, on == changed) << (frame.time - commanded).count() << " us after the command";
            }
        }
    }
    EXPECT_THROW(rig.setCameraLatency(-1ms), std::logic_error);
}

TEST_F(ASimulatedCamera, ShowsCommandAfterCommandEachInItsTime) {
    // Faster one after the other than the latency is long.
    const auto [module, place] = aVisibleLed();
    camera.start();
    std::vector<std::pair<RigClock::Time, bool>> commands{{RigClock::Time(0), false}};
    for (int i = 0; i < 20; ++i) {
        pass(rig.clock(), 41ms);
        const bool on = i % 3 != 1;
        commands.emplace_back(rig.now(), on);
        skin.light(on ? std::vector<LitModule>{{module, std::nullopt}} : std::vector<LitModule>{});
    }
    pass(rig.clock(), 200ms);
    for (const CameraFrame& frame : frames) {
        bool on = false;
        for (const auto& [time, lit] : commands)
            on = frame.time >= time + 80ms ? lit : on;
        EXPECT_EQ(frame.image.at<unsigned char>(place) > 220, on);
    }
}

TEST_F(ASimulatedCamera, ShowsInPartWhatChangesWhileItsShutterIsOpen) {
    const auto [module, place] = aVisibleLed();
    const FrameRenderer renderer(rig.world(), 0, 1000);
    const std::vector<LitModule> lit{{module, std::nullopt}};
    EXPECT_THROW(rig.setShutter({-1ms, 5ms}), std::logic_error);
    EXPECT_THROW(rig.setShutter({50ms, 31ms}), std::logic_error) << "pictures come once they are exposed";
    Random random(1, "shutters");
    camera.start();
    for (int run = 0; run < 12; ++run) {
        const Shutter shutter{std::chrono::milliseconds(random.index(30)), std::chrono::milliseconds(random.index(40))};
        rig.setShutter(shutter);
        EXPECT_THROW(rig.setCameraLatency(std::chrono::floor<std::chrono::milliseconds>(shutter.length()) - 1ms),
                     std::logic_error);
        frames.clear();
        pass(rig.clock(), RigClock::Time(static_cast<RigClock::Time::rep>(random.index(33'000))));
        const auto commanded = rig.now();
        skin.light(lit);
        pass(rig.clock(), 300ms);
        bool isMixed = false;
        for (const CameraFrame& frame : frames) {
            const auto begin = frame.time - 80ms + shutter.readout * place.y / frame.image.rows;
            const auto off =
                std::clamp<RigClock::Time>(commanded - begin, 0us, std::max<RigClock::Time>(shutter.open, 1us));
            const double share = 1 - static_cast<double>(off.count()) /
                                         static_cast<double>(std::max<RigClock::Time>(shutter.open, 1us).count());
            const std::size_t k = frame.sequence % 510;
            const double dark = renderer.render({}, k).at<unsigned char>(place);
            const double bright = renderer.render(lit, k).at<unsigned char>(place);
            EXPECT_NEAR(frame.image.at<unsigned char>(place), dark + share * (bright - dark), 1);
            isMixed = isMixed || (share > 0 && share < 1);
            EXPECT_EQ(rig.litDuring(frame.time).size() > 1,
                      frame.time - 80ms < commanded && commanded < frame.time - 80ms + shutter.length());
        }
        EXPECT_TRUE(!isMixed || shutter.open > 0ms);
        skin.light({});
        pass(rig.clock(), 300ms);
    }
}

TEST_F(ASimulatedCamera, DropsAndRepeatsAsManyPicturesAsItIsTold) {
    EXPECT_THROW(camera.setLosses(-0.1, 0), std::logic_error);
    EXPECT_THROW(camera.setLosses(0.6, 0.5), std::logic_error);
    camera.setLosses(0.2, 0.1);
    camera.start();
    pass(rig.clock(), 10s);
    std::size_t repeated = 0;
    for (std::size_t i = 1; i < frames.size(); ++i) {
        EXPECT_GT(frames[i].time, frames[i - 1].time);
        repeated += difference(frames[i].image, frames[i - 1].image) == 0 ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(frames.size()), 240, 25);
    EXPECT_NEAR(static_cast<double>(repeated), 30, 15);
    EXPECT_GT(frames.back().sequence, 295U);
}

TEST_F(ASimulatedCamera, MovedItShowsTheNewPlace) {
    const QSignalSpy rested(&rig, &SimulatedRig::cameraRested);
    EXPECT_EQ(rig.cameraPose().matrix(), rig.suggestedViews()[0].matrix());
    camera.start();
    pass(rig.clock(), 50ms);
    for (std::size_t v = 1; v < rig.suggestedViews().size(); ++v) {
        const Isometry3d& T_r_v = rig.suggestedViews()[v];
        frames.clear();
        rig.moveCamera(T_r_v);
        EXPECT_FALSE(rig.isCameraAtRest());
        pass(rig.clock(), HeldCamera::kMove);
        EXPECT_EQ(rested.count(), static_cast<int>(v));
        EXPECT_TRUE(rig.isCameraAtRest());
        EXPECT_EQ(rig.cameraPose().matrix(), T_r_v.matrix());
        EXPECT_GE(frames.size(), 30U);
        for (std::size_t i = 10; i < 20; ++i)
            EXPECT_GT(difference(frames[i].image, frames[i - 1].image), 2) << "the picture moves with it";
        pass(rig.clock(), 34ms);
        // The room behind is that of the first view.
        const FrameRenderer renderer(rig.world(), T_r_v, 0, 1000);
        EXPECT_EQ(difference(frames.back().image, renderer.render({}, frames.back().sequence)), 0);
    }
    Isometry3d bent = Isometry3d::Identity();
    bent.linear() *= 2;
    EXPECT_THROW(rig.moveCamera(bent), std::logic_error);
}

TEST_F(ASimulatedCamera, KnockedThePictureShifts) {
    const auto before = rig.cameraPose();
    const QSignalSpy rested(&rig, &SimulatedRig::cameraRested);
    rig.knockCamera(8);
    const CameraModel& lens = rig.world().scenario.camera;
    const Vector3d middle_v = lens.unproject({lens.cx, lens.cy}).homogeneous();
    const auto shifted = lens.project(rig.cameraPose().inverse() * (before * (1e9 * middle_v)));
    EXPECT_NEAR((*shifted - Vector2d(lens.cx, lens.cy)).norm(), 8, 0.1);
    pass(rig.clock(), 1s);
    EXPECT_EQ(rested.count(), 0);
    rig.moveCamera(rig.suggestedViews()[1]);
    pass(rig.clock(), 300ms);
    rig.knockCamera(3);
    pass(rig.clock(), 2s);
    EXPECT_EQ(rested.count(), 1) << "a move that was knocked ends once";
}

TEST_F(ASimulatedCamera, BrightnessFollowsExposureAndClips) {
    const auto range = camera.exposureRange();
    ASSERT_TRUE(range);
    EXPECT_EQ(camera.exposure(), SimulatedCamera::kUsualExposure);
    camera.start();
    const auto meanAt = [&](double exposure) {
        camera.setExposure(exposure);
        pass(rig.clock(), 40ms);
        frames.clear();
        pass(rig.clock(), 40ms);
        return cv::mean(frames.back().image)[0];
    };
    const double usual = meanAt(SimulatedCamera::kUsualExposure);
    EXPECT_NEAR(meanAt(0.5 * SimulatedCamera::kUsualExposure), 0.5 * usual, 0.02 * usual);
    const double longest = meanAt(1000);
    EXPECT_EQ(camera.exposure(), range->second);
    EXPECT_GT(longest, 1.5 * usual);
    EXPECT_LE(longest, 2 * usual);
    meanAt(0);
    EXPECT_EQ(camera.exposure(), range->first);
    EXPECT_THROW(camera.setExposure(std::nan("")), std::logic_error);
}

TEST_F(ASimulatedCamera, HasTheFormatOfTheScenariosCamera) {
    const auto formats = camera.formats();
    ASSERT_EQ(formats.size(), 1U);
    EXPECT_EQ(formats[0], camera.format());
    EXPECT_EQ(formats[0], (FrameFormat{1280, 720, 30}));
    camera.setFormat(formats[0]);
    EXPECT_THROW(camera.setFormat({640, 480, 30}), std::logic_error);
    EXPECT_FALSE(camera.name().isEmpty());
}

TEST_F(ASimulatedCamera, UnpluggedItFailsAndStops) {
    std::vector<std::string> heard;
    QObject::connect(&camera, &FrameSource::failed, &camera, [&](const QString& why) {
        EXPECT_FALSE(why.isEmpty());
        heard.emplace_back("failed");
    });
    QObject::connect(&camera, &FrameSource::stopped, &camera, [&] { heard.emplace_back("stopped"); });
    camera.start();
    pass(rig.clock(), 110ms);
    const std::size_t before = frames.size();
    rig.pullCamera();
    EXPECT_TRUE(heard.empty());
    pass(rig.clock(), 1s);
    EXPECT_EQ(heard, (std::vector<std::string>{"failed", "stopped"}));
    EXPECT_EQ(frames.size(), before);
    EXPECT_FALSE(camera.isRunning());
    camera.start();
    pass(rig.clock(), 1s);
    EXPECT_EQ(heard.size(), 3U);
    EXPECT_EQ(heard.back(), "failed");
    rig.plugCamera();
    camera.start();
    pass(rig.clock(), 110ms);
    EXPECT_EQ(frames.size(), before + 4);
    EXPECT_EQ(heard.size(), 3U);
}

TEST(SimulatedCamera, TwoRunsGiveTheSamePicturesAtTheSameTimes) {
    const auto run = [] {
        SimulatedRig rig(*findScenario("coded"), 4);
        rig.setSpeed(0);
        SimulatedSkin skin(rig);
        SimulatedCamera camera(rig);
        std::vector<std::pair<RigClock::Time, cv::Mat>> pictures;
        std::vector<Vector3d> readings;
        std::vector<float> temperatures;
        const auto start = rig.now();
        QObject::connect(&camera, &FrameSource::frameArrived, &camera, [&](const CameraFrame& frame) {
            pictures.emplace_back(frame.time - start, frame.image);
            skin.light({{rig.world().skin.modules[frame.sequence % 14].id, std::nullopt}});
        });
        QObject::connect(&skin, &SkinDevice::accelerationArrived, &skin, [&](const AccelerationSample& sample) {
            readings.push_back(sample.readings.front().acceleration);
        });
        QObject::connect(&skin, &SkinDevice::tactileArrived, &skin, [&](const TactileSample& sample) {
            temperatures.push_back(sample.readings.front().temperature);
        });
        QObject::connect(&skin, &SkinDevice::opened, &skin, [&] {
            skin.streamAcceleration(true);
            skin.streamTactile(true);
        });
        rig.touch(rig.world().T_r_u.front().translation(), 1);
        skin.open();
        camera.start();
        rig.turnBody({1, 1, 0});
        pass(rig.clock(), 200ms);
        rig.moveCamera(rig.suggestedViews()[1]);
        pass(rig.clock(), 300ms);
        return std::tuple(pictures, readings, temperatures);
    };
    const auto first = run();
    const auto second = run();
    const auto& pictures = std::get<0>(first);
    const auto& pictures2 = std::get<0>(second);
    ASSERT_EQ(pictures.size(), pictures2.size());
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        EXPECT_EQ(pictures[i].first, pictures2[i].first);
        EXPECT_EQ(difference(pictures[i].second, pictures2[i].second), 0);
    }
    EXPECT_TRUE(std::get<1>(first) == std::get<1>(second));
    EXPECT_EQ(std::get<2>(first), std::get<2>(second));
}

TEST(SimulatedCamera, InRealTimePicturesAreNewOrLeftOut) {
    SimulatedRig rig(*findScenario("coded"), 4);
    SimulatedCamera camera(rig);
    std::vector<CameraFrame> frames;
    QEventLoop loop;
    QObject::connect(&camera, &FrameSource::frameArrived, &camera, [&](const CameraFrame& frame) {
        EXPECT_GE(rig.now(), frame.time);
        frames.push_back(frame);
        if (frames.size() == 20)
            loop.quit();
    });
    camera.start();
    rig.moveCamera(rig.suggestedViews()[1]);
    loop.exec();
    for (std::size_t i = 1; i < frames.size(); ++i) {
        const std::uint64_t steps = frames[i].sequence - frames[i - 1].sequence;
        EXPECT_GE(steps, 1U);
        EXPECT_NEAR(static_cast<double>((frames[i].time - frames[i - 1].time).count()),
                    static_cast<double>(steps) * 1e6 / 30, 1);
    }
}

TEST(SimulatedCamera, ColouredSkinsAreSeenInColour) {
    SimulatedRig rig(*findScenario("coloured"), 2);
    rig.setSpeed(0);
    SimulatedCamera camera(rig);
    const QSignalSpy frames(&camera, &FrameSource::frameArrived);
    camera.start();
    pass(rig.clock(), 50ms);
    ASSERT_GE(frames.count(), 1);
    EXPECT_EQ(frames.at(0).at(0).value<CameraFrame>().image.channels(), 3);
}

TEST(SimulatedCamera, DestroyedAtAnyTimeNothingIsLeftBehind) {
    for (int after = 0; after < 8; ++after) {
        SimulatedRig rig(*findScenario("coded"), 1);
        rig.setSpeed(after % 2);
        auto camera = std::make_unique<SimulatedCamera>(rig);
        camera->start();
        if (after > 1)
            pass(rig.clock(), std::chrono::milliseconds(10 * after));
        if (after == 6)
            camera->stop();
        camera.reset();
        // A picture that was under way must not keep time from going on.
        pass(rig.clock(), 10ms);
    }
}

TEST(SimulatedCamera, StoppedWhileAPictureIsDrawnTimeGoesOn) {
    SimulatedRig rig(*findScenario("coded"), 1);
    rig.setSpeed(0);
    SimulatedCamera camera(rig);
    const QSignalSpy frames(&camera, &FrameSource::frameArrived);
    camera.start();
    // The exposure is asked for first, so that this comes while its picture is being drawn.
    bool stopped = false;
    QObject::connect(&camera, &FrameSource::stopped, &camera, [&] { stopped = true; });
    settle();
    QTimer::singleShot(0, &camera, [&] { camera.stop(); });
    settle();
    pass(rig.clock(), 1s);
    EXPECT_TRUE(stopped);
    EXPECT_LE(frames.count(), 1);
}

TEST(SimulatedCamera, MayBeDestroyedByWhoGetsItsPicture) {
    for (const bool onFailure : {false, true}) {
        SimulatedRig rig(*findScenario("coded"), 1);
        rig.setSpeed(0);
        auto camera = std::make_unique<SimulatedCamera>(rig);
        QObject::connect(camera.get(), &FrameSource::frameArrived, &rig, [&] {
            if (!onFailure)
                camera.reset();
        });
        QObject::connect(camera.get(), &FrameSource::failed, &rig, [&] { camera.reset(); });
        camera->start();
        pass(rig.clock(), 100ms);
        rig.pullCamera();
        pass(rig.clock(), 100ms);
        EXPECT_EQ(camera, nullptr);
    }
}

TEST(SimulatedCamera, OutlivesItsRig) {
    auto rig = std::make_unique<SimulatedRig>(*findScenario("coded"), 1);
    SimulatedCamera camera(*rig);
    camera.start();
    pass(rig->clock(), 20ms);
    rig.reset();
    EXPECT_FALSE(camera.isRunning());
    const QSignalSpy failed(&camera, &FrameSource::failed);
    camera.start();
    camera.stop();
    settle();
    EXPECT_EQ(failed.count(), 1);
}

TEST(SimulatedRig, SaysOnceThatTheBodyRests) {
    SimulatedRig rig(*findScenario("coded"), 1);
    rig.setSpeed(0);
    const QSignalSpy rested(&rig, &SimulatedRig::bodyRested);
    EXPECT_EQ(rig.up(), Vector3d::UnitZ());
    EXPECT_TRUE(rig.isBodyAtRest());
    rig.turnBody({1, 0, 0});
    pass(rig.clock(), 500ms);
    rig.turnBody({0, 5, 0});
    pass(rig.clock(), HeldBody::kTurn + HeldBody::kSettle - 1ms);
    EXPECT_EQ(rested.count(), 0);
    pass(rig.clock(), 10s);
    EXPECT_EQ(rested.count(), 1);
    EXPECT_LT((rig.up() - Vector3d::UnitY()).norm(), 1e-12);
    EXPECT_THROW(rig.turnBody(Vector3d::Zero()), std::logic_error);
    Scenario blind = *findScenario("coded");
    blind.views.count = 0;
    EXPECT_THROW(SimulatedRig(blind, 1), std::logic_error);
}

}  // namespace
}  // namespace skincal
