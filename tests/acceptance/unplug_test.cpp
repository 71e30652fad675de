// Skins that are unplugged at any moment, through a real pseudo-terminal. In full with SKINCAL_UNPLUGS=1000.

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QDir>
#include <QElapsedTimer>
#include <QTemporaryDir>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <optional>
#include <vector>

#include "core/device/protocol_skin.h"
#include "core/geometry/se3.h"
#include "core/rig/pseudo_terminal.h"
#include "core/rig/wired_skin.h"
#include "tests/wait_for.h"

namespace skincal {
namespace {

using test::waitFor;

int unplugs() {
    const char* text = std::getenv("SKINCAL_UNPLUGS");
    return text ? std::atoi(text) : 50;
}

void letPass(int milliseconds) {
    QElapsedTimer timer;
    timer.start();
    while (timer.elapsed() < milliseconds)
        QCoreApplication::processEvents(QEventLoop::AllEvents, milliseconds);
}

/// A simulated skin behind a pseudo-terminal, and the device at the other end of it, not opened yet.
class Unplug : public testing::Test {
  protected:
    void SetUp() override {
        QObject::connect(&terminal, &PseudoTerminal::received, &wired, [this](const QByteArray& bytes) {
            if (isPowered)
                wired.receive(bytes);
        });
        QObject::connect(&wired, &WiredSkin::sent, &terminal, &PseudoTerminal::write);
        ASSERT_EQ(terminal.open(link), QString());
    }

    SimulatedRig rig{*findScenario("arm"), 3};
    WiredSkin wired{rig, {}};
    QTemporaryDir directory;
    QString link = QDir(directory.path()).filePath(QStringLiteral("skin"));
    PseudoTerminal terminal;
    bool isPowered = true;
    ProtocolSkin device{parseLineAddress(link).value(), {paperHexagon(), triangleTemplate(), rectangleTemplate()}};
};

TEST_F(Unplug, AtAnyMomentIsNoticedAndTheSameModulesComeBack) {
    std::map<std::string, std::size_t> places;
    std::map<std::string, ModuleId> first;
    std::vector<ModuleId> present;
    std::map<ModuleId, std::size_t> placeOf;
    const World& world = rig.world();
    for (std::size_t i = 0; i < wired.network().cells(); ++i)
        places[wired.network().uniqueId(i)] = i;
    // Without that one nobody answers.
    const std::size_t root = world.skin.indexById().at(placeForComputer(world.skin).value().module);
    bool isReady = false;
    bool hasFailed = false;
    std::size_t strangers = 0;
    std::size_t wrongReadings = 0;
    std::optional<std::uint64_t> shown;
    QObject::connect(&device, &SkinDevice::opened, &device, [&] { device.explore(); });
    QString why;
    QObject::connect(&device, &SkinDevice::failed, &device, [&](const QString& words) {
        hasFailed = true;
        isReady = false;
        why = words;
    });
    QObject::connect(&device, &SkinDevice::cameBack, &device, [&] { device.open(); });
    QObject::connect(&device, &SkinDevice::explored, &device, [&](const Skin& skin) {
        for (const SkinModule& module : skin.modules) {
            const auto [entry, isNew] = first.emplace(module.uniqueId, module.id);
            strangers += entry->second != module.id;
            placeOf[module.id] = places.at(module.uniqueId);
        }
        present.clear();
        for (const SkinModule& module : skin.modules)
            present.push_back(module.id);
        isReady = true;
        device.streamAcceleration(true);
    });
    QObject::connect(&device, &SkinDevice::lightShown, &device, [&](std::uint64_t token) { shown = token; });
    // No reading of a module that isn't there, none that is another's.
    QObject::connect(&device, &SkinDevice::accelerationArrived, &device, [&](const AccelerationSample& sample) {
        for (const auto& reading : sample.readings) {
            const auto place = placeOf.find(reading.module);
            strangers += place == placeOf.end();
            if (place == placeOf.end())
                continue;
            const Vector3d up_u = world.T_r_u[place->second].linear().transpose() * rig.up();
            // As inexact as sensors are that nobody has calibrated.
            wrongReadings += up_u.dot(reading.acceleration.normalized()) < std::cos(10 * kDegree);
        }
    });
    // What counts as lit is that one module, and no other.
    const auto lightsTheRightOne = [&](ModuleId module) {
        shown.reset();
        const std::uint64_t token = device.light({{module, std::nullopt}});
        if (!waitFor([&] { return shown == token || !isReady; }) || !isReady)
            return true;
        // Those that a dead one cuts off can't be told.
        return std::all_of(present.begin(), present.end(), [&](ModuleId other) {
            return (wired.network().led(placeOf.at(other)) != 0) == (other == module);
        });
    };

    Random chance(1, "unplugs");
    std::optional<std::size_t> dead;
    double slowestNotice = 0;
    double slowestReturn = 0;
    device.open();
    ASSERT_TRUE(waitFor([&] { return isReady; }));
    for (int round = 0; round < unplugs(); ++round) {
        letPass(static_cast<int>(60 * chance.uniform()));
        // A loose plug may be noticed once it is in for good: it is ready for a moment as it was before.
        ASSERT_TRUE(waitFor([&] { return isReady; })) << round;
        ASSERT_FALSE(present.empty());
        EXPECT_TRUE(lightsTheRightOne(present[chance.index(present.size())])) << round;
        if (chance.uniform() < 0.5)
            device.light({{present.front(), std::nullopt}});
        hasFailed = !isReady;  // already: on a busy machine it may fall silent for as long as counts as unplugged
        QElapsedTimer timer;
        timer.start();
        terminal.close();
        ASSERT_TRUE(waitFor([&] { return hasFailed; })) << round;
        // Who is missing changes everybody's number.
        if (dead)
            wired.network().restart(*std::exchange(dead, std::nullopt));
        else if (chance.uniform() < 0.3)
            wired.network().kill(*(dead = (root + 1 + chance.index(places.size() - 1)) % places.size()));
        slowestNotice = std::max(slowestNotice, 1e-3 * static_cast<double>(timer.elapsed()));
        // A loose plug: in and out, while it is opened and explored.
        while (chance.uniform() < 0.4) {
            ASSERT_EQ(terminal.open(link), QString());
            letPass(static_cast<int>(700 * chance.uniform()));
            terminal.close();
            letPass(static_cast<int>(30 * chance.uniform()));
        }
        ASSERT_EQ(terminal.open(link), QString());
        timer.restart();
        ASSERT_TRUE(waitFor([&] { return isReady; })) << round << ": " << why.toStdString();
        slowestReturn = std::max(slowestReturn, 1e-3 * static_cast<double>(timer.elapsed()));
    }
    EXPECT_EQ(strangers, 0U);
    EXPECT_EQ(wrongReadings, 0U);
    EXPECT_EQ(first.size(), rig.world().skin.modules.size());
    // Where nothing else keeps the machine busy.
    if (std::getenv("SKINCAL_UNPLUGS") != nullptr) {
        EXPECT_LT(slowestNotice, 1);
        EXPECT_LT(slowestReturn, 5);
    }
    std::cout << unplugs() << " unplugs: noticed within " << slowestNotice << " s, back within " << slowestReturn
              << " s\n";
}

// A board that waits for an upload first, or is plugged in without its power supply.
TEST_F(Unplug, WhatIsSilentAtFirstAfterItsReturnIsWaitedFor) {
    bool isOpen = false;
    QStringList complaints;
    QObject::connect(&device, &SkinDevice::opened, &device, [&] { isOpen = true; });
    QObject::connect(&device, &SkinDevice::failed, &device, [&](const QString& why) {
        isOpen = false;
        complaints << why;
    });
    QObject::connect(&device, &SkinDevice::cameBack, &device, [&] { device.open(); });
    device.open();
    ASSERT_TRUE(waitFor([&] { return isOpen; }));
    terminal.close();
    ASSERT_TRUE(waitFor([&] { return complaints.size() == 1; }));
    isPowered = false;
    ASSERT_EQ(terminal.open(link), QString());
    ASSERT_TRUE(waitFor([&] { return complaints.size() == 2; }));
    EXPECT_TRUE(complaints.back().contains(QStringLiteral("nothing answers"))) << complaints.back().toStdString();
    isPowered = true;
    EXPECT_TRUE(waitFor([&] { return isOpen; }));
}

}  // namespace
}  // namespace skincal
