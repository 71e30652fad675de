// What the decoder says of why it decided: words sent and received, light over noise, lead.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/vision/decoded.h"

namespace skincal::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

ScanPainter scanOf(std::uint64_t seed, std::size_t leds, bool single) {
    Random random(seed, "scan");
    ScanPainter scan;
    scan.seed = seed;
    scan.leds = scatterLeds(random, leds, scan.size);
    scan.frames = single ? oneAtATime(scan.leds) : coded(scan.leds, random);
    return scan;
}

/// By the list of frames.
std::string wordOf(const ScanPainter& scan, ModuleId module) {
    std::string bits;
    for (const FrameInfo& frame : scan.frames) {
        const bool isLit =
            std::any_of(frame.lit.begin(), frame.lit.end(), [&](const LitModule& lit) { return lit.module == module; });
        bits += isLit ? '1' : '0';
    }
    return bits;
}

TEST(WordReading, BitsStandWhereTheirPlanesAre) {
    const WordReading reading{6, false, {1, 4}, {1, 5}, {4}};
    EXPECT_EQ(reading.sentBits(), "010010");
    EXPECT_EQ(reading.receivedBits(), "0100.1");
    EXPECT_EQ(WordReading{}.sentBits(), "");
}

TEST(WordReading, WhatWasFoundReadsAsItWasSent) {
    for (const bool single : {false, true}) {
        const ScanPainter scan = scanOf(3, 14, single);
        const ViewDetections view = decode(scan);
        ASSERT_EQ(view.readings.size(), scan.leds.size());
        for (std::size_t i = 0; i < view.found.size(); ++i) {
            const WordReading& reading = view.readings[i];
            EXPECT_EQ(reading.sentBits(), wordOf(scan, view.found[i].module));
            EXPECT_EQ(reading.receivedBits(), reading.sentBits());
            EXPECT_THAT(reading.disturbed, IsEmpty());
            EXPECT_GE(reading.margin, WordMatchOptions{}.minMargin);
        }
    }
}

TEST(WordReading, TwiceTheLightIsTwiceTheRatio) {
    ScanPainter scan = scanOf(4, 14, false);
    for (PaintedLed& led : scan.leds)
        led.peak = 40;
    const ViewDetections dim = decode(scan);
    for (PaintedLed& led : scan.leds)
        led.peak = 80;
    const ViewDetections bright = decode(scan);
    ASSERT_EQ(dim.readings.size(), scan.leds.size());
    ASSERT_EQ(bright.readings.size(), scan.leds.size());
    for (std::size_t i = 0; i < dim.readings.size(); ++i) {
        EXPECT_NEAR(bright.readings[i].snr / dim.readings[i].snr, 2, 0.2);
        EXPECT_GT(bright.readings[i].margin, dim.readings[i].margin);
    }
}

TEST(WordReading, AFlashIsAPointInTheWord) {
    ScanPainter scan = scanOf(5, 10, false);
    const Vector2d at = scan.leds[2].pixel;
    constexpr std::size_t kFlash = 7;
    scan.disturb = [&](cv::Mat& light, std::size_t k) {
        if (k == kFlash)
            addSpot(light, at, 120, 1.5);
    };
    const ViewDetections view = decode(scan);
    const auto found = std::find_if(view.found.begin(), view.found.end(),
                                    [&](const LedDetection& one) { return one.module == scan.leds[2].module; });
    ASSERT_NE(found, view.found.end());
    const WordReading& reading = view.readings[static_cast<std::size_t>(found - view.found.begin())];
    EXPECT_THAT(reading.disturbed, ElementsAre(kFlash));
    std::string expected = reading.sentBits();
    expected[kFlash] = '.';
    EXPECT_EQ(reading.receivedBits(), expected);
}

TEST(WordReading, WhatWasNotFoundNamesTheSpotThatCameNearest) {
    for (const bool single : {false, true}) {
        ScanPainter scan = scanOf(6, 12, single);
        // One has a mirror image as bright as itself, one is a smear, one is covered.
        scan.mirrored.push_back({scan.leds[0].module, scan.leds[0].pixel + Vector2d(7, 5), scan.leds[0].peak});
        const PaintedLed smear = scan.leds[1];
        scan.leds[1].peak = 0;
        scan.leds[2].peak = 0;
        scan.disturb = [&](cv::Mat& light, std::size_t k) {
            for (const LitModule& lit : scan.frames[k].lit) {
                if (lit.module == smear.module)
                    addSpot(light, smear.pixel, 100, 2.6 * scan.width_px);
            }
        };
        const ViewDetections view = decode(scan);
        const Undetected* mirrored = missing(view, scan.leds[0].module);
        ASSERT_NE(mirrored, nullptr);
        ASSERT_TRUE(mirrored->nearest);
        EXPECT_LT((mirrored->nearest->pixel - mirrored->spots.front().pixel).norm(), 2);
        const Undetected* smeared = missing(view, smear.module);
        ASSERT_NE(smeared, nullptr);
        ASSERT_TRUE(smeared->nearest);
        EXPECT_LT((smeared->nearest->pixel - smear.pixel).norm(), 3);
        for (const Undetected* one : {mirrored, smeared}) {
            EXPECT_EQ(one->nearest->reading.sentBits(), wordOf(scan, one->module));
            EXPECT_EQ(one->nearest->reading.receivedBits(), wordOf(scan, one->module));
            EXPECT_GT(one->nearest->reading.snr, 5);
        }
        const Undetected* covered = missing(view, scan.leds[2].module);
        ASSERT_NE(covered, nullptr);
        EXPECT_FALSE(covered->nearest) << covered->reason;
    }
}

TEST(WordReading, WhereManyAreLitOneAtATimeNoneIsLong) {
    const ScanPainter scan = scanOf(7, 60, true);
    const ViewDetections view = decode(scan);
    ASSERT_GT(view.readings.size(), 40U);
    for (const WordReading& reading : view.readings) {
        EXPECT_EQ(reading.planes, scan.frames.size());
        EXPECT_EQ(reading.sent.size(), 1U);
        EXPECT_LE(reading.received.size() + reading.disturbed.size(), 3U);
    }
}

TEST(WordReading, TellsTheLookThatItWasReadIn) {
    ScanPainter scan = scanOf(8, 6, false);
    scan.leds[0].peak = 0;
    for (FrameInfo& frame : scan.frames)
        frame.look = 4;
    for (const WordReading& reading : decode(scan).readings)
        EXPECT_EQ(reading.look, 4U);
}

}  // namespace
}  // namespace skincal::testing
