#include "core/camera/camera_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/geometry/random.h"

namespace skincal {
namespace {

using Time = std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr Time kPeriod{33'333};

/// A camera whose clock began at another time and goes at another pace, whose pictures are late by chance.
struct Taken {
    Time exposed{};  ///< on the computer's clock
    Time camera{};
    Time arrival{};
};

std::vector<Taken> takePictures(Random& random, std::size_t pictures) {
    const double pace = 1 + random.uniform(-200e-6, 200e-6);
    const Time began{static_cast<long>(random.uniform(0, 1e10))};
    std::vector<Taken> taken;
    Time arrival{};
    for (std::size_t k = 0; k < pictures; ++k) {
        const Time since = kPeriod * static_cast<int>(k);
        const Time delay{static_cast<long>(random.uniform(3e3, random.uniform() < 0.1 ? 200e3 : 20e3))};
        arrival = std::max(arrival + Time(1), Time(1'000'000) + since + delay);
        taken.push_back(
            {Time(1'000'000) + since, began + Time(std::lround(pace * static_cast<double>(since.count()))), arrival});
    }
    return taken;
}

TEST(CameraClock, FollowsTheCamerasClockAndIsNeverMuchLate) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        Random random(seed, "camera clock");
        CameraClock clock(kPeriod, Time(0), 1);
        const auto taken = takePictures(random, 20'000);  // 11 minutes
        std::uint64_t k = 0;
        for (const Taken& picture : taken) {
            const auto stamp = clock.stamp(picture.camera, picture.arrival);
            EXPECT_EQ(stamp.sequence, ++k);
            EXPECT_LE(stamp.time, picture.arrival);
            if (k < 300)
                continue;
            // The shortest delay is 3 ms; what chance leaves of it and the drift that is followed stay below.
            EXPECT_GE(stamp.time - picture.exposed, milliseconds(2)) << seed;
            EXPECT_LE(stamp.time - picture.exposed, milliseconds(8)) << seed;
        }
    }
}

TEST(CameraClock, CountsPicturesThatWereLeftOut) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        Random random(seed, "left out");
        CameraClock clock(kPeriod, Time(0), 7);
        const auto taken = takePictures(random, 1000);
        for (std::size_t k = 0; k < taken.size(); k += 1 + random.index(10)) {
            EXPECT_EQ(clock.stamp(taken[k].camera, taken[k].arrival).sequence, 7 + k);
        }
    }
}

TEST(CameraClock, TakesTheLeadOff) {
    CameraClock clock(kPeriod, milliseconds(20), 1);
    EXPECT_EQ(clock.stamp(Time(5), milliseconds(100)).time, milliseconds(80));
    EXPECT_EQ(clock.stamp(std::nullopt, milliseconds(200)).time, milliseconds(180));
}

TEST(CameraClock, GivesADelayedPictureItsOwnTime) {
    CameraClock clock(kPeriod, Time(0), 1);
    static_cast<void>(clock.stamp(milliseconds(0), milliseconds(1000)));
    const auto late = clock.stamp(milliseconds(33), milliseconds(1900));
    EXPECT_LT(late.time, milliseconds(1034));
    EXPECT_GE(late.time, milliseconds(1033));
}

TEST(CameraClock, BeginsAnewWhereTheCamerasClockWasSetBack) {
    CameraClock clock(kPeriod, Time(0), 1);
    static_cast<void>(clock.stamp(std::chrono::seconds(100), std::chrono::seconds(5)));
    const auto stamp = clock.stamp(Time(0), std::chrono::seconds(6));
    EXPECT_EQ(stamp.time, std::chrono::seconds(6));
    EXPECT_EQ(stamp.sequence, 2U);
}

TEST(CameraClock, GivesTheSameTimeToTheSameTime) {
    CameraClock clock(kPeriod, Time(0), 1);
    const auto first = clock.stamp(milliseconds(7), milliseconds(1000));
    EXPECT_EQ(clock.stamp(milliseconds(7), milliseconds(1033)).time, first.time);
}

TEST(CameraClock, NumbersPicturesWithoutTimeOrPeriodOneByOne) {
    CameraClock clock(Time(0), Time(0), 1);
    EXPECT_EQ(clock.stamp(milliseconds(0), milliseconds(0)).sequence, 1U);
    EXPECT_EQ(clock.stamp(milliseconds(500), milliseconds(500)).sequence, 2U);
    EXPECT_EQ(clock.stamp(std::nullopt, milliseconds(900)).sequence, 3U);
}

}  // namespace
}  // namespace skincal
