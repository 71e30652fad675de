// Spots that are wide, near each other, or both; or blind in the middle.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <unordered_map>

#include "tests/unit/vision/coded_book.h"
#include "tests/unit/vision/decoded.h"

namespace skincal::testing {
namespace {

class LensOutOfFocus : public ::testing::TestWithParam<double> {};

TEST_P(LensOutOfFocus, CostsNeitherModulesNorHonesty) {
    double normalised = 0;
    std::size_t count = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        Random random(seed, "wide");
        ScanPainter scan;
        scan.seed = seed;
        scan.size = {480, 360};
        scan.width_px = GetParam();
        scan.leds = scatterLeds(random, 20, scan.size, 24, 24);
        // Bright ones are clipped over more than a window is wide at first.
        for (PaintedLed& led : scan.leds)
            led.peak = random.uniform(100, 1000);
        scan.frames = codedFrames(scan.modules(), seed);
        std::size_t loads = 0;
        const auto decoded = decodeView("view", scan.modules(), scan.frames, [&](std::size_t k) {
            ++loads;
            return scan.loader()(k);
        });
        ASSERT_TRUE(decoded.has_value());
        const ViewDetections& view = *decoded;
        EXPECT_GE(expectNoneWrong(scan, view), scan.leds.size() - 1) << "seed " << seed;
        // A sharp lens costs no second go, and none more than two.
        EXPECT_LE(loads, (GetParam() < 1 ? 3 : 7) * scan.frames.size());
        std::unordered_map<ModuleId, Vector2d> truth;
        for (const PaintedLed& led : scan.leds)
            truth.emplace(led.module, led.pixel);
        for (const LedDetection& found : view.found)
            normalised += (found.pixel - truth.at(found.module)).squaredNorm() / 2 / std::pow(found.sigma_px, 2);
        count += view.found.size();
    }
    EXPECT_LT(normalised / static_cast<double>(count), 1.5);
    EXPECT_GT(normalised / static_cast<double>(count), 0.5);
}

INSTANTIATE_TEST_SUITE_P(Widths, LensOutOfFocus, ::testing::Values(0.9, 1.8, 2.6, 3.4),
                         [](const auto& width) { return std::to_string(std::lround(10 * width.param)); });

// White domes in a bright room are white whether their LEDs are lit or not; but for their rims.
TEST(BlindSpots, AreFoundByTheirRims) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        Random random(seed, "rims");
        ScanPainter scan;
        scan.seed = seed;
        scan.leds = scatterLeds(random, 12, scan.size, 24, 16);
        for (PaintedLed& led : scan.leds)
            led.peak = random.uniform(400, 700);
        scan.frames = codedFrames(scan.modules(), seed);
        scan.disturb = [&](cv::Mat& light, std::size_t) {
            for (const PaintedLed& led : scan.leds)
                addSpot(light, led.pixel, 3000, 1.3);
        };
        const ViewDetections view = decode(scan);
        EXPECT_GE(expectNoneWrong(scan, view), scan.leds.size() - 1) << "seed " << seed;
    }
}

TEST(CrowdedSpots, NoTwoModulesAreInOnePlace) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        Random random(seed, "same place");
        ScanPainter scan;
        scan.seed = seed;
        scan.leds = scatterLeds(random, 12, scan.size);
        scan.leds[0].peak = 90;
        scan.leds[1] = {scan.leds[1].module, scan.leds[0].pixel + Vector2d(0.2, 0.1), 80};
        // Nor is one of them where it is reflected.
        scan.mirrored = {{scan.leds[0].module, scan.leds[0].pixel + Vector2d(0, 30), 30}};
        scan.frames = codedFrames(scan.modules(), seed);
        const ViewDetections view = decode(scan);
        EXPECT_EQ(expectNoneWrong(scan, view), scan.leds.size() - 2);
        for (const std::size_t u : {0U, 1U}) {
            const Undetected* one = missing(view, scan.leds[u].module);
            ASSERT_NE(one, nullptr) << "seed " << seed;
            EXPECT_EQ(one->verdict, DetectionVerdict::Ambiguous);
            EXPECT_EQ(one->reason.english(), "its spot is that of another module, too");
        }
    }
}

/// Gives the LEDs words of ten thousand and decodes them; expects none farther from its own place than that.
/// @return how many were found
std::size_t foundOfTenThousand(ScanPainter& scan, Random& random, double farthest_px) {
    constexpr std::size_t kModules = 10'000;
    std::vector<ModuleId> modules;
    for (std::size_t u = 0; u < kModules; ++u)
        modules.emplace_back(static_cast<std::uint32_t>(1 + u));
    std::vector<std::size_t> who(kModules);
    std::iota(who.begin(), who.end(), std::size_t{0});
    std::unordered_map<ModuleId, Vector2d> truth;
    for (std::size_t i = 0; i < scan.leds.size(); ++i) {
        std::swap(who[i], who[i + random.index(kModules - i)]);
        scan.leds[i].module = modules[who[i]];
        truth.emplace(scan.leds[i].module, scan.leds[i].pixel);
    }
    scan.frames = codedFrames(modules, scan.seed);
    const auto view = decodeView("view", modules, scan.frames, scan.loader());
    if (!view) {
        ADD_FAILURE() << view.error().message.english();
        return 0;
    }
    for (const LedDetection& one : view->found) {
        const auto there = truth.find(one.module);
        if (there == truth.end())
            ADD_FAILURE() << "module " << one.module.value << " is out of sight, seed " << scan.seed;
        else
            EXPECT_LT((one.pixel - there->second).norm(), farthest_px)
                << "module " << one.module.value << ", seed " << scan.seed;
    }
    return view->found.size();
}

// Of ten thousand words many two add up to two others.
TEST(CrowdedSpots, WhoMergesIsNobodyElse) {
    constexpr double kApart_px = 3.6;
    std::size_t found = 0;
    std::size_t all = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Random random(seed, "pairs");
        ScanPainter scan;
        scan.seed = seed;
        scan.size = {640, 480};
        scan.width_px = 1.8;
        scan.leds = scatterLeds(random, 200, scan.size, 18, 16);
        const std::size_t pairs = scan.leds.size();
        for (std::size_t i = 0; i < pairs; ++i) {
            scan.leds[i].peak = random.uniform(28, 38);
            const double angle = random.uniform(0, 6.28);
            scan.leds.push_back({{},
                                 scan.leds[i].pixel + kApart_px * Vector2d(std::cos(angle), std::sin(angle)),
                                 random.uniform(28, 38)});
        }
        // Nearer to each than to the other one of its pair.
        found += foundOfTenThousand(scan, random, kApart_px / 2);
        all += scan.leds.size();
    }
    EXPECT_GE(found, all / 3) << "the rest waits for a further look";
}

// The skirts of two add up to the word of a third one, nearly: it is nobody's LED.
TEST(CrowdedSpots, NobodyIsSeenInOthersLight) {
    for (const std::uint64_t seed : {7, 8, 9}) {
        Random random(seed, "others' light");
        ScanPainter scan;
        scan.seed = seed;
        scan.size = {400, 300};
        scan.leds = scatterLeds(random, 1500, scan.size, 2.5, 8);
        for (PaintedLed& led : scan.leds)
            led.peak = random.uniform(50, 80);
        EXPECT_GE(foundOfTenThousand(scan, random, 1), scan.leds.size() * 4 / 5);
    }
}

}  // namespace
}  // namespace skincal::testing
