#include "core/device/protocol_skin.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QDir>
#include <QElapsedTimer>
#include <QFile>
#include <QPointer>
#include <QSignalSpy>
#include <QTcpServer>
#include <QTcpSocket>
#include <QTemporaryDir>
#include <set>

#include "core/rig/pseudo_terminal.h"
#include "core/rig/wired_skin.h"
#include "tests/wait_for.h"

namespace skincal {
namespace {

using test::waitFor;

std::vector<ModuleTemplate> allTemplates() {
    return {paperHexagon(), triangleTemplate(), rectangleTemplate()};
}

/// A device, and the rig's skin at the other end of a pseudo-terminal.
class AProtocolSkin : public testing::Test {
  protected:
    explicit AProtocolSkin(const WireFaults& faults = {})
        : rig(*findScenario("arm"), 3),
          wired(std::make_unique<WiredSkin>(rig, faults)),
          link(QDir(directory.path()).filePath(QStringLiteral("skin"))),
          device((plug(), parseLineAddress(link).value()), allTemplates()) {
        QObject::connect(&terminal, &PseudoTerminal::received, &rig, [this](const QByteArray& b) {
            if (wired && isPowered)
                wired->receive(b);
        });
        QObject::connect(wired.get(), &WiredSkin::sent, &terminal, &PseudoTerminal::write);
        QObject::connect(&device, &SkinDevice::explored, &rig, [this](const Skin& skin) {
            ++explorations;
            explored = skin;
        });
        QObject::connect(&device, &SkinDevice::failed, &rig, [this](const QString& why) { failure = why; });
        QObject::connect(&device, &SkinDevice::lightShown, &rig, [this](std::uint64_t token) { shown = token; });
    }

    void plug() { ASSERT_EQ(terminal.open(link), QString()); }
    void openIt() {
        const QSignalSpy opened(&device, &SkinDevice::opened);
        device.open();
        ASSERT_TRUE(waitFor([&] { return opened.count() > 0 || failure; })) << "neither opened nor failed";
        ASSERT_FALSE(failure) << failure->toStdString();
    }
    void exploreIt() {
        const int before = explorations;
        device.explore();
        ASSERT_TRUE(waitFor([&] { return explorations > before || failure; }));
        ASSERT_FALSE(failure) << failure->toStdString();
    }
    [[nodiscard]] bool light(const std::vector<LitModule>& lit) {
        const std::uint64_t token = device.light(lit);
        return waitFor([&] { return shown == token; });
    }
    /// By unique ids, as the network's numbers say nothing.
    [[nodiscard]] std::map<std::string, ModuleId> byUniqueId(const Skin& skin) const {
        std::map<std::string, ModuleId> ids;
        for (const SkinModule& module : skin.modules)
            ids[module.uniqueId] = module.id;
        return ids;
    }
    /// True ids of what shines in the rig, of modules of the device.
    [[nodiscard]] std::set<ModuleId> shining() const {
        std::set<ModuleId> lit;
        const auto ids = byUniqueId(explored);
        const auto index = rig.world().skin.indexById();
        for (const LitModule& one : rig.litAt(RigClock::Time::max()))
            lit.insert(ids.at(wired->network().uniqueId(index.at(one.module))));
        return lit;
    }

    QTemporaryDir directory;
    SimulatedRig rig;
    std::unique_ptr<WiredSkin> wired;
    bool isPowered = true;
    QString link;
    PseudoTerminal terminal;
    ProtocolSkin device;
    int explorations = 0;
    Skin explored;
    std::optional<QString> failure;
    std::uint64_t shown = 0;
};

TEST_F(AProtocolSkin, FindsTheModulesAndLinksOfTheSkin) {
    openIt();
    exploreIt();
    const Skin& truth = rig.world().skin;
    EXPECT_EQ(explored.modules.size(), truth.modules.size());
    EXPECT_EQ(explored.links.size(), truth.links.size());
    const auto ids = byUniqueId(explored);
    const auto index = truth.indexById();
    std::map<ModuleId, ModuleId> found;
    for (const SkinModule& module : truth.modules)
        found[module.id] = ids.at(wired->network().uniqueId(index.at(module.id)));
    using End = std::pair<ModuleId, int>;
    std::set<std::set<End>> reported;
    for (const Link& l : explored.links)
        reported.insert({{l.a, l.a_port}, {l.b, l.b_port}});
    for (const Link& l : truth.links)
        EXPECT_TRUE(reported.contains({{found[l.a], l.a_port}, {found[l.b], l.b_port}}));
}

TEST_F(AProtocolSkin, LightsWhatIsAskedForAndSaysWhenItShows) {
    openIt();
    exploreIt();
    std::vector<LitModule> some;
    std::set<ModuleId> expected;
    for (std::size_t i = 0; i < explored.modules.size(); i += 3) {
        some.push_back({explored.modules[i].id, std::nullopt});
        expected.insert(explored.modules[i].id);
    }
    device.prepare({some, {}});
    ASSERT_TRUE(light(some));
    EXPECT_EQ(shining(), expected);
    ASSERT_TRUE(light({}));
    EXPECT_TRUE(shining().empty());
    ASSERT_TRUE(light({{explored.modules[1].id, std::array{1, 0, 0}}}));
    EXPECT_EQ(shining(), std::set{explored.modules[1].id});
    EXPECT_EQ(rig.litAt(RigClock::Time::max()).front().colour, (std::array{1, 0, 0}));
}

TEST_F(AProtocolSkin, LightsAtAGivenTime) {
    openIt();
    exploreIt();
    ASSERT_TRUE(light({}));
    for (int k = 0; k < 5; ++k) {
        const std::vector<LitModule> one{{explored.modules[static_cast<std::size_t>(k)].id, std::nullopt}};
        const auto when = *device.now() + std::chrono::milliseconds(200);
        const std::uint64_t token = device.lightAt(one, when);
        ASSERT_TRUE(waitFor([&] { return shown == token; }));
        EXPECT_GE(*device.now() + std::chrono::milliseconds(20), when) << "the cells' clocks are nearly the computer's";
        EXPECT_EQ(shining(), std::set{one.front().module});
    }
}

TEST_F(AProtocolSkin, StreamsGravityAndTouchOfEveryModule) {
    openIt();
    exploreIt();
    std::map<ModuleId, Vector3d> read;
    QObject::connect(&device, &SkinDevice::accelerationArrived, &rig, [&](const AccelerationSample& sample) {
        for (const auto& reading : sample.readings)
            read[reading.module] = reading.acceleration;
    });
    std::set<ModuleId> felt;
    QObject::connect(&device, &SkinDevice::tactileArrived, &rig, [&](const TactileSample& sample) {
        for (const auto& reading : sample.readings)
            felt.insert(reading.module);
    });
    device.streamAcceleration(true);
    ASSERT_TRUE(waitFor([&] { return read.size() == explored.modules.size(); }));
    for (const auto& [module, acceleration] : read)
        EXPECT_NEAR(acceleration.norm(), 9.81, 1.5) << module.value;
    device.streamAcceleration(false);
    device.streamTactile(true);
    EXPECT_TRUE(waitFor([&] { return felt.size() == explored.modules.size(); }));
}

TEST_F(AProtocolSkin, AfterAnUnplugTheSameModulesComeBack) {
    openIt();
    exploreIt();
    const auto before = byUniqueId(explored);
    for (int round = 0; round < 5; ++round) {
        const QSignalSpy closed(&device, &SkinDevice::closed);
        terminal.close();
        ASSERT_TRUE(waitFor([&] { return failure.has_value(); }));
        EXPECT_TRUE(failure->contains(QLatin1String("unplugged"))) << failure->toStdString();
        EXPECT_EQ(closed.count(), 1);
        // Opening it now fails with a reason, and may be tried again.
        failure.reset();
        device.open();
        ASSERT_TRUE(waitFor([&] { return failure.has_value(); }));
        EXPECT_TRUE(failure->contains(QLatin1String("plugged in"))) << failure->toStdString();
        failure.reset();
        plug();
        openIt();
        exploreIt();
        EXPECT_EQ(byUniqueId(explored), before);
        ASSERT_TRUE(light({{explored.modules[2].id, std::nullopt}}));
        EXPECT_EQ(shining(), std::set{explored.modules[2].id});
    }
}

TEST_F(AProtocolSkin, AModuleThatRestartsIsFoundAgainWithoutAWord) {
    openIt();
    exploreIt();
    const int before = explorations;
    std::vector<LitModule> lit{{explored.modules[4].id, std::nullopt}};
    ASSERT_TRUE(light(lit));
    for (std::size_t cell = 0; cell < 6; ++cell) {
        wired->network().restart(cell * 2);
        wired->pump();
        lit = {{explored.modules[cell].id, std::nullopt}};
        // Commands that come while numbers are void wait for the new ones.
        ASSERT_TRUE(light(lit)) << cell;
        EXPECT_EQ(shining(), std::set{explored.modules[cell].id}) << cell;
    }
    EXPECT_EQ(explorations, before) << "nothing has changed that anybody must know";
    EXPECT_FALSE(failure);
}

TEST_F(AProtocolSkin, CellsThatRestartWhateverIsDoneAreAFailureWithItsReason) {
    openIt();
    exploreIt();
    // Of too weak a supply: whenever it is lit.
    QTimer weak;
    QObject::connect(&weak, &QTimer::timeout, &rig, [&] {
        if (wired->network().led(4) == 0)
            return;
        wired->network().restart(4);
        wired->pump();
    });
    weak.start(0);
    std::vector<LitModule> all;
    for (const SkinModule& module : explored.modules)
        all.push_back({module.id, std::nullopt});
    device.light(all);
    ASSERT_TRUE(waitFor([&] { return failure.has_value(); }));
    EXPECT_TRUE(failure->contains(QLatin1String("restart again and again"))) << failure->toStdString();
}

TEST_F(AProtocolSkin, ClosedItIsDarkAndSilent) {
    openIt();
    exploreIt();
    device.streamAcceleration(true);
    device.streamTactile(true);
    std::vector<LitModule> all;
    for (const SkinModule& module : explored.modules)
        all.push_back({module.id, std::nullopt});
    ASSERT_TRUE(light(all));
    EXPECT_EQ(shining().size(), all.size());
    device.close();
    ASSERT_TRUE(waitFor([&] { return rig.litAt(RigClock::Time::max()).empty(); }));
    // What was under way is given up after a while, and nothing new comes.
    std::uint64_t sent = 0;
    QElapsedTimer quiet;
    quiet.start();
    ASSERT_TRUE(waitFor([&] {
        if (std::exchange(sent, wired->network().bytesSent()) != wired->network().bytesSent())
            quiet.restart();
        return quiet.elapsed() > 1500;
    }));
}

TEST_F(AProtocolSkin, WhatIsStillSaidOfAnOpeningThatHasEndedDoesNotCount) {
    for (int round = 0; round < 10; ++round) {
        device.open();
        QCoreApplication::processEvents();
        terminal.close();  // which the device hears of, sooner or later
        device.close();
        plug();
        openIt();
        device.close();
    }
    EXPECT_FALSE(failure) << failure->toStdString();
}

TEST(AProgramsSkin, ThatNeverAnswersIsNotStartedAgainAndAgain) {
    const QTemporaryDir folder;
    const QString log = folder.filePath(QStringLiteral("starts"));
    ProtocolSkin device(parseLineAddress(QStringLiteral("exec:sh -c 'echo started >> %1'").arg(log)).value(),
                        allTemplates());
    QObject::connect(&device, &SkinDevice::cameBack, &device, [&] { device.open(); });
    std::optional<QString> why;
    QObject::connect(&device, &SkinDevice::failed, &device, [&](const QString& words) { why = words; });
    device.open();
    ASSERT_TRUE(waitFor([&] { return why.has_value(); }));
    EXPECT_TRUE(why->contains(QLatin1String("ended"))) << why->toStdString();
    // One that had answered would be tried again by then.
    QElapsedTimer time;
    time.start();
    ASSERT_TRUE(waitFor([&] { return time.elapsed() > 3500; }));
    QFile starts(log);
    ASSERT_TRUE(starts.open(QIODevice::ReadOnly));
    EXPECT_EQ(starts.readAll().count("started"), 1);
}

TEST_F(AProtocolSkin, HangsOnAGatewayJustAsWell) {
    QTcpServer gateway;
    ASSERT_TRUE(gateway.listen(QHostAddress::LocalHost));
    QPointer<QTcpSocket> peer;
    QObject::connect(&gateway, &QTcpServer::newConnection, &gateway, [&] {
        peer = gateway.nextPendingConnection();
        QObject::connect(peer, &QTcpSocket::readyRead, &rig, [this, &peer] { wired->receive(peer->readAll()); });
    });
    QObject::connect(wired.get(), &WiredSkin::sent, &gateway, [&](const QByteArray& bytes) {
        if (peer)
            peer->write(bytes);
    });
    ProtocolSkin remote(parseLineAddress(QStringLiteral("tcp://127.0.0.1:%1").arg(gateway.serverPort())).value(),
                        allTemplates());
    std::optional<Skin> found;
    QString why;
    QObject::connect(&remote, &SkinDevice::opened, &remote, [&] { remote.explore(); });
    QObject::connect(&remote, &SkinDevice::explored, &remote, [&](const Skin& skin) { found = skin; });
    QObject::connect(&remote, &SkinDevice::failed, &remote, [&](const QString& words) { why = words; });
    QObject::connect(&remote, &SkinDevice::lightShown, &remote, [this](std::uint64_t token) { shown = token; });
    for (int time = 0; time < 2; ++time) {
        found.reset();
        remote.open();
        ASSERT_TRUE(waitFor([&] { return found.has_value() || !why.isEmpty(); })) << time;
        ASSERT_TRUE(found) << why.toStdString();
        EXPECT_EQ(found->modules.size(), rig.world().skin.modules.size());
        EXPECT_EQ(found->links.size(), rig.world().skin.links.size());
        explored = *found;
        const std::uint64_t token = remote.light({{found->modules[3].id, std::nullopt}});
        ASSERT_TRUE(waitFor([&] { return shown == token; }));
        EXPECT_EQ(shining(), std::set{found->modules[3].id});
        peer->abort();
        ASSERT_TRUE(waitFor([&] { return !why.isEmpty(); }));
        EXPECT_TRUE(why.contains(QLatin1String("hung up"))) << why.toStdString();
        why.clear();
        shown = 0;
    }
}

TEST_F(AProtocolSkin, ThatFellSilentIsLookedForUntilItAnswers) {
    openIt();
    exploreIt();
    QObject::connect(&device, &SkinDevice::cameBack, &device, [&] { device.open(); });
    const QSignalSpy opened(&device, &SkinDevice::opened);
    isPowered = false;
    ASSERT_TRUE(waitFor([&] { return failure.has_value(); }));
    EXPECT_TRUE(failure->contains(QLatin1String("no longer answers"))) << failure->toStdString();
    EXPECT_TRUE(opened.empty());
    isPowered = true;
    ASSERT_TRUE(waitFor([&] { return !opened.empty(); }));
    failure.reset();
    exploreIt();
    EXPECT_EQ(explored.modules.size(), rig.world().skin.modules.size());
}

TEST_F(AProtocolSkin, ASilentPortSaysSo) {
    wired.reset();
    device.open();
    ASSERT_TRUE(waitFor([&] { return failure.has_value(); }));
    EXPECT_TRUE(failure->contains(QLatin1String("nothing answers"))) << failure->toStdString();
}

TEST_F(AProtocolSkin, MayGoAtAnyTime) {
    for (int after_ms : {0, 5, 30, 120}) {
        ProtocolSkin other(parseLineAddress(link).value(), allTemplates());
        other.open();
        QTimer wait;
        wait.setSingleShot(true);
        wait.start(after_ms);
        ASSERT_TRUE(waitFor([&] { return !wait.isActive(); }));
        other.explore();
    }
}

}  // namespace
}  // namespace skincal
