#include "core/vision/local_contrast.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "tests/unit/vision/scan_painter.h"

namespace skincal::testing {
namespace {

cv::Mat toPlane(const cv::Mat& light) {
    cv::Mat plane;
    light.convertTo(plane, CV_8U);
    return plane;
}

double largest(const cv::Mat& contrast) {
    double least = 0;
    double most = 0;
    cv::minMaxLoc(contrast, &least, &most);
    return std::max(-least, most) / kContrastUnits;
}

TEST(LocalContrast, EvenAndSlopingLightLeavesNothing) {
    cv::Mat slope(121, 161, CV_32F);
    for (int y = 0; y < slope.rows; ++y) {
        for (int x = 0; x < slope.cols; ++x)
            slope.at<float>(y, x) = static_cast<float>(10 + x + 0.5 * y);
    }
    EXPECT_LT(largest(localContrast(cv::Mat(121, 161, CV_8U, cv::Scalar(255)), 0.6, 7)), 0.05);
    const cv::Mat contrast = localContrast(toPlane(slope), 0.6, 7);
    ASSERT_EQ(contrast.size(), cv::Size(80, 60));
    EXPECT_LT(largest(contrast(cv::Rect(4, 4, 72, 52))), 0.5);
}

TEST(LocalContrast, ASpotStandsOutWhereItIsWhateverIsAddedToAll) {
    Random random(1, "local contrast");
    for (int i = 0; i < 30; ++i) {
        const Vector2d at(random.uniform(20, 140), random.uniform(20, 100));
        cv::Mat light(120, 160, CV_32F, cv::Scalar(random.uniform(0, 60)));
        addSpot(light, at, 150, 1.2);
        const cv::Mat contrast = localContrast(toPlane(light), random.uniform(0.3, 1.5), 7);
        cv::Point place;
        double most = 0;
        cv::minMaxLoc(contrast, nullptr, &most, nullptr, &place);
        // Pixel 0 of the half-size picture lies between pixels 0 and 1.
        EXPECT_LE((Vector2d(2 * place.x + 0.5, 2 * place.y + 0.5) - at).norm(), 1.6);
        EXPECT_GT(most / kContrastUnits, 5);
        cv::Mat brighter = toPlane(light) + 40;
        EXPECT_LE(cv::norm(localContrast(brighter, 0.6, 7), localContrast(toPlane(light), 0.6, 7), cv::NORM_INF), 2);
    }
}

TEST(LocalContrast, BrightestPicturesDoNotOverflow) {
    cv::Mat plane(40, 40, CV_8U, cv::Scalar(0));
    plane(cv::Rect(16, 16, 8, 8)) = 255;
    for (const double smoothing : {0.2, 0.6, 1.0, 3.0}) {
        const cv::Mat contrast = localContrast(plane, smoothing, 15);
        EXPECT_GT(contrast.at<std::int16_t>(10, 10), 0) << smoothing;
        EXPECT_LE(largest(contrast), 255) << smoothing;
    }
}

}  // namespace
}  // namespace skincal::testing
