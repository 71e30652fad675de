#include "core/vision/mirror_side.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"

namespace skincal {
namespace {

constexpr double kEdge_px = 300;  // LEDs are above, reflections below it

/// As a mirror shows them that is level with the picture's rows.
std::vector<MirroredPair> reflected(std::size_t count, double strength, std::uint64_t seed = 1) {
    Random random(seed, "pairs");
    std::vector<MirroredPair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        const Vector2d led(random.uniform(50, 590), random.uniform(60, 260));
        pairs.push_back({led, {led.x(), 2 * kEdge_px - led.y()}, strength});
    }
    return pairs;
}

TEST(MirrorSide, IsWhereTheFainterSpotsAre) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const MirrorSide mirror(reflected(seed % 2 == 0 ? 3 : 200, 0.4, seed));
        EXPECT_TRUE(mirror.mayReflect({320, 400})) << seed;
        EXPECT_FALSE(mirror.mayReflect({320, 200})) << seed;
    }
}

TEST(MirrorSide, AFewBrighterReflectionsDoNotTurnIt) {
    auto pairs = reflected(20, 0.4);
    for (std::size_t i = 0; i < 4; ++i)
        std::swap(pairs[i].led, pairs[i].reflection);
    const MirrorSide mirror(pairs);
    EXPECT_TRUE(mirror.mayReflect({320, 400}));
    EXPECT_FALSE(mirror.mayReflect({320, 200}));
}

TEST(MirrorSide, IsAnywhereWhereReflectionsAreAsBrightAsLeds) {
    auto pairs = reflected(20, 0.4);
    for (std::size_t i = 0; i < 10; ++i)
        std::swap(pairs[i].led, pairs[i].reflection);
    for (const MirrorSide& mirror : {MirrorSide(pairs), MirrorSide(reflected(20, 0.9))}) {
        EXPECT_TRUE(mirror.mayReflect({320, 400}));
        EXPECT_TRUE(mirror.mayReflect({320, 200}));
    }
}

TEST(MirrorSide, TwoPairsOrGlintsHereAndThereAreNone) {
    EXPECT_FALSE(MirrorSide(reflected(2, 0.4)).mayReflect({320, 400}));
    EXPECT_FALSE(MirrorSide({}).mayReflect({320, 400}));
    Random random(3, "glints");
    std::vector<MirroredPair> glints;
    for (int i = 0; i < 30; ++i)
        glints.push_back({{random.uniform(50, 590), random.uniform(50, 430)},
                          {random.uniform(50, 590), random.uniform(50, 430)},
                          0.3});
    EXPECT_FALSE(MirrorSide(glints).mayReflect({320, 400}));
    EXPECT_FALSE(MirrorSide(glints).mayReflect({320, 200}));
}

}  // namespace
}  // namespace skincal
