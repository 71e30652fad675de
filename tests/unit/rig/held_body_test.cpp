#include "core/rig/held_body.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"
#include "core/rig/held_camera.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;
using Time = HeldBody::Time;

constexpr Time kStart = 5h;

TEST(HeldBody, FeelsGravityAloneWhereverItIsAtRest) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        Random random(seed, "rest");
        HeldBody body(Vector3d::UnitZ(), random.normal3(), kStart, seed);
        EXPECT_LE(body.restsAt(), kStart);
        EXPECT_EQ(body.forces(kStart).at(random.normal3()), kStandardGravity * Vector3d::UnitZ());
        const Vector3d up = random.direction();
        body.turn(up, kStart + 3s);
        for (const Time later : {0ms, 1ms, 40ms, 100000ms}) {
            EXPECT_LT((body.up(body.restsAt() + later) - up).norm(), 1e-12);
            EXPECT_LT((body.forces(body.restsAt() + later).at(random.normal3()) - kStandardGravity * up).norm(), 1e-10);
        }
    }
}

TEST(HeldBody, TurnsTheShortestWayInOneSecond) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        Random random(seed, "way");
        const Vector3d from = random.direction();
        const Vector3d to = seed == 1 ? Vector3d(-from) : seed == 2 ? from : random.direction();
        HeldBody body(from, Vector3d::Zero(), kStart, seed);
        body.turn(to, kStart);
        double way = 0;
        Vector3d last = from;
        for (Time t = kStart; t <= kStart + HeldBody::kTurn; t += 1ms) {
            const Vector3d up = body.up(t);
            EXPECT_NEAR(up.norm(), 1, 1e-12);
            way += (up - last).norm();
            last = up;
        }
        EXPECT_LT((last - to).norm(), 1e-12);
        EXPECT_NEAR(way, std::acos(std::clamp(from.dot(to), -1.0, 1.0)), 1e-4);
    }
}

TEST(HeldBody, SpinAndTwistAreTheDerivativesOfItsAttitude) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        Random random(seed, "derivatives");
        HeldBody body(random.direction(), random.normal3(), kStart, seed);
        body.turn(random.direction(), kStart);
        for (int i = 0; i < 20; ++i) {
            const Time t = kStart + Time(random.index(1'000'000));
            constexpr Time kStep = 100us;
            constexpr double kSteps = 2e-4;  // s, both together
            const Vector3d rate = (body.up(t + kStep) - body.up(t - kStep)) / kSteps;
            EXPECT_LT((rate + body.forces(t).spin_r.cross(body.up(t))).norm(), 1e-4);
            const Vector3d twist = (body.forces(t + kStep).spin_r - body.forces(t - kStep).spin_r) / kSteps;
            EXPECT_LT((twist - body.forces(t).twist_r).norm(), 0.05);
        }
    }
}

TEST(HeldBody, AccelerationsAreThoseOfARigidBody) {
    Random random(1, "rigid");
    BodyForces forces{random.normal3(), random.normal3(), random.normal3(), random.normal3()};
    EXPECT_EQ(forces.at(forces.pivot_r), forces.force_r);
    // Outward on a steady merry-go-round one is pressed inwards.
    forces = {Vector3d::Zero(), {0, 0, 2}, Vector3d::Zero(), Vector3d::Zero()};
    EXPECT_LT((forces.at({0.5, 0, 7}) - Vector3d(-2, 0, 0)).norm(), 1e-12);
    forces = {Vector3d::Zero(), Vector3d::Zero(), {0, 0, 3}, Vector3d::Zero()};
    EXPECT_LT((forces.at({0.5, 0, 7}) - Vector3d(0, 1.5, 0)).norm(), 1e-12);
}

TEST(HeldBody, HandsTrembleWhileTheyTurnAndThatDiesOut) {
    double turning = 0;
    double settling = 0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        HeldBody body(Vector3d::UnitX(), Vector3d::Zero(), kStart, seed);
        body.turn(Vector3d::UnitY(), kStart);
        const auto tremble = [&](Time t) {
            return (body.forces(t).force_r - kStandardGravity * body.up(t)).squaredNorm() / 3;
        };
        for (Time t = 0ms; t < 200ms; t += 5ms) {
            turning += tremble(kStart + 500ms + t);
            settling += tremble(kStart + HeldBody::kTurn + HeldBody::kSettle - 200ms + t);
            ++count;
        }
    }
    EXPECT_GT(std::sqrt(turning / count), 0.3);
    EXPECT_LT(std::sqrt(turning / count), 0.8);
    EXPECT_LT(std::sqrt(settling / count), 0.02);
}

TEST(HeldBody, TurnedAgainItGoesOnFromWhereItIs) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed, "again");
        HeldBody body(random.direction(), Vector3d::Zero(), kStart, seed);
        body.turn(random.direction(), kStart);
        const Time then = kStart + Time(random.index(2'000'000));
        const Vector3d before = body.up(then);
        const Vector3d to = random.direction();
        body.turn(to, then);
        EXPECT_LT((body.up(then) - before).norm(), 1e-12);
        EXPECT_EQ(body.restsAt(), then + HeldBody::kTurn + HeldBody::kSettle);
        EXPECT_LT((body.up(body.restsAt()) - to).norm(), 1e-12);
    }
}

TEST(HeldCamera, GoesSmoothlyToExactlyWhereItIsMoved) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed, "camera");
        const Isometry3d from = makeIsometry(random.rotation(), random.normal3());
        const Isometry3d to = makeIsometry(random.rotation(), random.normal3());
        HeldCamera camera(from);
        EXPECT_EQ(camera.pose(kStart).matrix(), from.matrix());
        camera.move(to, kStart);
        Isometry3d last = from;
        for (Time t = kStart; t <= kStart + HeldCamera::kMove; t += 10ms) {
            const Isometry3d pose = camera.pose(t);
            EXPECT_TRUE(isRigid(pose));
            EXPECT_LT(poseDifference(pose, last).angle, 0.07);
            EXPECT_LT(poseDifference(pose, last).distance, 0.1);
            last = pose;
        }
        EXPECT_EQ(camera.pose(camera.restsAt()).matrix(), to.matrix());
    }
}

TEST(HeldCamera, MovedOrKnockedOnItsWayItGoesOnFromThere) {
    Random random(7, "camera");
    HeldCamera camera(Isometry3d::Identity());
    camera.move(makeIsometry(random.rotation(), random.normal3()), kStart);
    const Time then = kStart + 400ms;
    const Isometry3d before = camera.pose(then);
    camera.move(Isometry3d::Identity(), then);
    EXPECT_LT(poseDifference(camera.pose(then), before).angle, 1e-9);
    EXPECT_LT(poseDifference(camera.pose(then), before).distance, 1e-12);
    camera.jump(before, then + 10ms);
    EXPECT_EQ(camera.pose(then + 10ms).matrix(), before.matrix());
    EXPECT_EQ(camera.restsAt(), then + 10ms);
}

}  // namespace
}  // namespace skincal
