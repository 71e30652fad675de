#include "core/vision/paper_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/unit/vision/scan_painter.h"

namespace skincal::testing {
namespace {

using ::testing::HasSubstr;

ViewDetections detect(const ScanPainter& scan, const PaperDetectorOptions& options = {}) {
    const auto view = detectPaper("view", scan.modules(), scan.frames, scan.loader(), options);
    EXPECT_TRUE(view.has_value()) << (view ? "" : view.error().message.english());
    return view ? *view : ViewDetections{};
}

/// Three LEDs, one at a time, three frames each.
ScanPainter paperScan(std::uint64_t seed = 1, double peak = 180) {
    Random random(seed, "paper scan");
    ScanPainter scan;
    scan.seed = seed;
    scan.size = {160, 120};
    scan.width_px = 1.6;
    scan.halo = 0;
    scan.leds = scatterLeds(random, 3, scan.size, 40, 15);
    for (PaintedLed& led : scan.leds)
        led.peak = peak;
    scan.frames = oneAtATime(scan.leds, 3);
    return scan;
}

/// Adds light to the frames in which something is lit.
void whileLit(ScanPainter& scan, const std::function<void(cv::Mat&)>& add) {
    const auto frames = scan.frames;
    scan.disturb = [frames, add](cv::Mat& light, std::size_t k) {
        if (!frames[k].lit.empty())
            add(light);
    };
}

TEST(PaperDetectorOptions, AreThePapersConstants) {
    const PaperDetectorOptions options;
    EXPECT_EQ(options.blurSize, 9);
    EXPECT_EQ(options.blurSigma, 2);
    EXPECT_EQ(options.thresholdShare, 0.5);
    EXPECT_EQ(options.minThreshold, 40);
    EXPECT_EQ(options.binaryImages, 3);
    EXPECT_EQ(options.minArea, 1);
    EXPECT_EQ(options.maxArea, 500);
    EXPECT_EQ(options.maxBlobs, 1U);
    EXPECT_EQ(options.nativeColours, 7U);
    EXPECT_TRUE(options.validate());
}

TEST(PaperDetectorOptions, OutOfRangeThrow) {
    std::vector<PaperDetectorOptions> bad(13);
    bad[0].blurSize = 8;
    bad[1].blurSigma = 0;
    bad[2].thresholdShare = 1;
    bad[3].minThreshold = -1;
    bad[4].binaryImages = 0;
    bad[5].minArea = -1;
    bad[6].maxArea = 1;
    bad[7].maxBlobs = 0;
    bad[8].nativeColours = 8;
    bad[9].sigma_px = 0;
    bad[10].minSaturation = 1;
    bad[11].maxHueError = 0;
    bad[12].nativeColours = 0;
    const ScanPainter scan = paperScan();
    for (const PaperDetectorOptions& options : bad) {
        EXPECT_FALSE(options.validate());
        EXPECT_THROW((void)detectPaper("v", scan.modules(), scan.frames, scan.loader(), options), std::logic_error);
    }
}

TEST(PaperDetector, FindsLedsToATenthOfAPixel) {
    double squares = 0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 15; ++seed) {
        const ScanPainter scan = paperScan(seed);
        const ViewDetections view = detect(scan);
        ASSERT_EQ(view.found.size(), 3U) << seed;
        for (std::size_t u = 0; u < 3; ++u) {
            EXPECT_EQ(view.found[u].module, scan.leds[u].module);
            const double error = (view.found[u].pixel - scan.leds[u].pixel).norm();
            EXPECT_LT(error, 0.4);
            squares += error * error;
            count += 2;
        }
    }
    EXPECT_LT(std::sqrt(squares / count), 0.1);
}

TEST(PaperDetector, AFaintLedIsBelowTheMinimum) {
    const ScanPainter scan = paperScan(1, 60);
    const ViewDetections view = detect(scan);
    EXPECT_TRUE(view.found.empty());
    EXPECT_EQ(view.undetected.at(0).reason, "no blob");
    PaperDetectorOptions options;
    options.minThreshold = 15;
    EXPECT_EQ(detect(scan, options).found.size(), 3U);
}

TEST(PaperDetector, TwoBlobsAreNone) {
    ScanPainter scan = paperScan(2);
    const Vector2d free(8, 8);
    whileLit(scan, [&](cv::Mat& light) { addSpot(light, free, 125, 1.6); });
    const ViewDetections view = detect(scan);
    EXPECT_TRUE(view.found.empty());
    EXPECT_EQ(view.undetected.at(0).reason, "2 blobs instead of one");
    EXPECT_EQ(view.undetected.at(0).cause, Undetected::Cause::Reflected);
    PaperDetectorOptions options;
    options.maxBlobs = 2;
    const ViewDetections larger = detect(scan, options);
    ASSERT_EQ(larger.found.size(), 3U);
    for (std::size_t u = 0; u < 3; ++u)
        EXPECT_LT((larger.found[u].pixel - scan.leds[u].pixel).norm(), 0.5);
}

TEST(PaperDetector, AFlashInOneOfThreeFramesIsNoLed) {
    // The first module is covered; something flashes in the first of its frames, which is frame 1.
    ScanPainter scan = paperScan(3);
    scan.leds[0].peak = 0;
    const Vector2d there = scan.leds[0].pixel;
    scan.disturb = [&](cv::Mat& light, std::size_t k) {
        if (k == 1)
            addSpot(light, there, 180, 1.6);
    };
    EXPECT_EQ(detect(scan).found.size(), 2U);
    PaperDetectorOptions single;
    single.binaryImages = 1;
    EXPECT_EQ(detect(scan, single).found.size(), 3U) << "which M = 1 can't know";
}

TEST(PaperDetector, AFlashInOneOfThreeFramesHidesNoLed) {
    ScanPainter scan = paperScan(4);
    scan.disturb = [](cv::Mat& light, std::size_t k) {
        if (k == 1)
            addSpot(light, {8, 8}, 180, 1.6);
    };
    EXPECT_EQ(detect(scan).found.size(), 3U);
    PaperDetectorOptions single;
    single.binaryImages = 1;
    EXPECT_EQ(detect(scan, single).found.size(), 2U);
}

// Of two by two pixels, as the blob detector gives a single one no area.
TEST(PaperDetector, ASpeckIsSmoothedAway) {
    ScanPainter scan = paperScan(5);
    whileLit(scan, [](cv::Mat& light) { light(cv::Rect(8, 8, 2, 2)) += 180; });
    EXPECT_EQ(detect(scan).found.size(), 3U);
    for (const bool bySize : {true, false}) {
        PaperDetectorOptions options;
        if (bySize)
            options.blurSize = 1;
        else
            options.blurSigma = 0.2;
        EXPECT_TRUE(detect(scan, options).found.empty()) << "a second blob";
    }
}

TEST(PaperDetector, WhatStaysBelowHalfTheMaximumIsNoBlob) {
    ScanPainter scan = paperScan(6, 190);
    const Vector2d free(8, 8);
    whileLit(scan, [&](cv::Mat& light) { addSpot(light, free, 190 * 0.4, 1.6); });
    PaperDetectorOptions options;
    options.minThreshold = 10;
    EXPECT_EQ(detect(scan, options).found.size(), 3U);
    options.thresholdShare = 0.2;
    EXPECT_TRUE(detect(scan, options).found.empty());
}

TEST(PaperDetector, ABlobHasOneToFiveHundredPixels) {
    ScanPainter scan = paperScan(7);
    scan.leds.resize(1);
    scan.frames = oneAtATime(scan.leds, 3);
    const auto foundWithDiscOf = [&](double area, const PaperDetectorOptions& options = {}) {
        scan.leds[0].peak = 0;
        whileLit(scan, [area](cv::Mat& light) {
            for (int y = 0; y < light.rows; ++y) {
                for (int x = 0; x < light.cols; ++x) {
                    if ((Vector2d(x, y) - Vector2d(80, 60)).squaredNorm() <= area / 3.14159)
                        light.at<float>(y, x) += 120;
                }
            }
        });
        return detect(scan, options).found.size();
    };
    EXPECT_EQ(foundWithDiscOf(400), 1U);
    EXPECT_EQ(foundWithDiscOf(600), 0U);
    PaperDetectorOptions options;
    options.maxArea = 700;
    EXPECT_EQ(foundWithDiscOf(600, options), 1U);
    options.minArea = 450;
    EXPECT_EQ(foundWithDiscOf(400, options), 0U);
}

TEST(PaperDetector, SubtractsTheBackgroundThatIsNearestInTime) {
    // A lamp is switched on between the background before and the LED; the background after, late in the list of
    // frames but near in time, shows it as well.
    ScanPainter scan = paperScan(8);
    scan.leds.resize(1);
    const ModuleId id = scan.leds[0].module;
    scan.frames = {{"dark.png", {}, 0.0}, {"lit.png", {{id}}, 10.0}, {"lit.png", {{id}}, 10.1}, {"dark.png", {}, 10.2}};
    scan.disturb = [](cv::Mat& light, std::size_t k) {
        if (k > 0)
            addSpot(light, {8, 8}, 150, 2);
    };
    EXPECT_EQ(detect(scan).found.size(), 1U);
    for (FrameInfo& frame : scan.frames)
        frame.time_s.reset();
    PaperDetectorOptions first;
    first.binaryImages = 1;
    EXPECT_EQ(detect(scan, first).found.size(), 0U) << "by the order of frames the dark one is as near";
}

TEST(PaperDetector, GreyAndColourPicturesMayBeMixed) {
    const ScanPainter scan = paperScan(9);
    const FrameLoader mixed = [&](std::size_t k) -> tl::expected<cv::Mat, std::string> {
        cv::Mat picture = scan.paint(k);
        if (k % 3 == 1)
            cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
        return picture;
    };
    const auto view = detectPaper("view", scan.modules(), scan.frames, mixed);
    ASSERT_TRUE(view.has_value()) << view.error().message;
    EXPECT_EQ(view->found.size(), 3U);
}

TEST(PaperDetector, PicturesThatDoNotBelongTogetherAreErrors) {
    ScanPainter scan = paperScan(10);
    for (std::size_t k = 0; k < scan.frames.size(); ++k)
        scan.frames[k].file = "frame" + std::to_string(k) + ".png";
    // Frame 5 is the third of the first module, with a background of its own size beside it.
    for (const cv::Mat& bad :
         {cv::Mat(), cv::Mat(cv::Mat::zeros(50, 50, CV_8U)), cv::Mat(cv::Mat::zeros(scan.size, CV_16U))}) {
        for (const std::size_t first : {4U, 5U, 16U}) {
            const FrameLoader load = [&](std::size_t k) -> tl::expected<cv::Mat, std::string> {
                return k >= first ? bad : scan.paint(k);
            };
            const auto view = detectPaper("view", scan.modules(), scan.frames, load);
            ASSERT_FALSE(view.has_value());
            EXPECT_THAT(view.error().message, HasSubstr("frame"));
            EXPECT_FALSE(view.error().cancelled);
        }
    }
}

TEST(PaperDetector, SaysWhyAModuleIsNotAvailable) {
    ScanPainter scan = paperScan(11);
    const auto reasonOf = [&](std::size_t u) { return detect(scan).undetected.at(u).reason; };
    scan.frames = {{"dark.png", {}}, {"lit.png", {{scan.leds[0].module}, {scan.leds[1].module}}}};
    EXPECT_FALSE(suitsPaperDetector(scan.frames));
    EXPECT_THAT(reasonOf(0), HasSubstr("together with others"));
    EXPECT_THAT(reasonOf(1), HasSubstr("together with others"));
    EXPECT_THAT(reasonOf(2), HasSubstr("never lit"));
    scan.frames = {{"lit.png", {{scan.leds[0].module}}}};
    EXPECT_THAT(reasonOf(0), HasSubstr("no background"));
}

TEST(PaperDetector, LoaderErrorsAndCancellation) {
    const ScanPainter scan = paperScan();
    const auto failed = detectPaper(
        "v", scan.modules(), scan.frames,
        [](std::size_t) -> tl::expected<cv::Mat, std::string> { return tl::unexpected<std::string>("gone"); });
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "gone");
    RunContext context;
    context.isCancelled = [] { return true; };
    const auto cancelled = detectPaper("v", scan.modules(), scan.frames, scan.loader(), {}, context);
    ASSERT_FALSE(cancelled);
    EXPECT_TRUE(cancelled.error().cancelled);
}

}  // namespace
}  // namespace skincal::testing
