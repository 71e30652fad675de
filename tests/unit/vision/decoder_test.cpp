#include "core/vision/decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "tests/unit/vision/decoded.h"

namespace skincal::testing {
namespace {

using ::testing::HasSubstr;

enum class Scheme { OneAtATime, Coded };

class AnyScheme : public ::testing::TestWithParam<Scheme> {
  protected:
    static ScanPainter scanOf(std::uint64_t seed, std::size_t leds) {
        Random random(seed, "scan");
        ScanPainter scan;
        scan.seed = seed;
        scan.leds = scatterLeds(random, leds, scan.size);
        reframe(scan);
        return scan;
    }
    static void reframe(ScanPainter& scan) {
        Random random(scan.seed, "words");
        scan.frames = GetParam() == Scheme::OneAtATime ? oneAtATime(scan.leds) : coded(scan.leds, random);
    }
};

TEST_P(AnyScheme, FindsAllWhereTheyAre) {
    double squared = 0;
    double normalised = 0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const ScanPainter scan = scanOf(seed, 14);
        const ViewDetections view = decode(scan);
        EXPECT_EQ(view.name, "view");
        EXPECT_EQ(expectNoneWrong(scan, view), scan.leds.size()) << "seed " << seed;
        for (const LedDetection& found : view.found) {
            for (const PaintedLed& led : scan.leds) {
                if (led.module != found.module)
                    continue;
                const double error = (found.pixel - led.pixel).squaredNorm();
                squared += error / 2;
                normalised += error / 2 / (found.sigma_px * found.sigma_px);
                ++count;
            }
        }
    }
    EXPECT_LT(std::sqrt(squared / count), 0.03);
    EXPECT_GT(normalised / count, 0.6);
    EXPECT_LT(normalised / count, 1.5);
}

TEST_P(AnyScheme, ASpotFarWiderThanAllOthersIsNoLed) {
    ScanPainter scan = scanOf(5, 12);
    const PaintedLed wide = scan.leds.front();
    scan.leds.front().peak = 0;
    scan.disturb = [&](cv::Mat& light, std::size_t k) {
        for (const LitModule& lit : scan.frames[k].lit) {
            if (lit.module == wide.module)
                addSpot(light, wide.pixel, 100, 2.6 * scan.width_px);
        }
    };
    const ViewDetections view = decode(scan);
    EXPECT_EQ(expectNoneWrong(scan, view), scan.leds.size() - 1);
    const Undetected* reason = missing(view, wide.module);
    ASSERT_NE(reason, nullptr);
    EXPECT_THAT(reason->reason, HasSubstr("shape"));
    EXPECT_EQ(reason->cause, Undetected::Cause::NotAnLed);
}

TEST_P(AnyScheme, BrightGroundUnderLedsIsNoShorterExposure) {
    ScanPainter scan = scanOf(6, 14);
    for (PaintedLed& led : scan.leds)
        led.peak = 40;
    scan.disturb = [&](cv::Mat& light, std::size_t) {
        for (const PaintedLed& led : scan.leds)
            addSpot(light, led.pixel, 60, 1.8);
    };
    EXPECT_EQ(expectNoneWrong(scan, decode(scan)), scan.leds.size());
}

TEST_P(AnyScheme, FindsFaintLeds) {
    std::size_t found = 0;
    std::size_t all = 0;
    for (std::uint64_t seed = 5; seed <= 8; ++seed) {
        ScanPainter scan = scanOf(seed, 14);
        for (PaintedLed& led : scan.leds)
            led.peak = 30;
        found += expectNoneWrong(scan, decode(scan), 0.25);
        all += scan.leds.size();
    }
    // One at a time, noise in another module's only lit frame can come near enough to cast doubt.
    EXPECT_GE(found, GetParam() == Scheme::Coded ? all : all * 98 / 100);
}

TEST_P(AnyScheme, WhatIsLostInNoiseIsTooWeakOrOutOfSight) {
    using Cause = Undetected::Cause;
    std::size_t weak = 0;
    std::size_t lost = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        ScanPainter scan = scanOf(seed, 12);
        scan.readNoise = 6;
        for (PaintedLed& led : scan.leds)
            led.peak = 25;
        for (const Undetected& u : decode(scan).undetected) {
            EXPECT_THAT(u.cause, ::testing::AnyOf(Cause::TooWeak, Cause::OutOfSight, Cause::Alike)) << u.reason;
            weak += u.cause == Cause::TooWeak ? 1 : 0;
            ++lost;
        }
    }
    // Lit once, they nearly drown; what blinks all the time is found or far below what is looked at.
    if (GetParam() == Scheme::OneAtATime) {
        EXPECT_GT(lost, 10U);
        EXPECT_GT(weak, 0U);
    }
}

TEST_P(AnyScheme, FindsBrightClippedLeds) {
    ScanPainter scan = scanOf(11, 12);
    for (PaintedLed& led : scan.leds)
        led.peak = 900;
    const ViewDetections view = decode(scan);
    EXPECT_EQ(expectNoneWrong(scan, view, 0.1), scan.leds.size());
}

TEST_P(AnyScheme, FindsLedsInTheDark) {
    // Black level: dark pixels without noise of their own must not make faint light certain.
    ScanPainter scan = scanOf(12, 12);
    scan.disturb = [](cv::Mat& light, std::size_t) { light -= 75; };
    const ViewDetections view = decode(scan);
    EXPECT_EQ(expectNoneWrong(scan, view, 0.2), scan.leds.size());
}

TEST_P(AnyScheme, MissesOnlyCoveredModules) {
    for (std::uint64_t seed = 21; seed <= 23; ++seed) {
        ScanPainter scan = scanOf(seed, 14);
        for (const std::size_t covered : {2U, 5U, 11U})
            scan.leds[covered].peak = 0;
        const ViewDetections view = decode(scan);
        EXPECT_EQ(expectNoneWrong(scan, view), 11U);
        for (const std::size_t covered : {2U, 5U, 11U}) {
            const Undetected* u = missing(view, scan.leds[covered].module);
            ASSERT_NE(u, nullptr);
            EXPECT_EQ(u->verdict, DetectionVerdict::NotFound);
            EXPECT_EQ(u->cause, Undetected::Cause::OutOfSight);
        }
    }
}

TEST_P(AnyScheme, FindsNothingInNoise) {
    for (std::uint64_t seed = 31; seed <= 33; ++seed) {
        ScanPainter scan = scanOf(seed, 14);
        for (PaintedLed& led : scan.leds)
            led.peak = 0;
        scan.readNoise = 1 + 2 * static_cast<double>(seed - 31);
        EXPECT_TRUE(decode(scan).found.empty());
    }
}

TEST_P(AnyScheme, LampThatFlickersIsNoMatter) {
    ScanPainter scan = scanOf(41, 14);
    Random random(41, "lamp");
    std::vector<double> lamp;
    for (std::size_t k = 0; k < scan.frames.size(); ++k)
        lamp.push_back(random.uniform(0, 25));
    scan.disturb = [lamp](cv::Mat& light, std::size_t k) {
        for (int y = 0; y < light.rows; ++y) {
            for (int x = 0; x < light.cols; ++x)
                light.at<float>(y, x) += static_cast<float>(
                    lamp[k] * std::exp(-(Vector2d(x, y) - Vector2d(200, 80)).squaredNorm() / (2 * 90 * 90)));
        }
    };
    EXPECT_EQ(expectNoneWrong(scan, decode(scan), 0.2), scan.leds.size());
}

TEST_P(AnyScheme, LampInStepWithTheFramesIsNoMatter) {
    ScanPainter scan = scanOf(43, 14);
    for (const double phase : {1.0, -1.0}) {
        scan.disturb = [phase](cv::Mat& light, std::size_t k) {
            light += cv::Scalar(phase * (k % 2 == 0 ? 15.0 : -15.0));
        };
        EXPECT_EQ(expectNoneWrong(scan, decode(scan), 0.2), scan.leds.size());
    }
}

TEST_P(AnyScheme, LightThatFadesIsNoMatter) {
    ScanPainter scan = scanOf(42, 14);
    const auto frames = static_cast<double>(scan.frames.size());
    scan.disturb = [frames](cv::Mat& light, std::size_t k) { light *= 1 - 0.25 * static_cast<double>(k) / frames; };
    EXPECT_EQ(expectNoneWrong(scan, decode(scan), 0.2), scan.leds.size());
}

TEST_P(AnyScheme, SomethingBrightThatMovesMakesNoWrongFinds) {
    std::size_t found = 0;
    std::size_t all = 0;
    for (std::uint64_t seed = 51; seed <= 56; ++seed) {
        ScanPainter scan = scanOf(seed, 14);
        const auto frames = static_cast<double>(scan.frames.size());
        scan.disturb = [frames](cv::Mat& light, std::size_t k) {
            const double way = static_cast<double>(k) / frames;
            const cv::Rect person(static_cast<int>(way * 300), 60, 30, 120);
            light(person & cv::Rect(0, 0, light.cols, light.rows)) += 80;
        };
        found += expectNoneWrong(scan, decode(scan));
        all += scan.leds.size();
    }
    // Whom it passes while the LED is lit may be lost; the others must not be.
    EXPECT_GE(found, all * 7 / 10);
}

TEST_P(AnyScheme, FaintReflectionLosesAgainstTheLed) {
    ScanPainter scan = scanOf(61, 14);
    for (const std::size_t u : {0U, 4U, 9U}) {
        PaintedLed mirrored = scan.leds[u];
        mirrored.peak *= 0.25;
        mirrored.pixel = Vector2d(20 + 30.0 * static_cast<double>(u), 228);
        scan.mirrored.push_back(mirrored);
    }
    std::erase_if(scan.leds, [](const PaintedLed& led) { return led.pixel.y() > 212; });
    reframe(scan);
    EXPECT_EQ(expectNoneWrong(scan, decode(scan)), scan.leds.size());
}

TEST_P(AnyScheme, StrongReflectionIsNotDecided) {
    ScanPainter scan = scanOf(62, 10);
    std::erase_if(scan.leds, [](const PaintedLed& led) { return led.pixel.y() > 212; });
    reframe(scan);
    PaintedLed mirrored = scan.leds[3];
    mirrored.peak *= 0.9;
    mirrored.pixel = Vector2d(160, 228);
    scan.mirrored.push_back(mirrored);
    const ViewDetections view = decode(scan);
    EXPECT_EQ(expectNoneWrong(scan, view), scan.leds.size() - 1);
    const Undetected* u = missing(view, scan.leds[3].module);
    ASSERT_NE(u, nullptr);
    EXPECT_EQ(u->verdict, DetectionVerdict::Ambiguous);
    EXPECT_THAT(u->reason, HasSubstr("two spots"));
    EXPECT_EQ(u->cause, Undetected::Cause::Reflected);
}

TEST_P(AnyScheme, ASingleSpotAmongReflectionsMayBeOne) {
    ScanPainter scan = scanOf(67, 26);
    std::erase_if(scan.leds, [](const PaintedLed& led) { return led.pixel.y() > 108; });
    ASSERT_GE(scan.leds.size(), 5U);
    reframe(scan);
    for (const PaintedLed& led : scan.leds)
        scan.mirrored.push_back({led.module, {led.pixel.x(), 232 - led.pixel.y()}, 0.3 * led.peak});
    ASSERT_EQ(expectNoneWrong(scan, decode(scan)), scan.leds.size());
    // Something hides two of them from the camera, and not from the mirror; and a third one from the mirror.
    scan.leds[0].peak = scan.leds[3].peak = scan.mirrored[1].peak = 0;
    const ViewDetections view = decode(scan);
    EXPECT_EQ(expectNoneWrong(scan, view), scan.leds.size() - 2);
    for (const std::size_t hidden : {0U, 3U}) {
        const Undetected* u = missing(view, scan.leds[hidden].module);
        ASSERT_NE(u, nullptr);
        EXPECT_EQ(u->cause, Undetected::Cause::Reflected);
        EXPECT_THAT(u->reason, HasSubstr("reflected"));
        ASSERT_EQ(u->spots.size(), 1U);
        EXPECT_LT((u->spots.front().pixel - scan.mirrored[hidden].pixel).norm(), 0.5);
    }
}

TEST_P(AnyScheme, AFurtherLookKnowsTheMirrorOfTheFirst) {
    ScanPainter scan = scanOf(67, 26);
    std::erase_if(scan.leds, [](const PaintedLed& led) { return led.pixel.y() > 108; });
    reframe(scan);
    for (const PaintedLed& led : scan.leds)
        scan.mirrored.push_back({led.module, {led.pixel.x(), 232 - led.pixel.y()}, 0.3 * led.peak});
    // The mirror shows one module that the camera does not see, and something shines in its image throughout the first
    // look. The second is of that one and of another that is not seen twice: it shows no mirror.
    scan.leds[0].peak = scan.mirrored[1].peak = 0;
    const std::size_t first = scan.frames.size();
    for (const FrameInfo& frame : std::vector(scan.frames)) {
        FrameInfo& again = scan.frames.emplace_back(frame);
        again.look = 1;
        std::erase_if(again.lit, [&](const LitModule& lit) {
            return lit.module != scan.leds[0].module && lit.module != scan.leds[1].module;
        });
    }
    scan.disturb = [&](cv::Mat& light, std::size_t k) {
        if (k < first && k % 3 == 0)
            addSpot(light, scan.mirrored[0].pixel, 200, 1.2);
    };
    const ViewDetections view = decode(scan);
    EXPECT_EQ(expectNoneWrong(scan, view), scan.leds.size() - 1);
    EXPECT_NE(missing(view, scan.leds[0].module), nullptr);
}

TEST_P(AnyScheme, ModulesThatBlinkAlikeTellOfNoMirror) {
    ScanPainter scan = scanOf(67, 26);
    std::erase_if(scan.leds, [](const PaintedLed& led) { return led.pixel.y() > 108; });
    const std::size_t own = scan.leds.size();
    reframe(scan);
    // Another limb, the same picture upside down: three of its modules are lit with three of the first.
    for (std::size_t i = 0; i < 3; ++i) {
        const PaintedLed& twin = scan.leds[i];
        scan.leds.push_back(
            {ModuleId{900 + static_cast<std::uint32_t>(i)}, {twin.pixel.x(), 232 - twin.pixel.y()}, 60});
    }
    for (FrameInfo& frame : scan.frames) {
        for (std::size_t i = 0; i < 3; ++i) {
            const bool isLit = std::any_of(frame.lit.begin(), frame.lit.end(),
                                           [&](const LitModule& lit) { return lit.module == scan.leds[i].module; });
            if (isLit)
                frame.lit.push_back({scan.leds[own + i].module});
        }
    }
    EXPECT_EQ(expectNoneWrong(scan, decode(scan)), own - 3);
}

TEST_P(AnyScheme, HandsOnAllSpotsThatMayBeTheLed) {
    for (std::uint64_t seed = 63; seed <= 68; ++seed) {
        ScanPainter scan = scanOf(seed, 10);
        std::erase_if(scan.leds, [](const PaintedLed& led) { return led.pixel.y() > 212; });
        reframe(scan);
        Random random(seed, "mirror");
        const PaintedLed& led = scan.leds[2];
        const std::size_t images = 1 + seed % 3;
        for (std::size_t i = 0; i < images; ++i) {
            PaintedLed mirrored = led;
            mirrored.peak *= random.uniform(0.5, 1.9);
            mirrored.pixel = Vector2d(60 + 60.0 * static_cast<double>(i), random.uniform(226, 230));
            scan.mirrored.push_back(mirrored);
        }
        double brightest = led.peak;
        for (const PaintedLed& mirrored : scan.mirrored)
            brightest = std::max(brightest, mirrored.peak);
        // One much fainter than the brightest is none of them.
        std::vector<PaintedLed> spots = scan.mirrored;
        spots.push_back(led);
        std::vector<Vector2d> expected;
        for (const PaintedLed& spot : spots) {
            if (spot.peak * 2.2 > brightest)
                expected.push_back(spot.pixel);
        }
        const ViewDetections view = decode(scan);
        EXPECT_EQ(expectNoneWrong(scan, view), scan.leds.size() - 1) << "seed " << seed;
        const Undetected* u = missing(view, led.module);
        ASSERT_NE(u, nullptr);
        EXPECT_EQ(u->verdict, DetectionVerdict::Ambiguous);
        EXPECT_GE(u->spots.size(), 2U);
        EXPECT_LE(u->spots.size(), images + 1);
        for (const Vector2d& place : expected) {
            const auto spot = std::find_if(u->spots.begin(), u->spots.end(), [&](const SpotChoice& choice) {
                return (choice.pixel - place).norm() < std::max(0.1, 6 * choice.sigma_px);
            });
            EXPECT_NE(spot, u->spots.end()) << "seed " << seed << ", " << place.transpose();
        }
        EXPECT_EQ(u->spots.front().strength, 1);
        for (std::size_t i = 1; i < u->spots.size(); ++i)
            EXPECT_LE(u->spots[i].strength, u->spots[i - 1].strength + 0.2);
        // What was found, was never found or has another reason leaves nothing to choose.
        for (const Undetected& other : view.undetected)
            EXPECT_EQ(other.spots.empty(), other.module != led.module);
    }
}

TEST_P(AnyScheme, HandsOnNoSpotWhereThereAreTooMany) {
    ScanPainter scan = scanOf(69, 10);
    std::erase_if(scan.leds, [](const PaintedLed& led) { return led.pixel.y() > 212; });
    reframe(scan);
    for (int i = 0; i < 4; ++i) {
        PaintedLed mirrored = scan.leds[1];
        mirrored.pixel = Vector2d(40 + 50.0 * i, 228);
        scan.mirrored.push_back(mirrored);
    }
    const Undetected* u = nullptr;
    const ViewDetections many = decode(scan);
    u = missing(many, scan.leds[1].module);
    ASSERT_NE(u, nullptr);
    EXPECT_EQ(u->verdict, DetectionVerdict::Ambiguous);
    EXPECT_EQ(u->reason, "5 spots blink its word");
    EXPECT_TRUE(u->spots.empty());
    DecoderOptions options;
    options.maxSpots = 5;
    const ViewDetections all = decode(scan, options);
    u = missing(all, scan.leds[1].module);
    ASSERT_NE(u, nullptr);
    EXPECT_EQ(u->spots.size(), 5U);
    options.maxSpots = 1;
    EXPECT_FALSE(options.validate());
}

TEST_P(AnyScheme, TwoLedsInOneSpotAreSeparatedOrRefused) {
    std::size_t found = 0;
    std::size_t all = 0;
    for (std::uint64_t seed = 71; seed <= 82; ++seed) {
        ScanPainter scan = scanOf(seed, 8);
        Random random(seed, "pair");
        // Peaks that stay clear of the end of the scale together.
        scan.leds[0].peak = random.uniform(70, 90);
        scan.leds[1].peak = random.uniform(50, 90);
        const double angle = random.uniform(0, 6.28);
        scan.leds[1].pixel = scan.leds[0].pixel + random.uniform(0.5, 6) * Vector2d(std::cos(angle), std::sin(angle));
        const ViewDetections view = decode(scan);
        found += expectNoneWrong(scan, view);
        all += scan.leds.size();
    }
    EXPECT_GE(found, all * 3 / 4);
}

TEST_P(AnyScheme, TwoBrightLedsInOneSpotMakeNoWrongFinds) {
    std::size_t others = 0;
    std::size_t ofPairs = 0;
    constexpr std::size_t kPairs = 12;
    for (std::uint64_t seed = 83; seed < 83 + kPairs; ++seed) {
        ScanPainter scan = scanOf(seed, 8);
        Random random(seed, "pair");
        scan.leds[0].peak = random.uniform(200, 600);
        scan.leds[1].peak = random.uniform(100, 600);
        const double angle = random.uniform(0, 6.28);
        scan.leds[1].pixel = scan.leds[0].pixel + random.uniform(0.5, 8) * Vector2d(std::cos(angle), std::sin(angle));
        const ViewDetections view = decode(scan);
        const std::size_t found = expectNoneWrong(scan, view);
        std::size_t refused = 0;
        for (const std::size_t u : {0U, 1U})
            refused += missing(view, scan.leds[u].module) != nullptr ? 1 : 0;
        ofPairs += 2 - refused;
        others += found - (2 - refused);
    }
    EXPECT_EQ(others, 6 * kPairs) << "who stands apart is none of their business";
    EXPECT_GE(ofPairs, 4U) << "of those that lie farther apart";
}

TEST_P(AnyScheme, DisturbedFrameCostsNoWrongFinds) {
    // A flash of light right on some LEDs, in one frame.
    std::size_t found = 0;
    std::size_t all = 0;
    for (std::uint64_t seed = 101; seed <= 106; ++seed) {
        ScanPainter scan = scanOf(seed, 12);
        const std::size_t at = 1 + seed % (scan.frames.size() - 1);
        const auto leds = scan.leds;
        scan.disturb = [leds, at](cv::Mat& light, std::size_t k) {
            if (k != at)
                return;
            for (std::size_t u = 0; u < 3; ++u) {
                const Vector2d p = leds[u].pixel;
                for (int y = 0; y < light.rows; ++y) {
                    for (int x = 0; x < light.cols; ++x)
                        light.at<float>(y, x) +=
                            static_cast<float>(120 * std::exp(-(Vector2d(x, y) - p).squaredNorm() / 4));
                }
            }
        };
        found += expectNoneWrong(scan, decode(scan));
        all += leds.size();
    }
    // One at a time, a flash in the frame of another module leaves two modules equally likely.
    EXPECT_GE(found, GetParam() == Scheme::Coded ? all * 95 / 100 : all * 8 / 10);
}

TEST_P(AnyScheme, LedsAtTheBorderAreFoundOrExplained) {
    for (std::uint64_t seed = 111; seed <= 113; ++seed) {
        ScanPainter scan = scanOf(seed, 10);
        Random random(seed, "border");
        scan.leds[0].pixel = Vector2d(random.uniform(-1, 5), random.uniform(20, 220));
        scan.leds[1].pixel = Vector2d(random.uniform(20, 300), 239 - random.uniform(-1, 5));
        scan.leds[2].pixel = Vector2d(319 - random.uniform(-0.5, 1), 239 - random.uniform(-0.5, 1));
        EXPECT_GE(expectNoneWrong(scan, decode(scan)), 7U);
    }
}

TEST_P(AnyScheme, ColourPicturesOfWhiteLedsAreLikeGrey) {
    ScanPainter scan = scanOf(121, 10);
    scan.colour = true;
    for (FrameInfo& frame : scan.frames) {
        for (LitModule& lit : frame.lit)
            lit.colour = std::array{1, 1, 1};
    }
    EXPECT_EQ(expectNoneWrong(scan, decode(scan), 0.1), scan.leds.size());
}

INSTANTIATE_TEST_SUITE_P(Schemes, AnyScheme, ::testing::Values(Scheme::OneAtATime, Scheme::Coded),
                         [](const auto& scheme) { return scheme.param == Scheme::Coded ? "Coded" : "OneAtATime"; });

}  // namespace
}  // namespace skincal::testing
