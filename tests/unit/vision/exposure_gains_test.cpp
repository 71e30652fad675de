#include "core/vision/exposure_gains.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"

namespace skincal {
namespace {

/// What the room and the camera do in a plane.
struct Plane {
    double room = 1;      ///< light of the room over its usual
    double exposure = 1;  ///< over the usual one
};

constexpr std::size_t kGrounds = 300;
constexpr double kSigma = 0.8;

/// LEDs that blink at random on bright patches of ground, and other such patches.
struct Room {
    SpotSeries series;
    std::vector<double> sigma;
    std::vector<std::size_t> litCount;

    Room(const std::vector<Plane>& planes, std::size_t leds, double led, double ground, std::uint64_t seed)
        : series(planes.size(), leds + kGrounds), sigma(leds + kGrounds, kSigma), litCount(planes.size(), 0) {
        Random random(seed, "exposure gains");
        for (std::size_t spot = 0; spot < sigma.size(); ++spot) {
            const double bright = random.uniform(0.2, 0.8);
            const double amplitude = spot < leds ? led * random.uniform(0.6, 1) : 0.0;
            for (std::size_t k = 0; k < planes.size(); ++k) {
                const bool isLit = spot < leds && (k == 1 || random.uniform() < 0.5);
                litCount[k] += isLit ? 1 : 0;
                const double around = ground * planes[k].room;
                const double level =
                    planes[k].exposure * (around * (1 + bright) + (isLit ? amplitude : 0)) + kSigma * random.normal();
                const auto row = static_cast<Eigen::Index>(k);
                const auto col = static_cast<Eigen::Index>(spot);
                const double seen = std::clamp(planes[k].exposure * around, 0.0, 255.0);
                series.around(row, col) = static_cast<float>(seen);
                series.light(row, col) = static_cast<float>(std::clamp(level, 0.0, 255.0) - seen);
                series.isFull(row, col) = level >= 254 ? 1 : 0;
            }
        }
    }
    [[nodiscard]] std::vector<double> gains() const { return exposureGains(series, sigma, litCount); }
};

TEST(ExposureGains, TellAStepOfTheExposure) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        Random random(seed, "step");
        const double darker = random.uniform(0.3, 0.9);
        std::vector<Plane> planes(24);
        const std::size_t from = random.index(12);
        const std::size_t count = 1 + random.index(10);
        for (std::size_t k = from; k < from + count; ++k)
            planes[k].exposure = darker;
        for (const double led : {60.0, 150.0}) {
            constexpr std::size_t leds = 40;
            const std::vector<double> gains = Room(planes, leds, led, 50, seed).gains();
            for (std::size_t k = 0; k < planes.size(); ++k)
                EXPECT_NEAR(gains[k], planes[k].exposure, 0.05) << k << ", seed " << seed;
        }
    }
}

TEST(ExposureGains, SunIsNoExposure) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        std::vector<Plane> planes(24);
        for (std::size_t k = 0; k < planes.size(); ++k)
            planes[k].room = 1 + 2.0 * static_cast<double>(k) / 24 - (k > 9 && k < 15 ? 0.8 : 0.0);
        // In their range, clipped by the sun, clipped all the time.
        for (const double led : {60.0, 150.0, 400.0})
            for (const std::size_t leds : {0, 5, 7, 40}) {
                const std::vector<double> gains = Room(planes, leds, led, 50, seed).gains();
                for (std::size_t k = 0; k < planes.size(); ++k)
                    EXPECT_EQ(gains[k], 1) << k << ", " << leds << " LEDs of " << led << ", seed " << seed;
            }
    }
}

TEST(ExposureGains, ALampThatGoesBlackIsNoExposure) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        std::vector<Plane> planes(24);
        for (std::size_t k = 0; k < planes.size(); k += 3)
            planes[k].room = -1;
        for (const std::size_t leds : {0, 5, 7, 40}) {
            const std::vector<double> gains = Room(planes, leds, 150, 60, seed).gains();
            for (std::size_t k = 0; k < planes.size(); ++k)
                EXPECT_EQ(gains[k], 1) << k << ", " << leds << " LEDs, seed " << seed;
        }
    }
}

TEST(ExposureGains, AKnockThatLeavesSpotsHalfTheirLightIsNoExposure) {
    constexpr std::size_t leds = 14;
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        const std::vector<Plane> planes(18);
        Room room(planes, leds, 150, 50, seed);
        for (std::size_t k = 12; k < planes.size(); ++k)
            room.series.light.row(static_cast<Eigen::Index>(k)).head(leds) *= 0.5F;
        EXPECT_EQ(room.gains(), std::vector<double>(planes.size(), 1)) << seed;
    }
}

TEST(ExposureGains, WithoutLedsNothingIsTold) {
    const std::vector<Plane> planes(24);
    EXPECT_EQ(Room(planes, 40, 0, 50, 1).gains(), std::vector<double>(24, 1));
    EXPECT_EQ(exposureGains(SpotSeries(5, 0), {}, std::vector<std::size_t>(5, 9)), std::vector<double>(5, 1));
}

}  // namespace
}  // namespace skincal
