#include "core/vision/picture_figures.h"

#include <gtest/gtest.h>

#include <numeric>
#include <opencv2/imgproc.hpp>

#include "core/geometry/random.h"

namespace skincal {
namespace {

/// Rectangles of random brightness, sharp-edged.
cv::Mat randomScene(std::uint64_t seed, cv::Size size) {
    Random random(seed, "picture figures");
    cv::Mat picture(size, CV_8UC1, cv::Scalar(90));
    for (int i = 0; i < 200; ++i) {
        const auto x = static_cast<int>(random.index(static_cast<std::size_t>(size.width)));
        const auto y = static_cast<int>(random.index(static_cast<std::size_t>(size.height)));
        cv::rectangle(picture, cv::Rect(x, y, 40, 30), cv::Scalar(random.uniform(20, 200)), cv::FILLED);
    }
    return picture;
}

TEST(PictureFigures, TheHistogramCountsEachPixelThatWasLookedAt) {
    const cv::Mat small = randomScene(1, {320, 200});
    const PictureFigures all = figuresOf(small);
    EXPECT_EQ(all.pixels, 320U * 200U) << "small pictures are looked at in full";
    EXPECT_EQ(all.histogram[90], static_cast<std::uint32_t>(cv::countNonZero(small == 90)));
    const PictureFigures some = figuresOf(randomScene(1, {1280, 720}));
    EXPECT_EQ(std::accumulate(some.histogram.begin(), some.histogram.end(), 0U), some.pixels);
    EXPECT_GT(some.pixels, 90'000U);
    EXPECT_LT(some.pixels, 110'000U);
}

TEST(PictureFigures, ClippedSharesAreThoseOfThePicture) {
    Random random(2, "clipped");
    for (int trial = 0; trial < 10; ++trial) {
        cv::Mat picture(720, 1280, CV_8UC1, cv::Scalar(100));
        const int dark = static_cast<int>(random.index(500));
        const int bright = static_cast<int>(random.index(500));
        picture.colRange(0, dark).setTo(0);
        picture.colRange(1280 - bright, 1280).setTo(255);
        const PictureFigures figures = figuresOf(picture);
        EXPECT_NEAR(figures.dark, dark / 1280.0, 0.005);
        EXPECT_NEAR(figures.bright, bright / 1280.0, 0.005);
    }
}

TEST(PictureFigures, OneClippedColourIsEnoughForBrightAndNotForDark) {
    const cv::Mat red(100, 100, CV_8UC3, cv::Scalar(0, 0, 255));
    EXPECT_EQ(figuresOf(red).bright, 1);
    EXPECT_EQ(figuresOf(red).dark, 0);
    const cv::Mat black(100, 100, CV_8UC4, cv::Scalar(0, 0, 0, 255));
    EXPECT_EQ(figuresOf(black).bright, 0) << "transparency is no colour";
    EXPECT_EQ(figuresOf(black).dark, 1);
}

TEST(PictureFigures, GreyAndColourPicturesOfOneSceneAgree) {
    const cv::Mat grey = randomScene(3, {640, 480});
    cv::Mat colour;
    cv::cvtColor(grey, colour, cv::COLOR_GRAY2BGR);
    EXPECT_EQ(figuresOf(grey).histogram, figuresOf(colour).histogram);
    EXPECT_EQ(figuresOf(grey).sharpness, figuresOf(colour).sharpness);
}

TEST(PictureFigures, SharpnessFallsWithBlurAndNotWithExposure) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        const cv::Mat sharp = randomScene(seed, {1280, 720});
        double last = figuresOf(sharp).sharpness;
        cv::Mat darker;
        sharp.convertTo(darker, CV_8U, 0.5);
        EXPECT_NEAR(figuresOf(darker).sharpness / last, 1, 0.05);
        for (const double sigma : {0.5, 1.0, 2.0, 4.0}) {
            cv::Mat blurred;
            cv::GaussianBlur(sharp, blurred, {}, sigma);
            const double sharpness = figuresOf(blurred).sharpness;
            EXPECT_LT(sharpness, 0.8 * last) << sigma;
            last = sharpness;
        }
    }
}

TEST(PictureFigures, FlatAndEmptyPicturesHaveNoSharpness) {
    EXPECT_EQ(figuresOf(cv::Mat(50, 50, CV_8UC1, cv::Scalar(7))).sharpness, 0);
    EXPECT_EQ(figuresOf(cv::Mat()).pixels, 0U);
    EXPECT_EQ(figuresOf(cv::Mat(1, 1, CV_8UC1, cv::Scalar(7))).pixels, 1U);
}

TEST(PictureFigures, OtherKindsOfPicturesAreRefused) {
    EXPECT_THROW((void)figuresOf(cv::Mat(5, 5, CV_16UC1, cv::Scalar(7))), std::logic_error);
    EXPECT_THROW((void)figuresOf(cv::Mat(5, 5, CV_8UC2, cv::Scalar(7))), std::logic_error);
}

}  // namespace
}  // namespace skincal
