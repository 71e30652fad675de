#include "core/vision/spot_candidates.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "tests/unit/vision/scan_painter.h"

namespace skincal::testing {
namespace {

cv::Mat noisy(Random& random, double level, double read, double gain, cv::Size size = {320, 240}) {
    cv::Mat picture(size, CV_8U);
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const double clean = level + 0.4 * x;
            picture.at<unsigned char>(y, x) =
                cv::saturate_cast<unsigned char>(clean + std::sqrt(read + gain * clean) * random.normal());
        }
    }
    return picture;
}

TEST(ImageNoise, IsReadOffThePictures) {
    Random random(1, "noise");
    for (const double gain : {0.0, 0.02, 0.06}) {
        ImageNoiseEstimator estimator;
        for (int i = 0; i < 6; ++i)
            estimator.add(noisy(random, 40, 2.5, gain), noisy(random, 40, 2.5, gain));
        const ImageNoise noise = estimator.estimate();
        for (const double level : {50.0, 100.0, 150.0})
            EXPECT_NEAR(noise.variance(level), 2.5 + 1.0 / 12 + gain * level, 0.12 * (2.5 + gain * level));
    }
}

TEST(ImageNoise, ChangesOfTheSceneDoNotCount) {
    Random random(2, "changes");
    ImageNoiseEstimator estimator;
    for (int i = 0; i < 6; ++i) {
        cv::Mat b = noisy(random, 40, 2.5, 0);
        b(cv::Rect(20 * i, 30, 40, 60)) += cv::Scalar(60);
        estimator.add(noisy(random, 40, 2.5, 0), b);
    }
    EXPECT_NEAR(estimator.estimate().variance(100), 2.6, 0.6);
}

TEST(ImageNoise, DarkPixelsLoseNoneOfIt) {
    // Half of what a sensor reads is below what is left of it at black.
    for (const int level : {3, 5, 8, 10}) {
        Random random(static_cast<std::uint64_t>(level), "dark");
        ImageNoiseEstimator estimator;
        for (int i = 0; i < 6; ++i) {
            cv::Mat a = noisy(random, 0, 1.7, 0.02);
            cv::Mat b = noisy(random, 0, 1.7, 0.02);
            const cv::Rect lit(20, 20, 160, 120);
            noisy(random, level, 1.7, 0.02)(lit).copyTo(a(lit));
            noisy(random, level, 1.7, 0.02)(lit).copyTo(b(lit));
            estimator.add(a, b);
        }
        EXPECT_GT(estimator.estimate().variance(level), 0.9) << level;
        if (level >= 8) {
            EXPECT_NEAR(estimator.estimate().variance(level), 1.8 + 0.02 * level, 0.25) << level;
        }
    }
}

TEST(ImageNoise, LedsThatBlinkInADarkRoomDoNotCount) {
    Random random(4, "leds");
    ImageNoiseEstimator estimator;
    for (int i = 0; i < 6; ++i) {
        cv::Mat a = noisy(random, 10, 1.7, 0);
        cv::Mat b = noisy(random, 10, 1.7, 0);
        // All that is bright of either blinks in two of three steps.
        for (int x = 0; x < 300; x += 4)
            for (int y = 4; y < 60; y += 8) {
                const int change = i % 3 == 0 ? 0 : 20 + x / 10;
                a.at<unsigned char>(y, x + 2) += static_cast<unsigned char>(30);
                a.at<unsigned char>(y, x + 3) += static_cast<unsigned char>(25);
                b.at<unsigned char>(y, x + 2) += static_cast<unsigned char>(30 + change);
                b.at<unsigned char>(y, x + 3) += static_cast<unsigned char>(25 + change / 2);
            }
        estimator.add(a, b);
    }
    EXPECT_NEAR(estimator.estimate().variance(40), 1.8, 0.8);
}

TEST(ImageNoise, LampThatFlickersDoesNotCount) {
    Random random(3, "lamp");
    ImageNoiseEstimator estimator;
    for (int i = 0; i < 6; ++i)
        estimator.add(noisy(random, 40, 2.5, 0), noisy(random, 65, 2.5, 0));
    EXPECT_NEAR(estimator.estimate().variance(100), 2.6, 0.4);
}

TEST(ImageNoise, OneBrightnessGivesNoSlope) {
    ImageNoiseEstimator estimator;
    EXPECT_GT(estimator.estimate().variance(0), 0);  // nothing seen yet
    const cv::Mat flat(240, 320, CV_8U, cv::Scalar(90));
    estimator.add(flat, flat);
    const ImageNoise noise = estimator.estimate();
    EXPECT_EQ(noise.gain, 0);
    EXPECT_GE(noise.read, 1.0 / 12);
}

TEST(ImageNoise, ClippedPicturesTellNothing) {
    ImageNoiseEstimator estimator;
    const cv::Mat white(240, 320, CV_8U, cv::Scalar(255));
    estimator.add(white, white);
    EXPECT_EQ(estimator.estimate().read, ImageNoise{}.read);
}

SpotFinder finderOf(const ScanPainter& scan) {
    SpotFinder finder;
    for (std::size_t k = 0; k < scan.frames.size(); ++k)
        finder.add(*FramePixels::make(scan.paint(k), "", {}, false), false);
    return finder;
}

TEST(SpotFinder, EveryLedIsACandidateAndHardlyAnythingElse) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Random random(seed, "spots");
        ScanPainter scan;
        scan.seed = seed;
        scan.leds = scatterLeds(random, 15, scan.size);
        for (PaintedLed& led : scan.leds)
            led.peak = random.uniform(25, 600);
        scan.frames = oneAtATime(scan.leds);
        const auto candidates = finderOf(scan).candidates(1000);
        for (const PaintedLed& led : scan.leds) {
            EXPECT_TRUE(std::any_of(candidates.begin(), candidates.end(), [&](const SpotCandidate& c) {
                return (Vector2d(c.x, c.y) - led.pixel).norm() < 2;
            })) << led.peak;
        }
        EXPECT_LE(candidates.size(), 60U);
        EXPECT_TRUE(std::is_sorted(candidates.begin(), candidates.end(),
                                   [](const auto& a, const auto& b) { return a.contrast > b.contrast; }));
        EXPECT_EQ(finderOf(scan).candidates(4).size(), 4U);
    }
}

TEST(SpotFinder, NoiseHasFewCandidates) {
    Random random(5, "nothing");
    ScanPainter scan;
    scan.leds = scatterLeds(random, 15, scan.size);
    for (PaintedLed& led : scan.leds)
        led.peak = 0;
    scan.frames = oneAtATime(scan.leds);
    scan.readNoise = 3;
    EXPECT_LE(finderOf(scan).candidates(1000).size(), 5U);
}

TEST(SpotFinder, NothingSeenNothingFound) {
    EXPECT_TRUE(SpotFinder().candidates(10).empty());
}

TEST(SpotFinder, BadOptionsThrow) {
    SpotCandidateOptions options;
    options.surroundings_px = 4;
    EXPECT_THROW(SpotFinder{options}, std::logic_error);
    options = {};
    options.minContrast = 0;
    EXPECT_THROW(SpotFinder{options}, std::logic_error);
}

}  // namespace
}  // namespace skincal::testing
