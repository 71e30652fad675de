#include "core/vision/light_change.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace skincal {
namespace {

cv::Mat noisy(int seed, int type = CV_8U) {
    cv::Mat picture(60, 80, type);
    cv::RNG random(static_cast<std::uint64_t>(seed));
    random.fill(picture, cv::RNG::NORMAL, cv::Scalar::all(90), cv::Scalar::all(3));
    return picture;
}

TEST(LightChange, CountsLightThatComesAndGoesAndNoNoise) {
    for (const int type : {CV_8UC1, CV_8UC3}) {
        const cv::Mat before = noisy(1, type);
        EXPECT_EQ(lightChange(noisy(2, type), before), 0);
        cv::Mat lit = noisy(3, type);
        lit(cv::Rect(10, 10, 3, 3)) = cv::Scalar::all(190);
        const double come = lightChange(lit, before);
        EXPECT_NEAR(come, 9 * 80 * lit.channels(), 9 * 10 * lit.channels());
        EXPECT_EQ(lightChange(before, lit), -come);
        cv::Mat half = noisy(4, type);
        half(cv::Rect(10, 10, 3, 2)) = cv::Scalar::all(190);
        EXPECT_NEAR(lightChange(half, before) / come, 2.0 / 3, 0.05);
    }
}

TEST(LightChange, OfPicturesThatCannotBeComparedIsNone) {
    EXPECT_EQ(lightChange({}, noisy(1)), 0);
    EXPECT_EQ(lightChange(noisy(1), {}), 0);
    EXPECT_EQ(lightChange(noisy(1), noisy(2, CV_8UC3)), 0);
}

TEST(SamePicture, AgreesInEveryPixel) {
    const cv::Mat picture = noisy(1);
    EXPECT_TRUE(isSamePicture(picture, picture));
    cv::Mat other = picture.clone();
    EXPECT_TRUE(isSamePicture(picture, other));
    ++other.at<unsigned char>(59, 79);
    EXPECT_FALSE(isSamePicture(picture, other));
    EXPECT_FALSE(isSamePicture(picture, {}));
    EXPECT_FALSE(isSamePicture(picture, noisy(1, CV_8UC3)));
}

}  // namespace
}  // namespace skincal
