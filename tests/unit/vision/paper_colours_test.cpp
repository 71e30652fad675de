// The paper's colour variant: which frames it can use, and whose a coloured blob is.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/vision/paper_detector.h"
#include "core/vision/paper_frames.h"
#include "tests/unit/vision/scan_painter.h"

namespace skincal::testing {
namespace {

using ::testing::HasSubstr;
using Colour = std::array<int, 3>;

constexpr Colour kRed{1, 0, 0};
constexpr Colour kGreen{0, 1, 0};
constexpr Colour kBlue{0, 0, 1};
constexpr Colour kYellow{1, 1, 0};
constexpr Colour kWhite{1, 1, 1};
constexpr Colour kBlack{0, 0, 0};
const std::vector<Colour> kNative{kRed, kGreen, kBlue, kYellow, {0, 1, 1}, {1, 0, 1}, kWhite};

/// As many LEDs as colours, lit together `repeats` times between backgrounds.
ScanPainter colourScan(const std::vector<Colour>& colours, int repeats = 1, std::uint64_t seed = 1) {
    Random random(seed, "colour scan");
    ScanPainter scan;
    scan.seed = seed;
    scan.size = {200, 150};
    scan.width_px = 1.7;
    scan.halo = 0;
    scan.colour = true;
    scan.leds = scatterLeds(random, colours.size(), scan.size, 30, 15);
    FrameInfo lit{"lit.png", {}};
    for (std::size_t u = 0; u < colours.size(); ++u) {
        scan.leds[u].peak = 150;
        lit.lit.push_back({scan.leds[u].module, colours[u]});
    }
    scan.frames = {{"dark.png", {}}};
    for (int repeat = 0; repeat < repeats; ++repeat)
        scan.frames.insert(scan.frames.end(), {lit, {"dark.png", {}}});
    return scan;
}

ViewDetections detect(const ScanPainter& scan, const PaperDetectorOptions& options = {},
                      const std::vector<FrameInfo>& told = {}) {
    const auto view = detectPaper("view", scan.modules(), told.empty() ? scan.frames : told, scan.loader(), options);
    EXPECT_TRUE(view.has_value()) << (view ? "" : view.error().message.english());
    return view ? *view : ViewDetections{};
}

/// Found modules are where they are; how many there are.
std::size_t expectNoneWrong(const ScanPainter& scan, const ViewDetections& view) {
    for (const LedDetection& found : view.found) {
        const auto led = std::find_if(scan.leds.begin(), scan.leds.end(),
                                      [&](const PaintedLed& one) { return one.module == found.module; });
        EXPECT_GT(led->peak, 0);
        EXPECT_LT((found.pixel - led->pixel).norm(), 0.5) << found.module.value;
    }
    return view.found.size();
}

TEST(PaperColours, AllSevenAreToldApartInASingleFrame) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const ScanPainter scan = colourScan(kNative, 1, seed);
        EXPECT_TRUE(suitsPaperDetector(scan.frames));
        EXPECT_EQ(expectNoneWrong(scan, detect(scan)), 7U) << seed;
    }
}

TEST(PaperColours, SoManyLedsAtOnceAsTheOptionsAllow) {
    const ScanPainter scan = colourScan({kRed, kGreen, kBlue});
    PaperDetectorOptions options;
    options.nativeColours = 2;
    EXPECT_FALSE(suitsPaperDetector(scan.frames, options));
    EXPECT_TRUE(detect(scan, options).found.empty());
    options.nativeColours = 3;
    EXPECT_EQ(expectNoneWrong(scan, detect(scan, options)), 3U);
}

TEST(PaperColours, ACoveredModuleIsNotTakenForAnotherOfItsColour) {
    for (const Colour& colour : {kRed, kWhite}) {
        ScanPainter scan = colourScan({colour, colour, kGreen});
        scan.leds[0].peak = 0;
        EXPECT_FALSE(suitsPaperDetector(scan.frames));
        const ViewDetections view = detect(scan);
        EXPECT_TRUE(view.found.empty());
        EXPECT_THAT(view.undetected.at(0).reason, HasSubstr("colour of its own"));
    }
}

TEST(PaperColours, BlackIsNoColour) {
    EXPECT_FALSE(suitsPaperDetector(colourScan({kBlack, kRed}).frames));
    const ScanPainter alone = colourScan({kBlack});
    EXPECT_FALSE(suitsPaperDetector(alone.frames));
    EXPECT_THAT(detect(alone).undetected.at(0).reason, HasSubstr("never lit"));
}

TEST(PaperColours, NoColourMeansWhite) {
    ScanPainter scan = colourScan({kRed, kWhite});
    scan.frames[1].lit[1].colour.reset();
    EXPECT_EQ(expectNoneWrong(scan, detect(scan)), 2U);
    scan.frames[1].lit[0].colour.reset();
    EXPECT_FALSE(suitsPaperDetector(scan.frames));
}

TEST(PaperColours, ABlobOfAnotherColourIsNobodys) {
    // What shines is white, or of a hue that nobody was told to show.
    for (const Colour& shines : {kWhite, kBlue, kYellow}) {
        const ScanPainter scan = colourScan({shines});
        auto told = scan.frames;
        for (FrameInfo& frame : told) {
            for (LitModule& lit : frame.lit)
                lit.colour = kRed;
        }
        const ViewDetections view = detect(scan, {}, told);
        EXPECT_TRUE(view.found.empty());
        EXPECT_EQ(view.undetected.at(0).reason, "no blob of its colour");
    }
    // And a coloured one is not the white LED's.
    const ScanPainter scan = colourScan({kBlue, kGreen});
    auto told = scan.frames;
    told[1].lit[0].colour = kWhite;
    const ViewDetections view = detect(scan, {}, told);
    ASSERT_EQ(view.found.size(), 1U);
    EXPECT_EQ(view.found[0].module, scan.leds[1].module);
}

TEST(PaperColours, HowFarAHueMayBeOffAndWhatIsGreyAreOptions) {
    const ScanPainter scan = colourScan({kYellow});
    auto told = scan.frames;
    told[1].lit[0].colour = kRed;
    PaperDetectorOptions options;
    options.maxHueError = 61 * kDegree;
    EXPECT_EQ(detect(scan, options, told).found.size(), 1U);
    options.maxHueError = 59 * kDegree;
    EXPECT_EQ(detect(scan, options, told).found.size(), 0U);

    ScanPainter pale = colourScan({kRed});
    // Some of the light in all channels, as a camera that is nearly at the end of its scale shows it.
    const Vector2d there = pale.leds[0].pixel;
    pale.disturb = [there](cv::Mat& light, std::size_t k) {
        if (k == 1)
            addSpot(light, there, 30, 1.7);
    };
    EXPECT_EQ(detect(pale).found.size(), 1U);
    options = {};
    options.minSaturation = 0.95;
    EXPECT_EQ(detect(pale, options).found.size(), 0U);
}

TEST(PaperColours, AFlickerInOneOfThreeFramesIsNoLed) {
    ScanPainter scan = colourScan({kWhite, kGreen}, 3);
    scan.leds[0].peak = 0;
    const Vector2d there = scan.leds[0].pixel;
    scan.disturb = [&](cv::Mat& light, std::size_t k) {
        if (k == 1)
            addSpot(light, there, 150, 1.7);
    };
    const ViewDetections view = detect(scan);
    EXPECT_EQ(expectNoneWrong(scan, view), 1U);
    EXPECT_EQ(view.undetected.at(0).reason, "no blob of its colour");
    // Alone, the frame with the flicker cannot be told from one with the LED.
    auto told = scan.frames;
    told.resize(3);
    EXPECT_EQ(detect(scan, {}, told).found.size(), 2U);
}

TEST(PaperColours, WhatStaysBelowHalfTheMaximumIsNoBlob) {
    ScanPainter scan = colourScan({kRed, kGreen}, 3);
    for (PaintedLed& led : scan.leds)
        led.peak = 190;
    PaintedLed mirrored = scan.leds[0];
    mirrored.peak = 75;
    mirrored.pixel = {7, 7};
    scan.mirrored.push_back(mirrored);
    PaperDetectorOptions options;
    options.minThreshold = 15;
    EXPECT_EQ(expectNoneWrong(scan, detect(scan, options)), 2U);
    options.thresholdShare = 0.2;
    const ViewDetections view = detect(scan, options);
    EXPECT_EQ(expectNoneWrong(scan, view), 1U);
    EXPECT_EQ(view.undetected.at(0).reason, "2 blobs of its colour instead of one");
}

TEST(PaperColours, LitSetsThatContradictEachOtherPlaceNothing) {
    // The first module is red in one frame and green in another, where something green shines elsewhere.
    ScanPainter scan = colourScan({kRed});
    const ModuleId id = scan.leds[0].module;
    scan.frames.push_back({"green.png", {{id, kGreen}}});
    EXPECT_EQ(expectNoneWrong(scan, detect(scan)), 1U);
    ScanPainter moved = scan;
    moved.leds[0].pixel += Vector2d(20, 10);
    const FrameLoader load = [&](std::size_t k) -> tl::expected<cv::Mat, std::string> {
        return k == 3 ? moved.paint(k) : scan.paint(k);
    };
    const auto view = detectPaper("view", scan.modules(), scan.frames, load);
    ASSERT_TRUE(view.has_value());
    EXPECT_TRUE(view->found.empty());
    EXPECT_THAT(view->undetected.at(0).reason, HasSubstr("different places"));
}

TEST(PaperColours, AFrameOfItsOwnBeatsColours) {
    ScanPainter scan = colourScan({kRed, kGreen});
    const ModuleId id = scan.leds[0].module;
    scan.frames.push_back({"alone.png", {{id}}});
    ScanPainter moved = scan;
    moved.leds[0].pixel = {100, 7};
    const FrameLoader load = [&](std::size_t k) -> tl::expected<cv::Mat, std::string> {
        return k == 3 ? moved.paint(k) : scan.paint(k);
    };
    const auto view = detectPaper("view", scan.modules(), scan.frames, load);
    ASSERT_TRUE(view.has_value());
    ASSERT_EQ(view->found.size(), 2U);
    EXPECT_LT((view->found[0].pixel - Vector2d(100, 7)).norm(), 0.5);
}

TEST(PaperColours, GreyPicturesHaveNone) {
    ScanPainter scan = colourScan({kRed, kGreen});
    scan.colour = false;
    const ViewDetections view = detect(scan);
    EXPECT_TRUE(view.found.empty());
    EXPECT_THAT(view.undetected.at(0).reason, HasSubstr("pictures have none"));
}

TEST(NearestBackgrounds, AreTheNearestOfAll) {
    Random random(1, "backgrounds");
    for (int round = 0; round < 300; ++round) {
        const bool timed = round % 2 == 0;
        std::vector<FrameInfo> frames(1 + random.index(30));
        double t = 0;
        for (std::size_t k = 0; k < frames.size(); ++k) {
            if (random.uniform() < 0.7)
                frames[k].lit.push_back({ModuleId(1)});
            t += random.uniform(0.1, 2);
            if (timed)
                frames[k].time_s = t;
        }
        const auto nearest = nearestBackgrounds(frames);
        ASSERT_EQ(nearest.size(), frames.size());
        for (std::size_t k = 0; k < frames.size(); ++k) {
            std::optional<std::size_t> expected;
            double least = 1e9;
            for (std::size_t b = 0; b < frames.size(); ++b) {
                if (b == k || !frames[b].lit.empty())
                    continue;
                const double distance = std::abs(timed ? *frames[b].time_s - *frames[k].time_s
                                                       : static_cast<double>(b) - static_cast<double>(k));
                if (distance < least) {
                    least = distance;
                    expected = b;
                }
            }
            EXPECT_EQ(nearest[k], expected) << round << " " << k;
        }
    }
}

TEST(NearestBackgrounds, WithoutAllTimesTheOrderCounts) {
    std::vector<FrameInfo> frames{
        {"0", {}, 0.0}, {"1", {{ModuleId(1)}}, 9.0}, {"2", {{ModuleId(1)}}, 9.1}, {"3", {}, 9.2}};
    EXPECT_EQ(nearestBackgrounds(frames)[1], 3U);
    frames[3].time_s.reset();
    EXPECT_EQ(nearestBackgrounds(frames)[1], 0U);
    EXPECT_TRUE(nearestBackgrounds({}).empty());
}

TEST(PaperGroups, EqualLitSetsAreOneGroupInWhateverOrderTheyAreWritten) {
    const ModuleId a(1);
    const ModuleId b(2);
    const std::vector<FrameInfo> frames{{"0", {}},
                                        {"1", {{a, kRed}, {b, kGreen}}},
                                        {"2", {{b, kGreen}, {a, kRed}}},
                                        {"3", {{b, kRed}, {a, kGreen}}},
                                        {"4", {{a}}},
                                        {"5", {{a, kWhite}}},
                                        {"6", {{a, kRed}}}};
    const auto groups = paperGroups(frames, 7);
    ASSERT_EQ(groups.size(), 4U);
    EXPECT_EQ(groups[0].pairs.size(), 2U);
    EXPECT_TRUE(groups[0].coloured);
    EXPECT_EQ(groups[1].pairs.size(), 1U);
    EXPECT_EQ(groups[2].pairs.size(), 2U) << "white is what an LED without a colour shows";
    EXPECT_FALSE(groups[2].coloured);
    EXPECT_TRUE(groups[3].coloured);
}

}  // namespace
}  // namespace skincal::testing
