#include "core/procedure/stillness.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/geometry/random.h"
#include "core/geometry/se3.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;
using Time = std::chrono::microseconds;
using Readings = std::vector<std::optional<Vector3d>>;

constexpr double kGravity = 9.81;

std::vector<ModuleId> someModules(std::size_t count) {
    std::vector<ModuleId> modules;
    for (std::size_t u = 0; u < count; ++u)
        modules.emplace_back(static_cast<std::uint32_t>(3 + 2 * u));
    return modules;
}

std::vector<Vector3d> randomGravity(Random& random, std::size_t count) {
    std::vector<Vector3d> gravity;
    for (std::size_t u = 0; u < count; ++u)
        gravity.emplace_back(kGravity * random.direction());
    return gravity;
}

Readings noisy(Random& random, const std::vector<Vector3d>& truth, double sigma) {
    Readings readings;
    for (const Vector3d& a : truth)
        readings.emplace_back(a + sigma * random.normal3());
    return readings;
}

TEST(Stillness, MovementIsTheNoiseOfABodyAtRest) {
    Random random(1, "movement");
    for (int run = 0; run < 100; ++run) {
        const std::size_t modules = 5 + random.index(20);
        const auto truth = randomGravity(random, modules);
        const double sigma = std::exp(random.uniform(std::log(1e-3), std::log(3.0)));
        StillnessMeter meter(someModules(modules));
        for (Time time = 5s; time <= 6s; time += 10ms)
            meter.add(time, noisy(random, truth, sigma));
        ASSERT_TRUE(meter.movement());
        // 5 modules, 51 readings, 3 axes: 1 / sqrt(2 * 750) is 2.6 %.
        EXPECT_NEAR(*meter.movement() / sigma, 1, 0.12);
        EXPECT_EQ(meter.isAtRest(), *meter.movement() < StillnessOptions{}.restsBelow);
    }
}

TEST(Stillness, ABodyThatIsTurnedDoesNotRest) {
    Random random(2, "turned");
    for (int run = 0; run < 100; ++run) {
        const auto truth = randomGravity(random, 10);
        StillnessMeter meter(someModules(10));
        Time time{};
        const auto turn = [&](double speed) {
            const Vector3d axis = random.direction();
            for (Time from = time; time < from + 1s; time += 10ms) {
                const Matrix3d R = so3Exp(axis * speed * std::chrono::duration<double>(time - from).count());
                std::vector<Vector3d> turned;
                for (const Vector3d& a : truth)
                    turned.emplace_back(R * a);
                meter.add(time, noisy(random, turned, 0.03));
            }
        };
        turn(1.0);
        EXPECT_FALSE(meter.isAtRest());
        turn(0.0);
        EXPECT_TRUE(meter.isAtRest());
    }
}

TEST(Stillness, SaysNothingBeforeHalfAWindowIsFull) {
    StillnessMeter meter(someModules(2));
    const Readings readings{Vector3d::UnitX(), Vector3d::UnitY()};
    EXPECT_FALSE(meter.movement());
    EXPECT_FALSE(meter.isAtRest());
    for (Time time{}; time < 250ms; time += 10ms) {
        meter.add(time, readings);
        EXPECT_FALSE(meter.movement());
        EXPECT_FALSE(meter.isAtRest());
    }
    meter.add(250ms, readings);
    EXPECT_TRUE(meter.isAtRest());
    meter.clear();
    EXPECT_FALSE(meter.movement());
}

TEST(Stillness, AGapIsNoRest) {
    StillnessMeter meter(someModules(1));
    const Readings readings{Vector3d::UnitX()};
    for (Time time{}; time <= 1s; time += 10ms)
        meter.add(time, readings);
    EXPECT_TRUE(meter.isAtRest());
    // What happened in the gap nobody knows, and what came before it is too old.
    for (Time time = 2s; time < 2250ms; time += 10ms) {
        meter.add(time, readings);
        EXPECT_FALSE(meter.isAtRest());
    }
    meter.add(2250ms, readings);
    EXPECT_TRUE(meter.isAtRest());
}

// Ten thousand modules on a serial line take seconds to say one word each.
TEST(Stillness, SamplesThatComeSlowlyAreWaitedFor) {
    for (const Time period : {600ms, 1700ms, 4400ms}) {
        StillnessMeter meter(someModules(1));
        Random random(7, "slow");
        Time time{};
        const auto next = [&] { return time += period + Time(random.index(100'000)); };
        // It moves.
        for (int i = 0; i < 6; ++i) {
            meter.add(next(), Readings{kGravity * random.direction()});
            EXPECT_FALSE(meter.isAtRest()) << period.count();
        }
        // It rests: what it read before must have left the window.
        const Time stopped = time;
        for (int i = 0; i < 3; ++i) {
            EXPECT_FALSE(meter.isAtRest()) << i;
            meter.add(next(), Readings{Vector3d::UnitX()});
        }
        EXPECT_TRUE(meter.isAtRest()) << period.count();
        EXPECT_GE(time - meter.window(), stopped);
        const auto means = meter.meansSince(time - meter.window(), 0);
        ASSERT_EQ(means.size(), 1U);
        EXPECT_EQ(means[0].acceleration, Vector3d(Vector3d::UnitX()));
    }
}

TEST(Stillness, ModulesThatDoNotAnswerDoNotCount) {
    Random random(3, "missing");
    for (int run = 0; run < 50; ++run) {
        const std::size_t modules = 6;
        const auto truth = randomGravity(random, modules);
        const std::size_t silent = random.index(modules);
        const std::size_t once = (silent + 1) % modules;
        StillnessMeter meter(someModules(modules));
        std::vector<int> counts(modules);
        for (int i = 0; i <= 100; ++i) {
            Readings readings = noisy(random, truth, 0.05);
            for (std::size_t u = 0; u < modules; ++u) {
                const bool isMissing = u == silent || (u == once && i != 90) || random.uniform() < 0.3;
                if (isMissing && !(u == once && i == 90))
                    readings[u].reset();
                counts[u] += readings[u] ? 1 : 0;
            }
            meter.add(i * 10ms, readings);
        }
        ASSERT_TRUE(meter.movement());
        EXPECT_NEAR(*meter.movement(), 0.05, 0.005);
        const auto means = meter.meansSince(0s, 7);
        ASSERT_EQ(means.size(), modules - 2);
        std::size_t next = 0;
        for (std::size_t u = 0; u < modules; ++u) {
            if (u == silent || u == once)
                continue;
            EXPECT_EQ(means[next].module, someModules(modules)[u]);
            EXPECT_EQ(means[next].samples, counts[u]);
            EXPECT_EQ(means[next].pose, 7);
            ++next;
        }
    }
}

TEST(Stillness, WithoutAnyAnswerNothingIsKnown) {
    StillnessMeter meter(someModules(3));
    for (Time time{}; time <= 1s; time += 10ms)
        meter.add(time, Readings(3));
    EXPECT_FALSE(meter.movement());
    EXPECT_FALSE(meter.isAtRest());
    EXPECT_TRUE(meter.meansSince(0s, 0).empty());
}

TEST(Stillness, MeansAreAsUncertainAsTheySay) {
    Random random(4, "means");
    double squares = 0;
    int count = 0;
    for (int run = 0; run < 200; ++run) {
        const std::size_t modules = 10;
        const auto truth = randomGravity(random, modules);
        const double sigma = random.uniform(0.01, 0.2);
        StillnessMeter meter(someModules(modules));
        for (Time time{}; time < 1s; time += 10ms)
            meter.add(time, noisy(random, truth, sigma));
        const auto means = meter.meansSince(200ms, 0);
        ASSERT_EQ(means.size(), modules);
        for (std::size_t u = 0; u < modules; ++u) {
            ASSERT_TRUE(means[u].sigma);
            EXPECT_EQ(means[u].samples, 80);
            EXPECT_NEAR(*means[u].sigma, sigma / std::sqrt(80), 0.3 * sigma / std::sqrt(80));
            squares += (means[u].acceleration - truth[u]).squaredNorm() / std::pow(*means[u].sigma, 2);
            count += 3;
        }
    }
    // 6000 axes: 3 sigma of their mean square is 5.5 %.
    EXPECT_NEAR(squares / count, 1, 0.055);
}

TEST(Stillness, FewSamplesDoNotLookBetterThanMany) {
    Random random(9, "few");
    for (const int samples : {2, 3, 5}) {
        const std::size_t modules = 5000;
        StillnessMeter meter(someModules(modules));
        for (int i = 0; i < samples; ++i)
            meter.add(i * 200ms, noisy(random, std::vector<Vector3d>(modules, Vector3d::UnitX()), 0.1));
        double variance = 0;
        for (const GravityReading& mean : meter.meansSince(0s, 0))
            variance += samples * std::pow(mean.sigma.value_or(0), 2) / static_cast<double>(modules);
        // 15000 degrees of freedom at least: 3 sigma are 3.5 %.
        EXPECT_NEAR(variance / 0.01, 1, 0.035);
    }
}

TEST(Stillness, MeansAreOfWhatCameSince) {
    StillnessMeter meter(someModules(1));
    for (int i = 0; i < 100; ++i)
        meter.add(i * 10ms, Readings{Vector3d(i, 0, 0)});
    const auto means = meter.meansSince(900ms, 0);
    ASSERT_EQ(means.size(), 1U);
    EXPECT_EQ(means[0].samples, 10);
    EXPECT_DOUBLE_EQ(means[0].acceleration.x(), 94.5);
    EXPECT_TRUE(meter.meansSince(990ms, 0).empty()) << "one is no mean";
    EXPECT_TRUE(meter.meansSince(1s, 0).empty());
}

TEST(Stillness, WhatAlwaysReadsTheSameIsNotExact) {
    Random random(5, "steps");
    for (int run = 0; run < 100; ++run) {
        const Vector3d constant = kGravity * random.direction();
        StillnessMeter meter(someModules(1));
        for (Time time{}; time <= 1s; time += 3ms)
            meter.add(time, Readings{constant});
        EXPECT_TRUE(meter.isAtRest());
        const auto means = meter.meansSince(0s, 0);
        ASSERT_EQ(means.size(), 1U);
        EXPECT_FALSE(means[0].sigma);
        EXPECT_LT((means[0].acceleration - constant).norm(), 1e-9);
    }
}

TEST(Stillness, BeginsAnewWithTheClock) {
    for (const Time restart : {Time(0), Time(10s)}) {
        StillnessMeter meter(someModules(1));
        for (Time time = 9s; time <= 10s; time += 10ms)
            meter.add(time, Readings{Vector3d(100, 0, 0)});
        meter.add(restart, Readings{Vector3d::UnitX()});
        EXPECT_FALSE(meter.movement());
        meter.add(restart + 300ms, Readings{Vector3d::UnitX()});
        EXPECT_TRUE(meter.isAtRest());
        const auto means = meter.meansSince(Time{}, 0);
        ASSERT_EQ(means.size(), 1U);
        EXPECT_EQ(means[0].samples, 2);
        EXPECT_EQ(means[0].acceleration, Vector3d(Vector3d::UnitX()));
    }
}

TEST(Stillness, RemembersAsMuchAsItPromises) {
    Random random(6, "memory");
    StillnessMeter meter(someModules(1));
    std::vector<Time> times;
    Time now{};
    for (int i = 0; i < 5000; ++i) {
        now += Time(1 + random.index(random.uniform() < 0.001 ? 10'000'000 : 20'000));
        times.push_back(now);
        meter.add(now, Readings{Vector3d::UnitX()});
        if (i % 50 != 0)
            continue;
        const auto young =
            std::count_if(times.begin(), times.end(), [&](Time time) { return time >= now - StillnessMeter::kKept; });
        const auto kept = std::max<std::ptrdiff_t>(young, std::min<std::ptrdiff_t>(3, std::ssize(times)));
        const auto means = meter.meansSince(Time{}, 0);
        EXPECT_EQ(means.empty() ? 1 : *means[0].samples, kept);
    }
}

TEST(Stillness, RejectsWhatItCannotUse) {
    const auto make = [](const StillnessOptions& options) { StillnessMeter meter(someModules(1), options); };
    EXPECT_NO_THROW(make({}));
    EXPECT_THROW(make({0ms, 0.15}), std::logic_error);
    EXPECT_THROW(make({-1ms, 0.15}), std::logic_error);
    EXPECT_THROW(make({500ms, 0}), std::logic_error);
    EXPECT_THROW(make({500ms, -1}), std::logic_error);
    EXPECT_THROW(make({500ms, std::nan("")}), std::logic_error);
    StillnessMeter meter(someModules(2));
    EXPECT_THROW(meter.add(0s, Readings(1)), std::logic_error);
    EXPECT_THROW(meter.add(0s, Readings(3)), std::logic_error);
}

/// What modules that are turned by R read where they read `truth` before.
std::vector<GravityReading> turnedBy(const Matrix3d& R, const std::vector<Vector3d>& truth, int pose) {
    std::vector<GravityReading> readings;
    const auto modules = someModules(truth.size());
    for (std::size_t u = 0; u < truth.size(); ++u)
        readings.push_back({pose, modules[u], R * truth[u]});
    return readings;
}

/// Gravity in each module of a rigid body, seen in the body's frame: one direction, turned into each module's.
std::vector<Vector3d> inModules(const std::vector<Matrix3d>& R_u_r, const Vector3d& g_r) {
    std::vector<Vector3d> gravity;
    for (const Matrix3d& R : R_u_r)
        gravity.emplace_back(R * g_r);
    return gravity;
}

TEST(AngleToNearestPose, IsTheTurnAcrossGravity) {
    Random random(7, "angles");
    for (int run = 0; run < 500; ++run) {
        std::vector<Matrix3d> R_u_r;
        for (std::size_t u = 1 + random.index(10); u > 0; --u)
            R_u_r.push_back(random.rotation());
        const Vector3d g_r = kGravity * random.direction();
        const Vector3d axis = g_r.cross(random.direction()).normalized();
        // Poses by their angle to now, and one more turn about gravity that can't be seen.
        double nearest = std::numbers::pi;
        std::vector<GravityReading> captured;
        for (int pose = 0; pose < 5; ++pose) {
            const double angle = random.uniform(0.001, std::numbers::pi - 0.001);
            nearest = std::min(nearest, angle);
            const Vector3d turned = so3Exp(axis * angle) * so3Exp(g_r * random.uniform()) * g_r;
            for (const GravityReading& reading : turnedBy(Matrix3d::Identity(), inModules(R_u_r, turned), pose))
                captured.push_back(reading);
        }
        const auto now = turnedBy(Matrix3d::Identity(), inModules(R_u_r, g_r), 99);
        EXPECT_NEAR(angleToNearestPose(captured, now), nearest, 1e-9);
        // How strong a sensor reads does not matter.
        auto scaled = captured;
        for (GravityReading& reading : scaled)
            reading.acceleration *= random.uniform(0.5, 2);
        EXPECT_NEAR(angleToNearestPose(scaled, now), nearest, 1e-9);
        EXPECT_NEAR(angleToNearestPose(now, now), 0, 1e-7);
    }
}

TEST(AngleToNearestPose, OneBrokenModuleDoesNotMatter) {
    Random random(8, "broken");
    for (int run = 0; run < 500; ++run) {
        const std::size_t modules = 3 + random.index(10);
        const auto truth = randomGravity(random, modules);
        const double angle = random.uniform(0.01, 3);
        std::vector<Vector3d> turned;
        for (const Vector3d& a : truth)
            turned.emplace_back(so3Exp(a.cross(random.direction()).normalized() * angle) * a);
        const auto captured = turnedBy(Matrix3d::Identity(), truth, 0);
        auto now = turnedBy(Matrix3d::Identity(), turned, 1);
        now[random.index(modules)].acceleration = kGravity * random.direction();
        EXPECT_NEAR(angleToNearestPose(captured, now), angle, 1e-7);
    }
}

TEST(AngleToNearestPose, LooksAtModulesThatHaveBoth) {
    const Vector3d z = Vector3d::UnitZ();
    const std::vector<GravityReading> now{{9, ModuleId(1), z}, {9, ModuleId(2), z}};
    EXPECT_DOUBLE_EQ(angleToNearestPose({}, now), std::numbers::pi);
    const std::vector<GravityReading> captured{{0, ModuleId(2), z}, {0, ModuleId(3), -z}};
    EXPECT_DOUBLE_EQ(angleToNearestPose(captured, {}), std::numbers::pi);
    EXPECT_NEAR(angleToNearestPose(captured, now), 0, 1e-7);
    const std::vector<GravityReading> others{{0, ModuleId(3), z}};
    EXPECT_DOUBLE_EQ(angleToNearestPose(others, now), std::numbers::pi);
    // A sensor that reads nothing has no direction.
    const std::vector<GravityReading> dead{{0, ModuleId(1), Vector3d::Zero()}};
    EXPECT_DOUBLE_EQ(angleToNearestPose(dead, now), std::numbers::pi);
    EXPECT_DOUBLE_EQ(angleToNearestPose(now, dead), std::numbers::pi);
}

}  // namespace
}  // namespace skincal
