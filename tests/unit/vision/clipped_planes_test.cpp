#include "core/vision/clipped_planes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "core/geometry/random.h"
#include "core/vision/surroundings.h"
#include "core/vision/word_match.h"
#include "tests/unit/vision/coded_book.h"

namespace skincal {
namespace {

using Planes = std::vector<std::uint8_t>;

/// What the light of a room does from plane to plane, grey levels.
using Room = std::function<double(double plane, double planes)>;

double lamp(double plane, double /*planes*/) {
    return 30 + 100 * std::sin(2 * std::numbers::pi * plane / 3 + 0.7);
}
double risingSun(double plane, double planes) {
    const double cloud = plane > 0.4 * planes && plane < 0.6 * planes ? 0.3 : 0.0;
    return 50 * (1 + 1.5 * plane / planes - cloud);
}

/// A spot on ground that is brighter than what is around it, as 8 bits show it.
struct Seen {
    std::vector<double> light;
    Eigen::VectorXf around;
    Eigen::Array<std::uint8_t, Eigen::Dynamic, 1> isFull;
};

Seen seenOf(const Codebook& codebook, const Room& room, std::optional<std::size_t> module, double led,
            std::uint64_t seed) {
    Random random(seed, "clipped planes");
    constexpr double kNoise = 0.8;
    const double brighter = random.uniform(0.1, 0.8);
    const auto planes = static_cast<Eigen::Index>(codebook.planes());
    Seen seen{{}, Eigen::VectorXf(planes), Eigen::Array<std::uint8_t, Eigen::Dynamic, 1>::Zero(planes)};
    for (Eigen::Index k = 0; k < planes; ++k) {
        const double ground = room(static_cast<double>(k), static_cast<double>(planes));
        double level = ground * (1 + brighter);
        if (module && std::count(codebook.lit[*module].begin(), codebook.lit[*module].end(), k) > 0)
            level += led;
        const double around = std::clamp(ground + (ground > 0 ? kNoise / 4 * random.normal() : 0.0), 0.0, 255.0);
        seen.around[k] = static_cast<float>(around);
        seen.isFull[k] = level >= 254 ? 1 : 0;
        const double noise = level > 0 && level < 255 ? kNoise * random.normal() : 0.0;
        seen.light.push_back(std::clamp(level, 0.0, 255.0) - around + noise);
    }
    return seen;
}

SeriesMatch matchOf(const Codebook& codebook, const Seen& seen) {
    const std::vector<double> gains(codebook.planes(), 1);
    return WordMatcher(codebook).match(seen.light, 0.8, ambientOf(codebook, seen.around, gains, 0.8),
                                       atLeastPlanes(seen.isFull, seen.around));
}

class ClippedBy : public ::testing::TestWithParam<Room> {};

TEST_P(ClippedBy, LedsAreNamedAndGroundIsNot) {
    constexpr std::uint64_t kDraws = 400;
    // With 200 a lamp that beats every third picture goes black whenever some bits and their complements are shown.
    for (const auto& [modules, share] : {std::pair(28U, 94), std::pair(55U, 94), std::pair(200U, 80)}) {
        int named = 0;
        for (std::uint64_t seed = 0; seed < kDraws; ++seed) {
            const Codebook codebook = testing::codedBook(modules, seed);
            Random random(seed, "who");
            const std::size_t module = random.index(modules);
            const SeriesMatch led =
                matchOf(codebook, seenOf(codebook, GetParam(), module, random.uniform(60, 300), seed));
            if (led.verdict == SeriesVerdict::Matched) {
                ASSERT_EQ(led.words, std::vector{module}) << seed;
                ++named;
            }
            const SeriesMatch ground = matchOf(codebook, seenOf(codebook, GetParam(), std::nullopt, 0, seed));
            EXPECT_NE(ground.verdict, SeriesVerdict::Matched) << seed;
        }
        EXPECT_GE(named, static_cast<int>(kDraws) * share / 100) << modules;
    }
}

INSTANTIATE_TEST_SUITE_P(Light, ClippedBy, ::testing::Values(&lamp, &risingSun),
                         [](const auto& room) { return std::string(room.index == 0 ? "ALamp" : "TheSun"); });

TEST(ClippedPlanes, ADarkRoomIsNoDarkerThanItLooks) {
    const Eigen::VectorXf around{{0, 0, 3, 0, 0, 0, 40, 0}};
    EXPECT_EQ(blackPlanes(around), Planes(8, 0));
}

TEST(ClippedPlanes, BlackIsTheGroundThatIsBrighterElsewhere) {
    const Eigen::VectorXf around{{80, 60, 0, 80, 60, 0.5F, 80}};
    EXPECT_EQ(blackPlanes(around), (Planes{0, 0, 1, 0, 0, 1, 0}));
    EXPECT_EQ(blackPlanes(Eigen::VectorXf()), Planes());
}

TEST(ClippedPlanes, GroundThatIsAlwaysFullBoundsNothing) {
    Eigen::Array<std::uint8_t, Eigen::Dynamic, 1> isFull = Eigen::Array<std::uint8_t, Eigen::Dynamic, 1>::Ones(20);
    const Eigen::VectorXf around = Eigen::VectorXf::Constant(20, 200);
    EXPECT_EQ(atLeastPlanes(isFull, around), Planes(20, 0));
    isFull.head(10) = 0;
    Planes second(20, 0);
    std::fill(second.begin() + 10, second.end(), std::uint8_t{1});
    EXPECT_EQ(atLeastPlanes(isFull, around), second);
}

}  // namespace
}  // namespace skincal
