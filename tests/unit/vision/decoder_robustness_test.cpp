#include "core/vision/decoder.h"

#include <gmock/gmock.h>

#include <opencv2/core.hpp>

#include <unordered_map>

#include "tests/unit/vision/scan_painter.h"

namespace skincal::testing {
namespace {

using ::testing::HasSubstr;

ViewDetections decode(const ScanPainter& scan, const DecoderOptions& options = {}) {
    const auto view = decodeView("view", scan.modules(), scan.frames, scan.loader(), options);
    EXPECT_TRUE(view.has_value()) << (view ? "" : view.error().message);
    return view ? *view : ViewDetections{};
}

const Undetected* missing(const ViewDetections& view, ModuleId module) {
    for (const Undetected& u : view.undetected) {
        if (u.module == module)
            return &u;
    }
    return nullptr;
}

/// Nothing may be reported elsewhere than where it is; returns how many were found.
std::size_t expectNoneWrong(const ScanPainter& scan, const ViewDetections& view, double tolerance_px = 0.5) {
    EXPECT_EQ(view.found.size() + view.undetected.size(), scan.leds.size());
    std::unordered_map<ModuleId, PaintedLed> truth;
    for (const PaintedLed& led : scan.leds)
        truth.emplace(led.module, led);
    for (const LedDetection& found : view.found) {
        const PaintedLed& led = truth.at(found.module);
        EXPECT_GT(led.peak, 0) << "a covered module was found: " << found.module.value;
        EXPECT_LT((found.pixel - led.pixel).norm(), tolerance_px) << "module " << found.module.value;
        EXPECT_GT(found.sigma_px, 0);
    }
    for (const Undetected& u : view.undetected) {
        EXPECT_FALSE(u.reason.empty());
        EXPECT_NE(u.verdict, DetectionVerdict::Found);
    }
    return view.found.size();
}

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
    for (std::uint64_t seed = 83; seed <= 94; ++seed) {
        ScanPainter scan = scanOf(seed, 8);
        Random random(seed, "pair");
        scan.leds[0].peak = random.uniform(200, 600);
        scan.leds[1].peak = random.uniform(100, 600);
        const double angle = random.uniform(0, 6.28);
        scan.leds[1].pixel = scan.leds[0].pixel + random.uniform(0.5, 8) * Vector2d(std::cos(angle), std::sin(angle));
        (void)expectNoneWrong(scan, decode(scan));
    }
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

ScanPainter smallScan() {
    Random random(7, "scan");
    ScanPainter scan;
    scan.size = {160, 120};
    scan.leds = scatterLeds(random, 5, scan.size);
    scan.frames = oneAtATime(scan.leds);
    return scan;
}

TEST(DecoderRobustness, ModulesThatShareAWordAreNotGuessed) {
    ScanPainter scan = smallScan();
    for (FrameInfo& frame : scan.frames) {
        std::erase_if(frame.lit, [&](const LitModule& lit) { return lit.module == scan.leds[1].module; });
        if (frame.lit.size() == 1 && frame.lit[0].module == scan.leds[0].module)
            frame.lit.push_back({scan.leds[1].module});
    }
    const ViewDetections view = decode(scan);
    EXPECT_EQ(expectNoneWrong(scan, view), 3U);
    for (const std::size_t twin : {0U, 1U}) {
        const Undetected* u = missing(view, scan.leds[twin].module);
        ASSERT_NE(u, nullptr);
        EXPECT_EQ(u->verdict, DetectionVerdict::Ambiguous);
    }
}

TEST(DecoderRobustness, ModulesNeverOrAlwaysLitAreReported) {
    ScanPainter scan = smallScan();
    for (FrameInfo& frame : scan.frames) {
        std::erase_if(frame.lit, [&](const LitModule& lit) { return lit.module <= scan.leds[1].module; });
        frame.lit.push_back({scan.leds[0].module});
    }
    const ViewDetections view = decode(scan);
    EXPECT_EQ(expectNoneWrong(scan, view), 3U);
    EXPECT_NE(missing(view, scan.leds[0].module), nullptr);
    const Undetected* never = missing(view, scan.leds[1].module);
    ASSERT_NE(never, nullptr);
    EXPECT_EQ(never->verdict, DetectionVerdict::NotFound);
}

TEST(DecoderRobustness, ManyLedsLitInColoursAtOnce) {
    ScanPainter scan = smallScan();
    scan.colour = true;
    const std::array<std::array<int, 3>, 5> colours{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}}};
    scan.frames = {{"dark.png", {}}, {"lit.png", {}}, {"dark2.png", {}}};
    for (std::size_t u = 0; u < scan.leds.size(); ++u)
        scan.frames[1].lit.push_back({scan.leds[u].module, colours.at(u)});
    EXPECT_EQ(expectNoneWrong(scan, decode(scan), 0.2), scan.leds.size());
}

TEST(DecoderRobustness, NoFramesYieldNothing) {
    ScanPainter scan = smallScan();
    scan.frames.clear();
    const ViewDetections view = decode(scan);
    EXPECT_TRUE(view.found.empty());
    EXPECT_EQ(view.undetected.size(), scan.leds.size());
}

TEST(DecoderRobustness, OneFrameYieldsNothing) {
    ScanPainter scan = smallScan();
    scan.frames.resize(2);
    scan.frames.erase(scan.frames.begin());
    EXPECT_TRUE(decode(scan).found.empty());
}

TEST(DecoderRobustness, TwoFramesAndOneLedAreEnough) {
    ScanPainter scan = smallScan();
    scan.leds.resize(1);
    scan.leds[0].peak = 120;
    scan.frames = {{"dark.png", {}}, {"lit.png", {{scan.leds[0].module}}}};
    EXPECT_EQ(expectNoneWrong(scan, decode(scan)), 1U);
}

TEST(DecoderRobustness, LoaderErrorsArePassedOn) {
    const ScanPainter scan = smallScan();
    for (const std::size_t call :
         {std::size_t{0}, std::size_t{4}, scan.frames.size() + 2, 2 * scan.frames.size() + 2}) {
        std::size_t calls = 0;
        const FrameLoader load = [&](std::size_t k) -> tl::expected<cv::Mat, std::string> {
            if (calls++ == call)
                return tl::unexpected(std::string("views/000/00004.png: the disk is gone"));
            return scan.paint(k);
        };
        const auto view = decodeView("view", scan.modules(), scan.frames, load);
        ASSERT_FALSE(view.has_value());
        EXPECT_EQ(view.error().message, "views/000/00004.png: the disk is gone");
        EXPECT_FALSE(view.error().cancelled);
    }
}

TEST(DecoderRobustness, StopsWhenAsked) {
    const ScanPainter scan = smallScan();
    const std::size_t frames = scan.frames.size();
    for (const std::size_t after : {std::size_t{0}, std::size_t{3}, frames + 1, 2 * frames + 1}) {
        std::size_t polls = 0;
        RunContext context;
        context.isCancelled = [&] { return polls++ >= after; };
        const auto view = decodeView("view", scan.modules(), scan.frames, scan.loader(), {}, context);
        ASSERT_FALSE(view.has_value());
        EXPECT_TRUE(view.error().cancelled);
    }
}

TEST(DecoderRobustness, ProgressRunsFromZeroToOne) {
    const ScanPainter scan = smallScan();
    double last = 0;
    RunContext context;
    context.report = [&](std::string_view, double done) {
        EXPECT_GE(done, last);
        EXPECT_LE(done, 1);
        last = done;
    };
    ASSERT_TRUE(decodeView("view", scan.modules(), scan.frames, scan.loader(), {}, context).has_value());
    EXPECT_GT(last, 0.8);
}

TEST(DecoderRobustness, FramesOfAnotherSizeAreRefused) {
    const ScanPainter scan = smallScan();
    const FrameLoader load = [&](std::size_t k) -> tl::expected<cv::Mat, std::string> {
        const cv::Mat frame = scan.paint(k);
        return k == 3 ? cv::Mat(frame(cv::Rect(0, 0, 100, 100))) : frame;
    };
    const auto view = decodeView("view", scan.modules(), scan.frames, load);
    ASSERT_FALSE(view.has_value());
    EXPECT_THAT(view.error().message, HasSubstr(scan.frames[3].file));
    EXPECT_THAT(view.error().message, HasSubstr("100"));
}

TEST(DecoderRobustness, BadOptionsThrow) {
    const ScanPainter scan = smallScan();
    DecoderOptions options;
    options.windowRadius = 1;
    EXPECT_THROW((void)decodeView("view", scan.modules(), scan.frames, scan.loader(), options), std::logic_error);
    options = {};
    options.reflectionRatio = 0.5;
    EXPECT_THROW((void)decodeView("view", scan.modules(), scan.frames, scan.loader(), options), std::logic_error);
}

}  // namespace
}  // namespace skincal::testing
