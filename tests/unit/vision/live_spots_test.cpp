#include "core/vision/live_spots.h"

#include <gtest/gtest.h>

#include "tests/unit/vision/scan_painter.h"

namespace skincal::testing {
namespace {

ScanPainter codedScanOf(std::uint64_t seed, std::size_t leds) {
    Random random(seed, "live spots");
    ScanPainter scan;
    scan.seed = seed;
    scan.leds = scatterLeds(random, leds, scan.size);
    for (const auto& lit : codedScan(scan.modules(), seed))
        scan.frames.push_back({{}, lit});
    return scan;
}

LitSets litOf(const ScanPainter& scan) {
    LitSets lit;
    for (const FrameInfo& frame : scan.frames)
        lit.push_back(frame.lit);
    return lit;
}

const LiveSpot* spotAt(const std::vector<LiveSpot>& spots, const Vector2d& pixel) {
    for (const LiveSpot& spot : spots) {
        if ((spot.pixel - pixel).norm() < 2)
            return &spot;
    }
    return nullptr;
}

TEST(LiveSpots, KnowsEverySpotAtTheEnd) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const ScanPainter scan = codedScanOf(seed, 30);
        LiveSpots live(scan.modules(), litOf(scan));
        for (std::size_t k = 0; k < scan.frames.size(); ++k)
            EXPECT_TRUE(live.add(scan.paint(k)));
        const auto spots = live.spots();
        EXPECT_EQ(spots.size(), scan.leds.size()) << "seed " << seed;
        for (const PaintedLed& led : scan.leds) {
            const LiveSpot* spot = spotAt(spots, led.pixel);
            ASSERT_NE(spot, nullptr) << "seed " << seed;
            EXPECT_EQ(spot->module, led.module) << "seed " << seed;
            EXPECT_GT(spot->contrast, 20);
        }
    }
}

TEST(LiveSpots, NarrowDownPictureByPicture) {
    const ScanPainter scan = codedScanOf(3, 24);
    LiveSpots live(scan.modules(), litOf(scan));
    EXPECT_TRUE(live.add(scan.paint(0)));
    EXPECT_TRUE(live.spots().empty()) << "before any light";
    EXPECT_TRUE(live.add(scan.paint(1)));
    std::size_t before = 24;
    for (const LiveSpot& spot : live.spots())
        EXPECT_EQ(spot.possible, before);
    for (std::size_t k = 2; k < scan.frames.size(); ++k) {
        EXPECT_TRUE(live.add(scan.paint(k)));
        std::size_t most = 0;
        for (const LiveSpot& spot : live.spots()) {
            EXPECT_EQ(spot.module.has_value(), spot.possible == 1);
            most = std::max(most, spot.possible);
        }
        EXPECT_LE(most, before);
        before = most;
    }
    EXPECT_EQ(before, 1U);
}

TEST(LiveSpots, WhatBlinksOtherwiseIsNoModule) {
    ScanPainter scan = codedScanOf(4, 12);
    const Vector2d lamp(20, 20);
    for (auto& led : scan.leds) {
        if ((led.pixel - lamp).norm() < 16)
            led.peak = 0;
    }
    // Lit with the first flash and never again: a passing reflection of the sun.
    scan.disturb = [&](cv::Mat& light, std::size_t k) {
        if (k == 1)
            addSpot(light, lamp, 150, 1.1);
    };
    LiveSpots live(scan.modules(), litOf(scan));
    for (std::size_t k = 0; k < scan.frames.size(); ++k)
        live.add(scan.paint(k));
    const auto spots = live.spots();
    const LiveSpot* spot = spotAt(spots, lamp);
    ASSERT_NE(spot, nullptr);
    EXPECT_EQ(spot->possible, 0U);
    EXPECT_FALSE(spot->module);
}

TEST(LiveSpots, LeavesOutWhatItCantRead) {
    const ScanPainter scan = codedScanOf(5, 8);
    LiveSpots live(scan.modules(), litOf(scan));
    EXPECT_TRUE(live.add(scan.paint(0)));
    EXPECT_FALSE(live.add({}));
    EXPECT_FALSE(live.add(cv::Mat(10, 10, CV_8U, cv::Scalar(3))));
    EXPECT_FALSE(live.add(cv::Mat(scan.size, CV_16U, cv::Scalar(3))));
    EXPECT_EQ(live.pictures(), 1U);
    for (std::size_t k = 1; k < scan.frames.size(); ++k)
        EXPECT_TRUE(live.add(scan.paint(k)));
    EXPECT_FALSE(live.add(scan.paint(0))) << "one too many";
}

}  // namespace
}  // namespace skincal::testing
