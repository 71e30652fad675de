#include "core/vision/decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "core/vision/coded_scan.h"
#include "tests/unit/vision/decoded.h"

namespace skincal::testing {
namespace {

using ::testing::HasSubstr;

ScanPainter smallScan() {
    Random random(7, "scan");
    ScanPainter scan;
    scan.size = {160, 120};
    scan.leds = scatterLeds(random, 5, scan.size);
    scan.frames = oneAtATime(scan.leds);
    return scan;
}

TEST(Decoder, ModulesThatShareAWordAreNotGuessed) {
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
        EXPECT_EQ(u->cause, Undetected::Cause::Alike);
    }
}

TEST(Decoder, ModulesNeverOrAlwaysLitAreReported) {
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
    EXPECT_THAT(never->reason, HasSubstr("never lit"));
    EXPECT_EQ(never->cause, Undetected::Cause::NeverBlinked);
}

TEST(Decoder, ManyLedsLitInColoursAtOnce) {
    ScanPainter scan = smallScan();
    scan.colour = true;
    const std::array<std::array<int, 3>, 5> colours{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}}};
    scan.frames = {{"dark.png", {}}, {"lit.png", {}}, {"dark2.png", {}}};
    for (std::size_t u = 0; u < scan.leds.size(); ++u)
        scan.frames[1].lit.push_back({scan.leds[u].module, colours.at(u)});
    EXPECT_EQ(expectNoneWrong(scan, decode(scan), 0.2), scan.leds.size());
}

TEST(Decoder, NoFramesYieldNothing) {
    ScanPainter scan = smallScan();
    scan.frames.clear();
    const ViewDetections view = decode(scan);
    EXPECT_TRUE(view.found.empty());
    EXPECT_EQ(view.undetected.size(), scan.leds.size());
}

TEST(Decoder, OneFrameYieldsNothing) {
    ScanPainter scan = smallScan();
    scan.frames.resize(2);
    scan.frames.erase(scan.frames.begin());
    EXPECT_TRUE(decode(scan).found.empty());
}

TEST(Decoder, TwoFramesAndOneLedAreEnough) {
    ScanPainter scan = smallScan();
    scan.leds.resize(1);
    scan.leds[0].peak = 120;
    scan.frames = {{"dark.png", {}}, {"lit.png", {{scan.leds[0].module}}}};
    EXPECT_EQ(expectNoneWrong(scan, decode(scan)), 1U);
}

TEST(Decoder, LoaderErrorsArePassedOn) {
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

TEST(Decoder, PicturesOfACameraThatIsLaterThanBelievedAreRefused) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
        for (const std::size_t late : {1, 2}) {
            Random random(seed, "late");
            ScanPainter scan;
            scan.seed = seed;
            scan.leds = scatterLeds(random, 20, scan.size);
            const std::vector<ModuleId> modules = scan.modules();
            scan.frames.clear();
            for (auto& lit : codedScan(modules, seed))
                scan.frames.push_back({"a.png", std::move(lit)});
            EXPECT_EQ(expectNoneWrong(scan, decode(scan)), scan.leds.size()) << "in time";
            const FrameLoader lateBy = [&](std::size_t k) { return scan.loader()(k - std::min(k, late)); };
            const auto view = decodeView("view", modules, scan.frames, lateBy);
            ASSERT_FALSE(view.has_value()) << late;
            EXPECT_THAT(view.error().message.english(),
                        ::testing::HasSubstr(late == 1 ? "a.png: each picture shows what was lit one picture before it"
                                                       : "what was lit two pictures before it"));
        }
}

TEST(Decoder, PicturesThatAreTooSmallToHoldALedAreRefused) {
    ScanPainter scan = smallScan();
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(640, 1), cv::Size(1, 480), cv::Size(3, 3)}) {
        const FrameLoader load = [&](std::size_t) -> tl::expected<cv::Mat, std::string> {
            return cv::Mat(size, CV_8UC1, cv::Scalar(7));
        };
        const auto view = decodeView("view", scan.modules(), scan.frames, load);
        ASSERT_FALSE(view.has_value());
        EXPECT_THAT(view.error().message.english(), ::testing::HasSubstr("expected at least 4 x 4 pixels"));
    }
}

TEST(Decoder, StopsWhenAsked) {
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

TEST(Decoder, ProgressRunsFromZeroToOne) {
    const ScanPainter scan = smallScan();
    double last = 0;
    RunContext context;
    context.report = [&](const Sentence&, double done) {
        EXPECT_GE(done, last);
        EXPECT_LE(done, 1);
        last = done;
    };
    ASSERT_TRUE(decodeView("view", scan.modules(), scan.frames, scan.loader(), {}, context).has_value());
    EXPECT_GT(last, 0.8);
}

TEST(Decoder, FramesOfAnotherSizeAreRefused) {
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

TEST(Decoder, BadOptionsThrow) {
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
