#include "core/vision/scan_code.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <opencv2/core.hpp>
#include <set>

#include "core/vision/colour_mixing.h"
#include "core/vision/paper_frames.h"
#include "tests/unit/vision/decoded.h"

namespace skincal::testing {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<ModuleId> modulesNamed(std::size_t count) {
    std::vector<ModuleId> modules;
    for (std::size_t i = 0; i < count; ++i)
        modules.push_back(ModuleId{static_cast<std::uint32_t>(100 + 3 * i)});
    return modules;
}

std::vector<FrameInfo> framesOf(const LitSets& scan) {
    std::vector<FrameInfo> frames;
    for (const auto& lit : scan)
        frames.push_back({"frame", lit});
    return frames;
}

TEST(ScanCode, AllOfThemLightEveryModuleSoThatItCanBeTold) {
    for (const ScanCode code : {ScanCode::Words, ScanCode::OneAtATime, ScanCode::Colours}) {
        for (const std::size_t count : {1U, 2U, 7U, 8U, 55U, 200U}) {
            const auto modules = modulesNamed(count);
            const auto words = litWords(modules, framesOf(scanOf(code, modules, 3)));
            ASSERT_TRUE(words);
            const Codebook book = makeCodebook(*words);
            std::set<std::size_t> different(book.representative.begin(), book.representative.end());
            EXPECT_THAT(different, SizeIs(count));
            for (std::size_t u = 0; u < count; ++u)
                EXPECT_TRUE(book.blinks(u));
        }
    }
}

TEST(ScanCode, AllOfThemBeginWithAToggleOfAllLeds) {
    for (const ScanCode code : {ScanCode::Words, ScanCode::OneAtATime, ScanCode::Colours}) {
        const auto modules = modulesNamed(20);
        const LitSets scan = scanOf(code, modules, 1);
        EXPECT_THAT(scan[0], IsEmpty());
        EXPECT_THAT(scan[1], SizeIs(20));
        EXPECT_THAT(scan.back(), IsEmpty()) << "what moved shows at both ends";
    }
}

TEST(ScanCode, ThePapersDetectorCanUseThePapersCodes) {
    constexpr std::size_t kNative = 7;
    const auto modules = modulesNamed(16);
    for (const LitSets& scan : {oneAtATimeScan(modules, 2), scanOf(ScanCode::OneAtATime, modules, 1),
                                colouredScan(modules), scanOf(ScanCode::Colours, modules, 1)}) {
        std::map<ModuleId, int> shown;
        for (const PaperGroup& group : paperGroups(framesOf(scan), kNative)) {
            EXPECT_FALSE(group.pairs.empty());
            for (const LitModule& lit : group.lit)
                ++shown[lit.module];
        }
        EXPECT_THAT(shown, SizeIs(16)) << "every module";
    }
    EXPECT_THAT(oneAtATimeScan(modules, 2), SizeIs(2 * 2 * 16 + 1));
    EXPECT_THAT(colouredScan(modules), SizeIs(2 * 3 + 1));
}

ScanPainter paintedScan(std::uint64_t seed, ScanCode code) {
    Random random(seed, "scan");
    ScanPainter scan;
    scan.seed = seed;
    scan.leds = scatterLeds(random, 17, scan.size);
    scan.colour = code == ScanCode::Colours;
    scan.frames = framesOf(scanOf(code, scan.modules(), seed));
    return scan;
}

TEST(ScanCode, ColoursAreToldApartByACameraThatMixesThem) {
    // Blue LEDs are half as bright; a third of green is red to the camera, and so on.
    Eigen::Matrix3d mixing;
    mixing << 0.5, 0.2, 0.02,  //
        0.15, 1, 0.25,         //
        0.03, 0.3, 0.9;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        ScanPainter scan = paintedScan(seed, ScanCode::Colours);
        scan.mixing = mixing;
        (void)expectNoneWrong(scan, decode(scan));
        // Of clipped light the hue is lost.
        for (PaintedLed& led : scan.leds)
            led.peak = std::min(led.peak, 110.0);
        const auto measured = ColourMixing::measured(scan.frames, scan.loader());
        ASSERT_TRUE(measured && *measured);
        const Eigen::Matrix3d& scaled = (*measured)->matrix();
        const Eigen::Matrix3d M = scaled * std::cbrt(mixing.diagonal().prod() / scaled.diagonal().prod());
        EXPECT_LT((M - mixing).cwiseAbs().maxCoeff(), 0.03) << M;
        const ViewDetections view = decode(scan);
        EXPECT_EQ(expectNoneWrong(scan, view), scan.leds.size()) << seed;
        for (const Undetected& missing : view.undetected)
            ADD_FAILURE() << missing.module.value << ": " << missing.reason;
        // What is missing is a picture of one of the colours.
        scan.frames.erase(scan.frames.begin() + 3);
        EXPECT_FALSE(*ColourMixing::measured(scan.frames, scan.loader()));
        (void)expectNoneWrong(scan, decode(scan));
    }
}

TEST(ScanCode, ColoursThatTheCameraCannotTellApartAreLeftAsTheyAre) {
    ScanPainter scan = paintedScan(5, ScanCode::Colours);
    scan.mixing.setOnes();
    EXPECT_FALSE(*ColourMixing::measured(scan.frames, scan.loader()));
    (void)expectNoneWrong(scan, decode(scan));
    const FrameLoader broken = [](std::size_t) { return tl::unexpected(std::string("no picture")); };
    EXPECT_EQ(ColourMixing::measured(scan.frames, broken).error(), "no picture");
    EXPECT_FALSE(*ColourMixing::measured({}, broken));
}

TEST(ScanCode, PicturesOfSeveralSizesAreLeftToWhoeverDecodesThem) {
    const ScanPainter scan = paintedScan(7, ScanCode::Colours);
    for (std::size_t odd = 0; odd < 6; ++odd) {
        const FrameLoader load = [&](std::size_t k) -> tl::expected<cv::Mat, std::string> {
            const cv::Mat picture = scan.paint(k);
            return k == odd ? cv::Mat(picture(cv::Rect(0, 0, 100, 80)).clone()) : picture;
        };
        const auto measured = ColourMixing::measured(scan.frames, load);
        ASSERT_TRUE(measured);
        const auto view = decodeView("view", scan.modules(), scan.frames, load);
        ASSERT_FALSE(view);
        EXPECT_THAT(view.error().message.english(), ::testing::HasSubstr("pixels"));
    }
}

TEST(ScanCode, PicturesWithoutColoursAreUnmixedToNothingElse) {
    const ScanPainter scan = paintedScan(6, ScanCode::Colours);
    const auto measured = ColourMixing::measured(scan.frames, scan.loader());
    ASSERT_TRUE(measured && *measured);
    cv::Mat clipped = scan.paint(0);
    clipped.at<cv::Vec3b>(20, 30) = {60, 255, 60};
    const auto pixel = (*measured)->unmixed(clipped).at<cv::Vec3b>(20, 30);
    EXPECT_EQ(pixel[1], 255);
    EXPECT_LT(std::max(pixel[0], pixel[2]), 60);
    EXPECT_NEAR(cv::mean((*measured)->unmixed(clipped))[1], ColourMixing::kGround, 2);
    const cv::Mat grey(scan.size, CV_8U, cv::Scalar(9));
    EXPECT_EQ((*measured)->unmixed(grey).data, grey.data) << "whoever decodes it complains";
}

TEST(ScanCode, WhatIsLitIsFound) {
    for (const ScanCode code : {ScanCode::Words, ScanCode::OneAtATime, ScanCode::Colours}) {
        const ScanPainter scan = paintedScan(4, code);
        EXPECT_EQ(expectNoneWrong(scan, decode(scan)), 17U);
    }
}

}  // namespace
}  // namespace skincal::testing
