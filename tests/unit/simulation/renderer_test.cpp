#include "core/simulation/renderer.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "core/simulation/mirror.h"
#include "core/simulation/scene.h"

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

TEST(Renderer, ACameraMovedThereSeesWhatOneMadeThereSees) {
    for (const char* name : {"coded", "occluder", "bumped-camera", "reflection"}) {
        const World world = buildWorld(*findScenario(name), 3);
        FrameRenderer moved(world, world.T_r_v[0], 1, 10);
        moved.moveCamera(world.T_r_v[1]);
        const FrameRenderer there(world, world.T_r_v[1], 1, 10);
        const FrameRenderer ofView(world, 1, 10);
        for (const std::size_t frame : {0U, 7U}) {
            const cv::Mat picture = ofView.render(allOf(world), frame);
            EXPECT_EQ(difference(picture, there.render(allOf(world), frame)), 0) << name;
            EXPECT_EQ(difference(picture, moved.render(allOf(world), frame)), 0) << name;
        }
    }
}

TEST(Renderer, TheRoomMovesAsTheCameraTurns) {
    const World world = worldWith([](Scenario& s) { s.pictures.readNoise = s.pictures.shotNoise = 0; });
    const CameraModel& camera = world.scenario.camera;
    FrameRenderer renderer(world, 0, 10);
    const cv::Mat before = renderer.render({}, 0);
    const Vector3d turn(0.8 * kDegree, -0.6 * kDegree, 0);
    const Isometry3d& T_r_v = world.T_r_v[0];
    renderer.moveCamera(makeIsometry(T_r_v.linear() * so3Exp(turn), T_r_v.translation()));
    const cv::Mat after = renderer.render({}, 0);
    // The wall above the body, and everything.
    for (const cv::Rect& part : {cv::Rect(0, 0, 1280, 160), cv::Rect(0, 0, 1280, 720)}) {
        cv::Mat a;
        cv::Mat b;
        before(part).convertTo(a, CV_32F);
        after(part).convertTo(b, CV_32F);
        cv::Mat window;
        cv::createHanningWindow(window, part.size(), CV_32F);
        const cv::Point2d shift = cv::phaseCorrelate(a, b, window);
        EXPECT_NEAR(shift.x, -camera.fx * turn.y(), 1.5);
        EXPECT_NEAR(shift.y, camera.fy * turn.x(), 1.5);
    }
    renderer.moveCamera(makeIsometry(T_r_v.linear() * so3Exp({0, 3, 0}), T_r_v.translation()));
    EXPECT_GT(cv::mean(renderer.render({}, 0))[0], 20) << "there is a room behind the room";
}

TEST(Renderer, LightGrowsWithExposureAndClips) {
    const World world = worldWith([](Scenario& s) { s.pictures.readNoise = s.pictures.shotNoise = 0; });
    const FrameRenderer renderer(world, 0, 10);
    const cv::Mat usual = renderer.render(allOf(world), 0);
    const cv::Mat half = renderer.render(allOf(world), 0, false, 0.5);
    const cv::Mat fourfold = renderer.render(allOf(world), 0, false, 4);
    for (int y = 0; y < usual.rows; ++y) {
        for (int x = 0; x < usual.cols; ++x) {
            const int level = usual.at<unsigned char>(y, x);
            if (level < 255) {
                ASSERT_NEAR(half.at<unsigned char>(y, x), 0.5 * level, 1);
            }
            ASSERT_NEAR(fourfold.at<unsigned char>(y, x), std::min(255, 4 * level), 2.5);
        }
    }
    EXPECT_GT(cv::countNonZero(fourfold == 255), cv::countNonZero(usual == 255));
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
    EXPECT_GT(difference(person[3], person[6]), 1.3 * difference(calm[3], calm[6]));
    EXPECT_EQ(difference(bumped[0], calm[0]), 0) << "the first half is as it was";
    EXPECT_GT(difference(bumped[9], calm[9]), 0);
    EXPECT_GT(difference(mirror[0], calm[0]), 0);
}

TEST(Renderer, AMirrorShowsLedsThatTheCameraDoesNotSee) {
    const World world = worldWith([](Scenario& s) {
        s.disturbances.reflection = 0.5;
        s.disturbances.occluder = true;
        s.views.count = 8;
        s.patches[1].T_r_s.linear() = Eigen::AngleAxisd(90 * kDegree, Vector3d::UnitX()).toRotationMatrix();
    });
    const double edge = mirrorEdge(world.scenario.camera);
    std::size_t both = 0;
    std::size_t alone = 0;
    for (std::size_t v = 0; v < world.T_r_v.size(); ++v) {
        const FrameRenderer renderer(world, v, 10);
        const Mirror mirror(world, world.T_r_v[v]);
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
            const LedSpot& image = renderer.images()[u];
            if (image.peak <= 0)
                continue;
            const LedSpot& spot = renderer.spots()[u];
            (spot.peak > 0 ? both : alone) += 1;
            // As of an LED that faces its reflected camera and is as far from it.
            const Vector3d led_r = world.T_r_u[u] * world.trueTemplate(u).led;
            const Vector3d ray = mirror.image() - led_r;
            EXPECT_GT(ray.normalized().dot(world.T_r_u[u].linear().col(2)), 0);
            EXPECT_LT(image.peak, 0.5 * world.scenario.pictures.ledPeak * std::pow(0.6 / ray.norm(), 2) + 1e-9);
            EXPECT_GT(image.pixel.y(), edge);
            if (spot.peak > 0) {
                EXPECT_NEAR(image.pixel.x(), spot.pixel.x(), 60);
                EXPECT_NEAR(image.pixel.y() + spot.pixel.y(), 2 * edge, 120);
            }
        }
    }
    EXPECT_GT(both, 10U);
    EXPECT_GT(alone, 5U);
}

cv::Mat ledLight(const FrameRenderer& renderer, const World& world, std::size_t frame) {
    cv::Mat light;
    cv::subtract(renderer.render(allOf(world), frame), renderer.render({}, frame), light, cv::noArray(), CV_32F);
    return light;
}

TEST(Renderer, WhoStandsInFrontHidesLedsWithASoftEdge) {
    const auto still = [](Scenario& s) { s.pictures.readNoise = s.pictures.shotNoise = 0; };
    const World open = worldWith(still);
    const World passed = worldWith([&](Scenario& s) {
        still(s);
        s.disturbances.person = true;
    });
    constexpr std::size_t kFrames = 50;
    const FrameRenderer alone(open, 0, kFrames);
    const FrameRenderer crowded(passed, 0, kFrames);
    int hidden = 0;
    int shown = 0;
    for (std::size_t frame = 0; frame < kFrames; ++frame) {
        const cv::Mat free = ledLight(alone, open, frame);
        const cv::Mat seen = ledLight(crowded, passed, frame);
        for (std::size_t u = 0; u < open.T_r_u.size(); ++u) {
            const auto pixel = visiblePixel(open, 0, u);
            if (!pixel)
                continue;
            const cv::Point place(cvRound(pixel->x()), cvRound(pixel->y()));
            ASSERT_GT(free.at<float>(place), 50);
            hidden += seen.at<float>(place) < 1 ? 1 : 0;
            shown += seen.at<float>(place) == free.at<float>(place) ? 1 : 0;
        }
    }
    EXPECT_GT(hidden, 10) << "he walks past both patches";
    EXPECT_GT(shown, hidden) << "and hides little of it at a time";

    const Person person = paintPerson(open.scenario.camera, open.scenario.pictures);
    EXPECT_GT(cv::countNonZero(person.cover > 0.999), 10000);
    EXPECT_GT(cv::countNonZero((person.cover > 0.2) & (person.cover < 0.8)), 1000);
}

TEST(Renderer, AKnockShiftsTheWholePictureAsItShiftsTheLeds) {
    constexpr double kBump = 8;
    const World world = worldWith([](Scenario& s) {
        s.pictures.readNoise = s.pictures.shotNoise = 0;
        s.disturbances.bump_px = kBump;
    });
    const FrameRenderer renderer(world, 1, 10);
    cv::Mat before;
    cv::Mat after;
    renderer.render({}, 0).convertTo(before, CV_32F);
    renderer.render({}, 9).convertTo(after, CV_32F);
    cv::Mat window;
    cv::createHanningWindow(window, before.size(), CV_32F);
    const cv::Point2d scene = cv::phaseCorrelate(before, after, window);
    EXPECT_NEAR(std::hypot(scene.x, scene.y), kBump, 1);

    const cv::Mat first = ledLight(renderer, world, 0);
    const cv::Mat last = ledLight(renderer, world, 9);
    const cv::Moments a = cv::moments(first);
    const cv::Moments b = cv::moments(last);
    // The knock also rolls the camera a little, and LEDs are not all in the middle.
    EXPECT_NEAR(b.m10 / b.m00 - a.m10 / a.m00, scene.x, 1);
    EXPECT_NEAR(b.m01 / b.m00 - a.m01 / a.m00, scene.y, 1);
    EXPECT_EQ(difference(FrameRenderer(world, 0, 10).render({}, 0), FrameRenderer(world, 0, 10).render({}, 9)), 0)
        << "every second view only";
}

TEST(Renderer, BoardsShowWhereTheirLedsAre) {
    const World world = worldWith([](Scenario& s) { s.pictures.readNoise = s.pictures.shotNoise = 0; });
    const cv::Mat picture = FrameRenderer(world, 0, 10).render({}, 0);
    int brighter = 0;
    int all = 0;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        const auto pixel = visiblePixel(world, 0, u);
        if (!pixel)
            continue;
        // The LED's housing is brighter than the board round it.
        const cv::Point led(cvRound(pixel->x()), cvRound(pixel->y()));
        const cv::Mat round = picture(cv::Rect(led.x - 6, led.y - 6, 13, 13));
        brighter += picture.at<unsigned char>(led) > cv::mean(round)[0] + 3 ? 1 : 0;
        ++all;
    }
    EXPECT_GT(all, 5);
    EXPECT_EQ(brighter, all);
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
