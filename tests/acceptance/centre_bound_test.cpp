#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/study/scan_study.h"

namespace skincal::testing {
namespace {

struct Lens {
    const char* name;
    double blur_px;
    double ledPeak;  ///< grey levels at 0.6 m
    double distance;
    double background;
    ScanMethod method = ScanMethod::Coded;
};

ScanScore scoreOf(const Lens& lens) {
    const ScanCase what{Disturbance::None, 0, 55, lens.distance, lens.method};
    ScanScore sum;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        World world = scanWorld(what, seed);
        world.scenario.pictures.blur_px = lens.blur_px;
        world.scenario.pictures.ledPeak = lens.ledPeak;
        world.scenario.pictures.background = lens.background;
        sum.add(scoreScan(std::move(world), what));
    }
    fmt::print("{}: {} visible, {} found, {} of them not clipped; rms {:.4f} px, {:.2f} of the bound, {:.2f} sigma\n",
               lens.name, sum.visible, sum.found, sum.sharp, sum.rms_px(), sum.rmsBounds(),
               sum.sharp > 0 ? std::sqrt(sum.sharpSigmas / (2 * static_cast<double>(sum.sharp))) : sum.rmsSigmas());
    return sum;
}

/// Four standard deviations of a mean square of so many normal numbers, relative.
double allowance(double numbers) {
    return 4 * std::sqrt(2 / numbers);
}

class SharpSpots : public ::testing::TestWithParam<Lens> {};

TEST_P(SharpSpots, CentresAreNearTheirBoundAndSigmaIsTheErrorThatHappens) {
    const ScanScore score = scoreOf(GetParam());
    ASSERT_GT(score.sharp, 200U);
    EXPECT_EQ(score.wrong, 0U);
    const double numbers = 2 * static_cast<double>(score.sharp);
    constexpr double kBounds = 1.2;
    EXPECT_LT(score.squaredBounds / numbers, kBounds * kBounds);
    EXPECT_GT(score.squaredBounds / numbers, 1 - allowance(numbers)) << "a bound that is none";
    EXPECT_LT(score.sharpSigmas / numbers, 1.25);
    EXPECT_GT(score.sharpSigmas / numbers, 0.8);
}

INSTANTIATE_TEST_SUITE_P(Lenses, SharpSpots,
                         ::testing::Values(Lens{"Faint", 0.9, 60, 0.8, 70}, Lens{"Medium", 0.9, 120, 0.8, 70},
                                           Lens{"Bright", 0.9, 180, 0.6, 40}, Lens{"Narrow", 0.6, 150, 0.8, 70},
                                           Lens{"Soft", 1.4, 150, 0.8, 70}, Lens{"Wide", 2, 150, 0.8, 70},
                                           Lens{"Far", 0.9, 450, 2, 70}, Lens{"InDaylight", 0.9, 120, 0.8, 100},
                                           Lens{"InTheDark", 0.9, 450, 0.8, 0}, Lens{"FaintInTheDark", 0.9, 80, 0.8, 0},
                                           Lens{"NarrowInTheDark", 0.6, 300, 0.8, 0},
                                           Lens{"WideInTheDark", 2, 200, 0.8, 0}, Lens{"AtDusk", 0.9, 400, 0.8, 4},
                                           Lens{"AtDawn", 0.9, 300, 0.8, 10}, Lens{"ByLamplight", 0.9, 250, 0.8, 30},
                                           Lens{"OneAtATimeInTheDark", 0.9, 300, 0.8, 0, ScanMethod::OneAtATime},
                                           Lens{"OneAtATime", 0.9, 150, 0.8, 70, ScanMethod::OneAtATime}),
                         [](const auto& lens) { return std::string(lens.param.name); });

class ClippedSpots : public ::testing::TestWithParam<Lens> {};

TEST_P(ClippedSpots, SigmaIsNotBelowTheErrorThatHappens) {
    const ScanScore score = scoreOf(GetParam());
    ASSERT_GT(score.found, 200U);
    EXPECT_EQ(score.wrong, 0U);
    EXPECT_LT(score.sharp, score.found / 4);
    const double numbers = 2 * static_cast<double>(score.found);
    EXPECT_LT(score.squaredSigmas / numbers, 1.25);
    EXPECT_GT(score.squaredSigmas / numbers, 0.5);
}

INSTANTIATE_TEST_SUITE_P(Lenses, ClippedSpots,
                         ::testing::Values(Lens{"Just", 0.9, 450, 0.8, 70}, Lens{"Much", 0.9, 1000, 0.8, 70},
                                           Lens{"Far", 0.9, 3000, 0.8, 70}, Lens{"Soft", 1.4, 800, 0.8, 70},
                                           Lens{"OneAtATime", 0.9, 450, 0.8, 70, ScanMethod::OneAtATime}),
                         [](const auto& lens) { return std::string(lens.param.name); });

}  // namespace
}  // namespace skincal::testing
