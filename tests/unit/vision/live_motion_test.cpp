#include "core/vision/live_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "core/vision/coded_scan.h"
#include "tests/unit/vision/scan_painter.h"

namespace skincal::testing {
namespace {

/// Takes off what the painter paints besides LEDs.
void darken(cv::Mat& light) {
    for (int y = 0; y < light.rows; ++y) {
        for (int x = 0; x < light.cols; ++x)
            light.at<float>(y, x) -= static_cast<float>(40 + 0.1 * x + 15 * std::sin(0.11 * x) * std::cos(0.07 * y));
    }
}

/// Nothing but LEDs, no two pictures of which are alike: all else only helps.
ScanPainter scanInTheDark(std::uint64_t seed) {
    Random random(seed, "live motion");
    ScanPainter scan;
    scan.seed = seed;
    scan.leds = scatterLeds(random, 12 + 2 * seed, scan.size, 12, 20);
    for (const auto& lit : codedScan(scan.modules(), seed))
        scan.frames.push_back({{}, lit});
    scan.disturb = [](cv::Mat& light, std::size_t) { darken(light); };
    return scan;
}

TEST(LiveMotion, SaysNothingWhileTheCameraStands) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        ScanPainter scan = scanInTheDark(seed);
        if (seed % 2 == 0) {
            // Somebody walks by.
            scan.disturb = [&](cv::Mat& light, std::size_t k) {
                darken(light);
                const cv::Rect person(static_cast<int>(k * 280 / scan.frames.size()), 60, 30, 120);
                light(person & cv::Rect(0, 0, light.cols, light.rows)) += 30;
            };
        }
        LiveMotion motion;
        for (std::size_t k = 0; k < scan.frames.size(); ++k) {
            motion.add(scan.paint(k));
            EXPECT_FALSE(motion.moved_px()) << "seed " << seed << ", picture " << k;
        }
    }
}

TEST(LiveMotion, TellsAKnockSoon) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const ScanPainter before = scanInTheDark(seed);
        ScanPainter after = before;
        Random random(seed, "knock");
        const double angle = random.uniform(0, 6.28);
        const double way = random.uniform(3, 15);
        for (PaintedLed& led : after.leds)
            led.pixel += way * Vector2d(std::cos(angle), std::sin(angle));
        const std::size_t knock = 2 + random.index(before.frames.size() - 8);
        LiveMotion motion;
        for (std::size_t k = 0; k < knock; ++k)
            motion.add(before.paint(k));
        EXPECT_FALSE(motion.moved_px());
        for (std::size_t k = knock; k < knock + 4; ++k)
            motion.add(after.paint(k));
        ASSERT_TRUE(motion.moved_px()) << "seed " << seed;
        EXPECT_NEAR(*motion.moved_px(), way, 1) << "seed " << seed;
    }
}

TEST(LiveMotion, IgnoresPicturesThatAreNone) {
    const ScanPainter scan = scanInTheDark(1);
    LiveMotion motion;
    motion.add({});
    motion.add(scan.paint(0));
    motion.add(scan.paint(1));
    for (int k = 0; k < 3; ++k)
        motion.add(cv::Mat(30, 40, CV_8U, cv::Scalar(7)));
    EXPECT_FALSE(motion.moved_px());
}

}  // namespace
}  // namespace skincal::testing
