#include "core/simulation/renderer.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace skincal {
namespace {

World worldWith(const std::function<void(Scenario&)>& change) {
    Scenario scenario = *findScenario("coded");
    change(scenario);
    return buildWorld(scenario, 4);
}

std::vector<LitModule> allOf(const World& world) {
    std::vector<LitModule> lit;
    for (const SkinModule& module : world.skin.modules)
        lit.push_back({module.id, std::nullopt});
    return lit;
}

double difference(const cv::Mat& a, const cv::Mat& b) {
    return cv::norm(a, b, cv::NORM_L1) / static_cast<double>(a.total());
}

TEST(Renderer, SameSeedSameBytesInAnyOrder) {
    const World world = buildWorld(*findScenario("coded"), 9);
    const FrameRenderer forward(world, 0, 10);
    const FrameRenderer backward(world, 0, 10);
    const cv::Mat a0 = forward.render({}, 0);
    const cv::Mat a5 = forward.render(allOf(world), 5);
    const cv::Mat b5 = backward.render(allOf(world), 5);
    const cv::Mat b0 = backward.render({}, 0);
    EXPECT_EQ(difference(a0, b0), 0);
    EXPECT_EQ(difference(a5, b5), 0);
    EXPECT_GT(difference(a0, FrameRenderer(buildWorld(*findScenario("coded"), 10), 0, 10).render({}, 0)), 1);
}

TEST(Renderer, NoiseDiffersFromFrameToFrameAndHasTheRightSize) {
    const World world = worldWith([](Scenario& s) {
        s.pictures.texture = 0;
        s.pictures.shotNoise = 0;
        s.pictures.readNoise = 2;
    });
    const FrameRenderer renderer(world, 0, 10);
    cv::Mat d;
    cv::subtract(renderer.render({}, 0), renderer.render({}, 1), d, cv::noArray(), CV_32F);
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(d, mean, deviation);
    EXPECT_NEAR(mean[0], 0, 0.02);
    EXPECT_NEAR(deviation[0], 2 * std::sqrt(2.0), 0.15);  // rounding adds 1/12
}

TEST(Renderer, SpotsAreCentredWhereTheLedProjects) {
    const World world = worldWith([](Scenario& s) {
        s.pictures.readNoise = s.pictures.shotNoise = 0;
        s.pictures.texture = 0;
        s.pictures.ledPeak = 120;
        s.pictures.halo = 0;
    });
    const FrameRenderer renderer(world, 0, 10);
    const cv::Mat off = renderer.render({}, 0);
    int checked = 0;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        const auto pixel = visiblePixel(world, 0, u);
        if (!pixel)
            continue;
        cv::Mat d;
        cv::subtract(renderer.render({{world.skin.modules[u].id, std::nullopt}}, 0), off, d, cv::noArray(), CV_32F);
        const cv::Moments m = [&] {
            const cv::Rect box(cvRound(pixel->x()) - 6, cvRound(pixel->y()) - 6, 13, 13);
            cv::Moments sums;
            for (int y = 0; y < box.height; ++y) {
                for (int x = 0; x < box.width; ++x) {
                    const double v = static_cast<double>(d.at<float>(box.y + y, box.x + x));
                    sums.m00 += v;
                    sums.m10 += v * (box.x + x);
                    sums.m01 += v * (box.y + y);
                }
            }
            return sums;
        }();
        EXPECT_NEAR(m.m10 / m.m00, pixel->x(), 0.03);  // grey levels are whole numbers
        EXPECT_NEAR(m.m01 / m.m00, pixel->y(), 0.03);
        ++checked;
    }
    EXPECT_GT(checked, 5);
}

TEST(Renderer, AnLedHasHalfItsLightAtHalfItsLobe) {
    EXPECT_NEAR(ledLobe(0, 120 * kDegree), 1, 1e-12);
    EXPECT_NEAR(ledLobe(60 * kDegree, 120 * kDegree), 0.5, 1e-12);
    EXPECT_EQ(ledLobe(100 * kDegree, 120 * kDegree), 0);
}

TEST(Renderer, ColoursShowInTheirChannels) {
    const World world = buildWorld(*findScenario("coloured"), 2);
    const FrameRenderer renderer(world, 0, 10);
    std::size_t u = 0;
    while (!visiblePixel(world, 0, u))
        ++u;
    const cv::Mat picture = renderer.render({{world.skin.modules[u].id, std::array<int, 3>{1, 0, 0}}}, 1);
    ASSERT_EQ(picture.channels(), 3);
    const auto pixel = *visiblePixel(world, 0, u);
    const cv::Vec3b c = picture.at<cv::Vec3b>(cvRound(pixel.y()), cvRound(pixel.x()));
    EXPECT_GT(c[2], c[0] + 50);
    EXPECT_GT(c[2], c[1] + 50);
}

TEST(Renderer, EachDisturbanceChangesThePictureAsItSays) {
    const auto framesOf = [](const World& world, std::size_t view) {
        const FrameRenderer renderer(world, view, 10);
        std::vector<cv::Mat> frames;
        for (std::size_t k = 0; k < 10; ++k)
            frames.push_back(renderer.render(allOf(world), k));
        return frames;
    };
    const auto calm = framesOf(worldWith([](Scenario&) {}), 1);
    const auto flicker = framesOf(worldWith([](Scenario& s) { s.disturbances.flicker = 25; }), 1);
    const auto person = framesOf(worldWith([](Scenario& s) { s.disturbances.person = true; }), 1);
    const auto bumped = framesOf(worldWith([](Scenario& s) { s.disturbances.bump_px = 8; }), 1);
    const auto mirror = framesOf(worldWith([](Scenario& s) { s.disturbances.reflection = 0.4; }), 1);
    const auto lampSide = [](const cv::Mat& picture) { return cv::mean(picture(cv::Rect(0, 0, 600, 300)))[0]; };
    double swing = 0;
    for (const cv::Mat& frame : flicker)
        swing = std::max(swing, std::abs(lampSide(frame) - lampSide(calm[0])));
    EXPECT_GT(swing, 10);
    EXPECT_GT(difference(person[3], person[6]), 2 * difference(calm[3], calm[6]));
    EXPECT_EQ(difference(bumped[0], calm[0]), 0) << "the first half is as it was";
    EXPECT_GT(difference(bumped[9], calm[9]), 0);
    EXPECT_GT(difference(mirror[0], calm[0]), 0);
}

TEST(Renderer, AnOccluderHidesLeds) {
    const World world = worldWith([](Scenario& s) { s.disturbances.occluder = true; });
    const World open = worldWith([](Scenario&) {});
    std::size_t hidden = 0;
    for (std::size_t v = 0; v < world.T_r_v.size(); ++v) {
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
            hidden += visiblePixel(open, v, u) && !visiblePixel(world, v, u) ? 1U : 0U;
    }
    EXPECT_GT(hidden, 0U);
}

}  // namespace
}  // namespace skincal
