#include "core/rig/simulated_skin.h"

#include <gtest/gtest.h>

#include <QSignalSpy>
#include <map>
#include <set>

#include "tests/unit/rig/pass.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

class ASimulatedSkin : public testing::Test {
  protected:
    explicit ASimulatedSkin(const char* scenario = "coded") : rig(*findScenario(scenario), 4), skin(rig) {
        rig.setSpeed(0);
    }
    void openIt() {
        skin.open();
        pass(rig.clock(), 50ms);
        ASSERT_TRUE(skin.isOpen());
    }
    [[nodiscard]] std::size_t modules() const { return rig.world().T_r_u.size(); }

    SimulatedRig rig;
    SimulatedSkin skin;
};

template <class T>
T argument(const QSignalSpy& spy, int call) {
    return spy.at(call).at(0).value<T>();
}

TEST_F(ASimulatedSkin, OpensAndClosesFromTheEventLoop) {
    const QSignalSpy opened(&skin, &SkinDevice::opened);
    const QSignalSpy closed(&skin, &SkinDevice::closed);
    skin.open();
    skin.open();
    EXPECT_EQ(opened.count(), 0);
    pass(rig.clock(), 1s);
    EXPECT_EQ(opened.count(), 1);
    skin.open();
    pass(rig.clock(), 1s);
    EXPECT_EQ(opened.count(), 1) << "of an open device: nothing";
    skin.close();
    EXPECT_EQ(closed.count(), 0);
    pass(rig.clock(), 1s);
    EXPECT_EQ(closed.count(), 1);
    skin.close();
    pass(rig.clock(), 1s);
    EXPECT_EQ(closed.count(), 1) << "it was not open";
    skin.open();
    skin.close();
    pass(rig.clock(), 1s);
    EXPECT_EQ(opened.count(), 1) << "closed before it was open";
    EXPECT_EQ(closed.count(), 1);
    EXPECT_FALSE(skin.name().isEmpty());
}

TEST_F(ASimulatedSkin, ReportsModuleAfterModuleThenTheWholeSkin) {
    openIt();
    std::vector<std::pair<RigClock::Time, ModuleId>> found;
    QObject::connect(&skin, &SkinDevice::moduleFound, &skin,
                     [&](ModuleId module) { found.emplace_back(rig.now(), module); });
    const QSignalSpy explored(&skin, &SkinDevice::explored);
    const auto start = rig.now();
    skin.explore();
    EXPECT_TRUE(found.empty());
    pass(rig.clock(), 1500ms);
    ASSERT_EQ(found.size(), modules());
    ASSERT_EQ(explored.count(), 1);
    std::set<ModuleId> ids;
    auto last = start;
    for (const auto& [time, module] : found) {
        EXPECT_GT(time, last);
        last = time;
        EXPECT_TRUE(ids.insert(module).second);
    }
    const Skin reported = argument<Skin>(explored, 0);
    ASSERT_EQ(reported.modules.size(), modules());
    for (std::size_t u = 0; u < modules(); ++u)
        EXPECT_EQ(reported.modules[u].id, rig.world().skin.modules[u].id);
    EXPECT_EQ(reported.links.size(), rig.world().skin.links.size());
}

TEST_F(ASimulatedSkin, FindsNoModuleBeforeOneThatItIsLinkedTo) {
    openIt();
    const QSignalSpy found(&skin, &SkinDevice::moduleFound);
    skin.explore();
    pass(rig.clock(), 2s);
    std::set<ModuleId> known;
    int islands = 0;
    for (int i = 0; i < found.count(); ++i) {
        const auto module = argument<ModuleId>(found, i);
        bool linked = false;
        for (const Link& link : rig.world().skin.links)
            linked = linked || (link.a == module && known.count(link.b) > 0) ||
                     (link.b == module && known.count(link.a) > 0);
        islands += linked ? 0 : 1;
        known.insert(module);
    }
    EXPECT_EQ(islands, 2) << "two patches without a cable";
}

TEST_F(ASimulatedSkin, ExploredTwiceItAnswersOnce) {
    openIt();
    const QSignalSpy found(&skin, &SkinDevice::moduleFound);
    const QSignalSpy explored(&skin, &SkinDevice::explored);
    skin.explore();
    pass(rig.clock(), 23ms);
    const auto before = static_cast<std::size_t>(found.count());
    EXPECT_GT(before, 0U);
    skin.explore();
    pass(rig.clock(), 2s);
    EXPECT_EQ(static_cast<std::size_t>(found.count()), before + modules());
    EXPECT_EQ(explored.count(), 1);
}

TEST_F(ASimulatedSkin, ClosedWhileExploringItFallsSilent) {
    for (const auto after : {0ms, 7ms, 30ms, 80ms}) {
        openIt();
        const QSignalSpy found(&skin, &SkinDevice::moduleFound);
        const QSignalSpy explored(&skin, &SkinDevice::explored);
        const QSignalSpy closed(&skin, &SkinDevice::closed);
        skin.explore();
        pass(rig.clock(), after);
        const auto before = found.count();
        skin.close();
        pass(rig.clock(), 2s);
        EXPECT_EQ(found.count(), before);
        EXPECT_EQ(explored.count(), 0);
        EXPECT_EQ(closed.count(), 1);
    }
}

TEST_F(ASimulatedSkin, ClosedByWhoHearsOfAModuleItFallsSilent) {
    openIt();
    int found = 0;
    QObject::connect(&skin, &SkinDevice::moduleFound, &skin, [&] {
        if (++found == 3)
            skin.close();
    });
    const QSignalSpy explored(&skin, &SkinDevice::explored);
    skin.explore();
    pass(rig.clock(), 2s);
    EXPECT_EQ(found, 3);
    EXPECT_EQ(explored.count(), 0);
}

TEST_F(ASimulatedSkin, NotOpenItExploresStreamsAndLightsNothing) {
    const QSignalSpy failed(&skin, &SkinDevice::failed);
    const QSignalSpy acceleration(&skin, &SkinDevice::accelerationArrived);
    const QSignalSpy tactile(&skin, &SkinDevice::tactileArrived);
    const QSignalSpy shown(&skin, &SkinDevice::lightShown);
    skin.explore();
    skin.streamAcceleration(true);
    skin.streamTactile(true);
    const auto token = skin.light({{rig.world().skin.modules[0].id, std::nullopt}});
    EXPECT_EQ(failed.count(), 0) << "never from inside the call";
    pass(rig.clock(), 1s);
    EXPECT_EQ(failed.count(), 1);
    EXPECT_EQ(acceleration.count() + tactile.count() + shown.count(), 0);
    EXPECT_TRUE(rig.litAt(rig.now() + 1s).empty());
    EXPECT_GT(skin.light({}), token);
}

TEST_F(ASimulatedSkin, AcknowledgesTheNewestCommand) {
    openIt();
    const QSignalSpy shown(&skin, &SkinDevice::lightShown);
    const std::vector<LitModule> lit{{rig.world().skin.modules[2].id, std::nullopt}};
    const auto first = skin.light(lit);
    EXPECT_EQ(shown.count(), 0);
    pass(rig.clock(), 10ms);
    ASSERT_EQ(shown.count(), 1);
    EXPECT_EQ(argument<std::uint64_t>(shown, 0), first);
    const auto overtaken = skin.light({});
    const auto last = skin.light(lit);
    EXPECT_GT(overtaken, first);
    EXPECT_GT(last, overtaken);
    pass(rig.clock(), 10ms);
    ASSERT_EQ(shown.count(), 2);
    EXPECT_EQ(argument<std::uint64_t>(shown, 1), last);
}

TEST_F(ASimulatedSkin, LightsAtAGivenTimeWhatNoNewerCommandOvertakes) {
    rig.setCameraLatency(0ms);
    const std::vector<LitModule> lit{{rig.world().skin.modules[2].id, std::nullopt}};
    skin.lightAt(lit, rig.now());
    pass(rig.clock(), 10ms);
    EXPECT_TRUE(rig.litAt(rig.now()).empty()) << "it is not open";
    openIt();
    EXPECT_EQ(skin.now(), rig.now());
    const QSignalSpy shown(&skin, &SkinDevice::lightShown);
    const auto when = rig.now() + 50ms;
    const auto token = skin.lightAt(lit, when);
    pass(rig.clock(), 53ms);
    EXPECT_TRUE(rig.litAt(when - 1us).empty());
    EXPECT_EQ(rig.litAt(when).size(), 1U);
    EXPECT_EQ(shown.count(), 0);
    pass(rig.clock(), 2ms);
    ASSERT_EQ(shown.count(), 1);
    EXPECT_EQ(argument<std::uint64_t>(shown, 0), token);
    // What is over is at once.
    skin.lightAt({}, rig.now() - 1s);
    pass(rig.clock(), 1ms);
    EXPECT_TRUE(rig.litAt(rig.now()).empty());
    skin.lightAt(lit, rig.now() + 50ms);
    skin.light({});
    pass(rig.clock(), 1s);
    EXPECT_TRUE(rig.litAt(rig.now()).empty());
}

TEST_F(ASimulatedSkin, ClosedItsLedsAreDark) {
    openIt();
    skin.light({{rig.world().skin.modules[2].id, std::nullopt}});
    pass(rig.clock(), 1s);
    EXPECT_EQ(rig.litAt(rig.now()).size(), 1U);
    skin.close();
    pass(rig.clock(), 1s);
    EXPECT_TRUE(rig.litAt(rig.now()).empty());
}

TEST_F(ASimulatedSkin, StreamsAHundredSamplesASecondUntilToldNotTo) {
    openIt();
    std::vector<RigClock::Time> times;
    QObject::connect(&skin, &SkinDevice::accelerationArrived, &skin, [&](const AccelerationSample& sample) {
        EXPECT_EQ(sample.time, rig.now());
        EXPECT_EQ(sample.readings.size(), modules());
        times.push_back(sample.time);
    });
    skin.streamAcceleration(true);
    skin.streamAcceleration(true);
    pass(rig.clock(), 1s);
    EXPECT_EQ(times.size(), 100U);
    for (std::size_t i = 1; i < times.size(); ++i)
        EXPECT_EQ(times[i] - times[i - 1], 10ms);
    skin.streamAcceleration(false);
    pass(rig.clock(), 1s);
    EXPECT_EQ(times.size(), 100U);
    skin.streamAcceleration(true);
    skin.streamAcceleration(false);
    skin.streamAcceleration(true);
    pass(rig.clock(), 1s);
    EXPECT_EQ(times.size(), 200U) << "one stream, however often it was started";
    skin.close();
    pass(rig.clock(), 1s);
    EXPECT_EQ(times.size(), 200U);
    openIt();
    pass(rig.clock(), 1s);
    EXPECT_EQ(times.size(), 200U) << "opened anew, nothing streams";
}

/// Mean and standard deviation per module and axis of what streams within a time.
struct Statistics {
    std::map<ModuleId, Vector3d> sum;
    std::map<ModuleId, Vector3d> squares;
    int samples = 0;

    void add(const AccelerationSample& sample) {
        for (const auto& reading : sample.readings) {
            if (samples == 0)
                sum[reading.module] = squares[reading.module] = Vector3d::Zero();
            sum[reading.module] += reading.acceleration;
            squares[reading.module] += reading.acceleration.cwiseAbs2();
        }
        ++samples;
    }
    [[nodiscard]] Vector3d mean(ModuleId module) const { return sum.at(module) / samples; }
    [[nodiscard]] Vector3d variance(ModuleId module) const {
        return squares.at(module) / samples - mean(module).cwiseAbs2();
    }
};

class MovedSkin : public ASimulatedSkin {
  protected:
    MovedSkin() : ASimulatedSkin("moved-joint") {}
};

/// At rest, each module reads what simulateGravity says that it reads in such a pose, with the same noise.
void expectGravityAtRest(SimulatedRig& rig, SimulatedSkin& skin) {
    const World& world = rig.world();
    std::map<std::pair<int, ModuleId>, Vector3d> gravity;
    for (const GravityReading& reading : simulateGravity(world))
        gravity[{reading.pose, reading.module}] = reading.acceleration;
    skin.streamAcceleration(true);
    const QSignalSpy rested(&rig, &SimulatedRig::bodyRested);
    double off = 0;
    double variance = 0;
    int count = 0;
    for (int pose = 0; pose < 4; ++pose) {
        rig.turnBody(world.gravity_r[static_cast<std::size_t>(pose)]);
        EXPECT_FALSE(rig.isBodyAtRest());
        pass(rig.clock(), HeldBody::kTurn + HeldBody::kSettle);
        ASSERT_EQ(rested.count(), pose + 1);
        EXPECT_TRUE(rig.isBodyAtRest());
        Statistics statistics;
        const auto connection = QObject::connect(&skin, &SkinDevice::accelerationArrived, &skin,
                                                 [&](const AccelerationSample& sample) { statistics.add(sample); });
        pass(rig.clock(), 2s);
        QObject::disconnect(connection);
        ASSERT_EQ(statistics.samples, 200);
        for (const SkinModule& module : world.skin.modules) {
            const Vector3d d = statistics.mean(module.id) - gravity.at({pose, module.id});
            EXPECT_LT(d.cwiseAbs().maxCoeff(), 6 * world.scenario.sensors.noise);
            off += d.squaredNorm() / 3;
            variance += statistics.variance(module.id).mean();
            ++count;
        }
    }
    const double noise = world.scenario.sensors.noise;
    EXPECT_NEAR(std::sqrt(off / count), noise * std::sqrt(1 + 1.0 / 200), 0.15 * noise);
    EXPECT_NEAR(std::sqrt(variance / count), noise, 0.05 * noise);
}

TEST_F(ASimulatedSkin, AtRestItReadsWhatSimulateGravityReads) {
    openIt();
    expectGravityAtRest(rig, skin);
}

TEST_F(MovedSkin, ReadsGravityAsBeforeItMoved) {
    openIt();
    expectGravityAtRest(rig, skin);
}

TEST_F(ASimulatedSkin, ShakesWhileItIsTurned) {
    openIt();
    skin.streamAcceleration(true);
    pass(rig.clock(), 100ms);
    const auto unrest = [&](RigClock::Time duration) {
        Statistics statistics;
        const auto connection = QObject::connect(&skin, &SkinDevice::accelerationArrived, &skin,
                                                 [&](const AccelerationSample& sample) { statistics.add(sample); });
        pass(rig.clock(), duration);
        QObject::disconnect(connection);
        double sum = 0;
        for (const SkinModule& module : rig.world().skin.modules)
            sum += statistics.variance(module.id).mean();
        return std::sqrt(sum / static_cast<double>(modules()));
    };
    const double still = unrest(500ms);
    rig.turnBody({1, 0, 0});
    const double turning = unrest(1s);
    EXPECT_GT(turning, 30 * still);
    pass(rig.clock(), HeldBody::kSettle);
    EXPECT_LT(unrest(500ms), 1.2 * still);
}

TEST_F(ASimulatedSkin, FeelsAHandWhereItIs) {
    openIt();
    TactileSample last;
    int samples = 0;
    QObject::connect(&skin, &SkinDevice::tactileArrived, &skin, [&](const TactileSample& sample) {
        last = sample;
        ++samples;
    });
    skin.streamTactile(true);
    pass(rig.clock(), 1s);
    ASSERT_EQ(samples, 100);
    ASSERT_EQ(last.readings.size(), modules());
    std::vector<float> cold;
    for (const auto& reading : last.readings) {
        EXPECT_LT(reading.proximity, 0.05F);
        EXPECT_LT(reading.force[0] + reading.force[1] + reading.force[2], 0.2F);
        EXPECT_NEAR(static_cast<double>(reading.temperature), 24, 3);
        const Eigen::Vector3f a(reading.acceleration[0], reading.acceleration[1], reading.acceleration[2]);
        EXPECT_NEAR(static_cast<double>(a.norm()), kStandardGravity, 2);
        cold.push_back(reading.temperature);
    }
    // Dragged from one module to another: felt at each, and no more at the one before.
    for (const std::size_t touched : {std::size_t{0}, modules() - 1}) {
        rig.touch(rig.world().T_r_u[touched].translation(), 3);
        pass(rig.clock(), 3s);
        for (std::size_t u = 0; u < modules(); ++u) {
            const double distance =
                (rig.world().T_r_u[u].translation() - rig.world().T_r_u[touched].translation()).norm();
            const auto& reading = last.readings[u];
            const float force = reading.force[0] + reading.force[1] + reading.force[2];
            EXPECT_EQ(reading.module, rig.world().skin.modules[u].id);
            if (u == touched) {
                EXPECT_GT(reading.proximity, 0.95F);
                EXPECT_GT(force, 1.0F);
                EXPECT_GT(reading.temperature, cold[u] + 2);
            } else if (distance > 0.05) {
                EXPECT_LT(reading.proximity, 0.05F);
                EXPECT_LT(force, 0.2F);
            }
        }
    }
    rig.release();
    pass(rig.clock(), 20ms);
    for (const auto& reading : last.readings)
        EXPECT_LT(reading.proximity, 0.05F);
    EXPECT_THROW(rig.touch(Vector3d::Zero(), -1), std::logic_error);
}

TEST_F(ASimulatedSkin, UnpluggedInTheMiddleItFailsAndCloses) {
    openIt();
    std::vector<std::string> heard;
    QObject::connect(&skin, &SkinDevice::failed, &skin, [&](const QString& why) {
        EXPECT_FALSE(why.isEmpty());
        heard.emplace_back("failed");
    });
    QObject::connect(&skin, &SkinDevice::closed, &skin, [&] { heard.emplace_back("closed"); });
    const QSignalSpy found(&skin, &SkinDevice::moduleFound);
    const QSignalSpy samples(&skin, &SkinDevice::accelerationArrived);
    const QSignalSpy shown(&skin, &SkinDevice::lightShown);
    skin.streamAcceleration(true);
    skin.explore();
    pass(rig.clock(), 32ms);
    const auto before = found.count() + samples.count();
    EXPECT_GT(found.count(), 0);
    EXPECT_GT(samples.count(), 0);
    skin.light({{rig.world().skin.modules[0].id, std::nullopt}});
    rig.pullSkin();
    rig.pullSkin();
    EXPECT_TRUE(heard.empty()) << "never from inside the call";
    pass(rig.clock(), 2s);
    EXPECT_EQ(heard, (std::vector<std::string>{"failed", "closed"}));
    EXPECT_EQ(found.count() + samples.count(), before);
    EXPECT_EQ(shown.count(), 0);
    EXPECT_TRUE(rig.litAt(rig.now()).empty());
    EXPECT_FALSE(skin.isOpen());

    skin.open();
    pass(rig.clock(), 1s);
    EXPECT_EQ(heard.size(), 3U);
    EXPECT_EQ(heard.back(), "failed");
    rig.plugSkin();
    openIt();
    EXPECT_EQ(heard.size(), 3U);
}

TEST_F(ASimulatedSkin, UnpluggedWhileItOpensItFails) {
    const QSignalSpy failed(&skin, &SkinDevice::failed);
    const QSignalSpy opened(&skin, &SkinDevice::opened);
    skin.open();
    rig.pullSkin();
    pass(rig.clock(), 1s);
    EXPECT_EQ(failed.count(), 1);
    EXPECT_EQ(opened.count(), 0);
}

TEST(SimulatedSkin, AThousandModulesAreFoundInTimeAndAllStream) {
    SimulatedRig rig(*findScenario("thousand"), 1);
    rig.setSpeed(0);
    SimulatedSkin skin(rig);
    skin.open();
    pass(rig.clock(), 20ms);
    const QSignalSpy found(&skin, &SkinDevice::moduleFound);
    const QSignalSpy explored(&skin, &SkinDevice::explored);
    skin.explore();
    pass(rig.clock(), 1500ms);
    EXPECT_EQ(found.count(), 1000);
    EXPECT_EQ(explored.count(), 1);
    std::size_t readings = 0;
    QObject::connect(&skin, &SkinDevice::accelerationArrived, &skin,
                     [&](const AccelerationSample& sample) { readings += sample.readings.size(); });
    QObject::connect(&skin, &SkinDevice::tactileArrived, &skin,
                     [&](const TactileSample& sample) { readings += sample.readings.size(); });
    skin.streamAcceleration(true);
    skin.streamTactile(true);
    pass(rig.clock(), 1s);
    EXPECT_EQ(readings, 200'000U);
}

TEST(SimulatedSkin, DestroyedAtAnyTimeNothingIsLeftBehind) {
    for (int after = 0; after < 60; after += 3) {
        SimulatedRig rig(*findScenario("coded"), 1);
        rig.setSpeed(0);
        auto skin = std::make_unique<SimulatedSkin>(rig);
        skin->open();
        pass(rig.clock(), 21ms);
        skin->explore();
        skin->streamAcceleration(true);
        skin->streamTactile(true);
        skin->light({{rig.world().skin.modules[0].id, std::nullopt}});
        pass(rig.clock(), std::chrono::milliseconds(after));
        skin.reset();
        pass(rig.clock(), 1s);
        EXPECT_TRUE(rig.litAt(rig.now()).empty());
    }
}

TEST(SimulatedSkin, MayBeDestroyedByWhoHearsOfIt) {
    enum class Signal { Opened, Found, Explored, Acceleration, Tactile, Shown, Failed };
    for (const Signal signal : {Signal::Opened, Signal::Found, Signal::Explored, Signal::Acceleration, Signal::Tactile,
                                Signal::Shown, Signal::Failed}) {
        SimulatedRig rig(*findScenario("coded"), 1);
        rig.setSpeed(0);
        auto skin = std::make_unique<SimulatedSkin>(rig);
        const auto destroyAt = [&](Signal wanted) {
            if (signal == wanted)
                skin.reset();
        };
        QObject::connect(skin.get(), &SkinDevice::opened, &rig, [&] { destroyAt(Signal::Opened); });
        QObject::connect(skin.get(), &SkinDevice::moduleFound, &rig, [&] { destroyAt(Signal::Found); });
        QObject::connect(skin.get(), &SkinDevice::explored, &rig, [&] { destroyAt(Signal::Explored); });
        QObject::connect(skin.get(), &SkinDevice::accelerationArrived, &rig, [&] { destroyAt(Signal::Acceleration); });
        QObject::connect(skin.get(), &SkinDevice::tactileArrived, &rig, [&] { destroyAt(Signal::Tactile); });
        QObject::connect(skin.get(), &SkinDevice::lightShown, &rig, [&] { destroyAt(Signal::Shown); });
        QObject::connect(skin.get(), &SkinDevice::failed, &rig, [&] { destroyAt(Signal::Failed); });
        skin->open();
        pass(rig.clock(), 50ms);
        if (skin) {
            skin->explore();
            skin->streamAcceleration(true);
            skin->streamTactile(true);
            skin->light({});
        }
        pass(rig.clock(), 1s);
        rig.pullSkin();
        pass(rig.clock(), 1s);
        EXPECT_EQ(skin, nullptr);
    }
}

TEST(SimulatedSkin, OutlivesItsRig) {
    auto rig = std::make_unique<SimulatedRig>(*findScenario("coded"), 1);
    rig->setSpeed(0);
    SimulatedSkin skin(*rig);
    skin.open();
    pass(rig->clock(), 50ms);
    skin.explore();
    skin.streamAcceleration(true);
    rig.reset();
    EXPECT_FALSE(skin.isOpen());
    const QSignalSpy failed(&skin, &SkinDevice::failed);
    skin.open();
    skin.explore();
    skin.light({});
    skin.close();
    settle();
    EXPECT_EQ(failed.count(), 2);
}

}  // namespace
}  // namespace skincal
