#include "core/rig/rig_clock.h"

#include <gtest/gtest.h>

#include <QEventLoop>
#include <memory>
#include <stdexcept>

#include "core/geometry/random.h"
#include "tests/unit/rig/pass.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

TEST(RigClock, CallsInTheOrderOfTimeThenOfAsking) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        RigClock clock;
        clock.setSpeed(0);
        const auto start = clock.now();
        Random random(seed, "calls");
        std::vector<std::pair<RigClock::Time, int>> asked;
        std::vector<std::pair<RigClock::Time, int>> called;
        for (int i = 0; i < 50; ++i) {
            const RigClock::Time when = start + std::chrono::milliseconds(random.index(20));
            asked.emplace_back(when, i);
            clock.at(when, &clock, [&, when, i] {
                EXPECT_EQ(clock.now(), when);
                called.emplace_back(when, i);
            });
        }
        EXPECT_TRUE(called.empty()) << "never from inside at()";
        pass(clock, 1s);
        std::sort(asked.begin(), asked.end());
        EXPECT_EQ(called, asked);
    }
}

TEST(RigClock, StandsStillWhereNothingIsAskedFor) {
    RigClock clock;
    clock.setSpeed(0);
    const auto start = clock.now();
    QEventLoop loop;
    QTimer::singleShot(20, &loop, &QEventLoop::quit);
    loop.exec();
    EXPECT_EQ(clock.now(), start);
}

TEST(RigClock, WaitsWhileItIsHeld) {
    RigClock clock;
    clock.setSpeed(0);
    bool called = false;
    clock.at(clock.now(), &clock, [&] { called = true; });
    clock.hold();
    QEventLoop loop;
    QTimer::singleShot(20, &loop, &QEventLoop::quit);
    loop.exec();
    EXPECT_FALSE(called);
    clock.release();
    pass(clock, 1ms);
    EXPECT_TRUE(called);
    EXPECT_THROW(clock.release(), std::logic_error);
}

TEST(RigClock, GoesAsFastAsItIsTold) {
    for (const double speed : {1.0, 100.0}) {
        RigClock clock;
        clock.setSpeed(speed);
        const auto start = clock.now();
        const auto wall = std::chrono::steady_clock::now();
        pass(clock, 30ms);
        const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - wall;
        EXPECT_GE(clock.now() - start, 30ms) << "never early";
        EXPECT_GE(passed.count() * speed, 0.0299);
    }
    RigClock clock;
    EXPECT_THROW(clock.setSpeed(-1), std::logic_error);
    EXPECT_THROW(clock.setSpeed(std::nan("")), std::logic_error);
}

TEST(RigClock, TimeNeverGoesBackWhateverTheSpeed) {
    RigClock clock;
    auto before = clock.now();
    for (const double speed : {0.0, 3.0, 0.0, 0.5, 1000.0, 0.0}) {
        clock.setSpeed(speed);
        pass(clock, 5ms);
        EXPECT_GE(clock.now(), before + 5ms);
        before = clock.now();
    }
}

TEST(RigClock, CallsNobodyWhoHasDied) {
    RigClock clock;
    clock.setSpeed(0);
    auto context = std::make_unique<QObject>();
    bool called = false;
    clock.at(clock.now() + 1ms, context.get(), [&] { called = true; });
    context.reset();
    pass(clock, 2ms);
    EXPECT_FALSE(called);
}

TEST(RigClock, GoesOnInANestedEventLoop) {
    RigClock clock;
    clock.setSpeed(0);
    std::vector<int> order;
    clock.at(clock.now() + 1ms, &clock, [&] {
        order.push_back(1);
        pass(clock, 10ms);
        order.push_back(3);
    });
    clock.at(clock.now() + 2ms, &clock, [&] { order.push_back(2); });
    pass(clock, 20ms);
    EXPECT_EQ(order, (std::vector<int>{1, 2, 3}));
}

TEST(RigClock, MayBeDestroyedByWhatItCalls) {
    auto clock = std::make_unique<RigClock>();
    clock->setSpeed(0);
    QEventLoop loop;
    clock->at(clock->now(), clock.get(), [&] {
        clock.reset();
        loop.quit();
    });
    loop.exec();
    EXPECT_EQ(clock, nullptr);
}

}  // namespace
}  // namespace skincal
