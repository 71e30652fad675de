#include "core/vision/decoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/unit/vision/spot_painter.h"

namespace skincal {
namespace {

const std::vector<ModuleId> kModules{ModuleId(11), ModuleId(22), ModuleId(33), ModuleId(44)};
const std::vector<std::string> kCoded{"0101100110", "0110011010", "0101011001", "0110100101"};
const std::vector<std::string> kSingle{"010000000", "000100000", "000001000", "000000010"};
const std::vector<Vector2d> kPlaces{{30.3, 40.7}, {75.5, 30.2}, {120.1, 80.6}, {50.8, 90.4}};

struct Scan {
    std::vector<FrameInfo> frames;
    std::vector<cv::Mat> pictures;

    [[nodiscard]] FrameLoader loader() const {
        return [this](std::size_t k) -> tl::expected<cv::Mat, std::string> { return pictures[k]; };
    }
};

using Disturb = std::function<void(std::size_t frame, std::vector<test::Painter::Spot>&, double& extra)>;

Scan scanOf(const std::vector<std::string>& words, std::uint64_t seed, double peak = 150, const Disturb& disturb = {},
            std::size_t hidden = 99) {
    Random random(seed, "decoder scan");
    Scan scan{test::framesOf(kModules, words), {}};
    for (std::size_t k = 0; k < scan.frames.size(); ++k) {
        std::vector<test::Painter::Spot> spots;
        double extra = 0;
        for (std::size_t u = 0; u < kModules.size(); ++u) {
            if (words[u][k] == '1' && u != hidden)
                spots.push_back({kPlaces[u], peak});
        }
        if (disturb)
            disturb(k, spots, extra);
        scan.pictures.push_back(test::Painter{}.paint(spots, random, extra));
    }
    return scan;
}

void expectAllAtTheirPlaces(const ViewDetections& view, double tolerance = 0.1) {
    for (const Undetected& missed : view.undetected)
        ADD_FAILURE() << missed.module.value << ": " << missed.reason;
    ASSERT_EQ(view.found.size(), kModules.size());
    for (std::size_t u = 0; u < kModules.size(); ++u) {
        EXPECT_EQ(view.found[u].module, kModules[u]);
        EXPECT_LT((view.found[u].pixel - kPlaces[u]).norm(), tolerance);
    }
}

class DecoderWords : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(DecoderWords, FindsEveryLedWhateverTheLitSets) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        for (const double peak : {30.0, 150.0, 500.0}) {
            const Scan scan = scanOf(GetParam(), seed, peak);
            const auto view = decodeView("v", kModules, scan.frames, scan.loader());
            ASSERT_TRUE(view);
            expectAllAtTheirPlaces(*view, peak < 50 ? 0.25 : 0.06);
        }
    }
}

TEST_P(DecoderWords, AHiddenLedIsNotFoundAndNobodyElseTakesItsPlace) {
    const Scan scan = scanOf(GetParam(), 3, 150, {}, 2);
    const auto view = decodeView("v", kModules, scan.frames, scan.loader());
    ASSERT_TRUE(view);
    EXPECT_EQ(view->found.size(), 3U);
    ASSERT_EQ(view->undetected.size(), 1U);
    EXPECT_EQ(view->undetected[0].module, ModuleId(33));
    EXPECT_EQ(view->undetected[0].verdict, DetectionVerdict::NotFound);
    EXPECT_FALSE(view->undetected[0].reason.empty());
}

TEST_P(DecoderWords, APictureOfNoiseHoldsNothing) {
    Random random(5, "noise only");
    Scan scan{test::framesOf(kModules, GetParam()), {}};
    for (std::size_t k = 0; k < scan.frames.size(); ++k)
        scan.pictures.push_back(test::Painter{}.paint({}, random));
    const auto view = decodeView("v", kModules, scan.frames, scan.loader());
    ASSERT_TRUE(view);
    EXPECT_TRUE(view->found.empty());
    EXPECT_EQ(view->undetected.size(), kModules.size());
}

TEST_P(DecoderWords, AFlickeringLampDoesNotMatter) {
    const Scan scan =
        scanOf(GetParam(), 6, 150, [](std::size_t k, auto&, double& extra) { extra = k % 2 == 0 ? 20 : -10; });
    const auto view = decodeView("v", kModules, scan.frames, scan.loader());
    ASSERT_TRUE(view);
    expectAllAtTheirPlaces(*view);
}

TEST_P(DecoderWords, ADimReflectionIsNotTakenForTheLed) {
    const auto& words = GetParam();
    const Scan scan = scanOf(words, 7, 150, [&](std::size_t k, auto& spots, double&) {
        if (words[0][k] == '1')
            spots.push_back({{30.3, 105.0}, 45});
    });
    const auto view = decodeView("v", kModules, scan.frames, scan.loader());
    ASSERT_TRUE(view);
    expectAllAtTheirPlaces(*view);
}

TEST_P(DecoderWords, TwoEquallyBrightSpotsAreAmbiguous) {
    const auto& words = GetParam();
    const Scan scan = scanOf(words, 8, 150, [&](std::size_t k, auto& spots, double&) {
        if (words[0][k] == '1')
            spots.push_back({{30.3, 105.0}, 140});
    });
    const auto view = decodeView("v", kModules, scan.frames, scan.loader());
    ASSERT_TRUE(view);
    EXPECT_EQ(view->found.size(), 3U);
    ASSERT_EQ(view->undetected.size(), 1U);
    EXPECT_EQ(view->undetected[0].module, ModuleId(11));
    EXPECT_EQ(view->undetected[0].verdict, DetectionVerdict::Ambiguous);
}

INSTANTIATE_TEST_SUITE_P(Scans, DecoderWords, testing::Values(kSingle, kCoded));

TEST(Decoder, SomethingBrightThatMovesNeverBecomesAModule) {
    const Scan scan = scanOf(kCoded, 9, 150, [](std::size_t k, auto& spots, double&) {
        spots.push_back({{15.0 * static_cast<double>(k) + 5, 110}, 180});
    });
    const auto view = decodeView("v", kModules, scan.frames, scan.loader());
    ASSERT_TRUE(view);
    for (const LedDetection& found : view->found)
        EXPECT_LT(found.pixel.y(), 100);
}

TEST(Decoder, TwoLedsInOneSpotAreNeverAWrongModule) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Random random(seed, "overlap");
        Scan scan{test::framesOf(kModules, kCoded), {}};
        for (std::size_t k = 0; k < scan.frames.size(); ++k) {
            std::vector<test::Painter::Spot> spots;
            if (kCoded[0][k] == '1')
                spots.push_back({{60, 60}, 120});
            if (kCoded[1][k] == '1')
                spots.push_back({{61.2, 60.4}, 110});
            scan.pictures.push_back(test::Painter{}.paint(spots, random));
        }
        const auto view = decodeView("v", kModules, scan.frames, scan.loader());
        ASSERT_TRUE(view);
        for (const LedDetection& found : view->found)
            EXPECT_TRUE(found.module == kModules[0] || found.module == kModules[1]);
    }
}

TEST(Decoder, ModulesWithOneWordForTwoAreAmbiguousNotGuessed) {
    auto words = kCoded;
    words[1] = words[0];
    const Scan scan = scanOf(words, 10);
    const auto view = decodeView("v", kModules, scan.frames, scan.loader());
    ASSERT_TRUE(view);
    EXPECT_EQ(view->found.size(), 2U);
    for (const Undetected& missed : view->undetected)
        EXPECT_EQ(missed.verdict, DetectionVerdict::Ambiguous);
}

TEST(Decoder, SaysWhenALedWasNeverLit) {
    auto words = kCoded;
    words[3] = "0000000000";
    const Scan scan = scanOf(words, 11);
    const auto view = decodeView("v", kModules, scan.frames, scan.loader());
    ASSERT_TRUE(view);
    ASSERT_EQ(view->undetected.size(), 1U);
    EXPECT_THAT(view->undetected[0].reason, testing::HasSubstr("never lit"));
}

TEST(Decoder, PassesOnWhatTheLoaderSays) {
    const auto frames = test::framesOf(kModules, kCoded);
    const auto view = decodeView("v", kModules, frames, [](std::size_t k) -> tl::expected<cv::Mat, std::string> {
        if (k == 3)
            return tl::unexpected<std::string>("frame3.png: damaged");
        return cv::Mat::zeros(50, 50, CV_8UC1);
    });
    ASSERT_FALSE(view);
    EXPECT_EQ(view.error().message, "frame3.png: damaged");
    EXPECT_FALSE(view.error().cancelled);
}

TEST(Decoder, RefusesFramesOfDifferentSizes) {
    const auto frames = test::framesOf(kModules, kCoded);
    const auto view = decodeView("v", kModules, frames, [](std::size_t k) -> tl::expected<cv::Mat, std::string> {
        return cv::Mat::zeros(k == 4 ? 60 : 50, 50, CV_8UC1);
    });
    ASSERT_FALSE(view);
    EXPECT_THAT(view.error().message, testing::HasSubstr("frame4.png"));
}

TEST(Decoder, StopsWhenCancelled) {
    const Scan scan = scanOf(kCoded, 12);
    int asked = 0;
    RunContext context;
    context.isCancelled = [&] { return ++asked > 5; };
    const auto view = decodeView("v", kModules, scan.frames, scan.loader(), {}, context);
    ASSERT_FALSE(view);
    EXPECT_TRUE(view.error().cancelled);
    EXPECT_LE(asked, 6);
}

TEST(Decoder, ReadsColourAndGreyAlike) {
    Scan scan = scanOf(kCoded, 13);
    for (cv::Mat& picture : scan.pictures)
        cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
    const auto view = decodeView("v", kModules, scan.frames, scan.loader());
    ASSERT_TRUE(view);
    expectAllAtTheirPlaces(*view);
}

TEST(Decoder, AViewWithoutFramesFindsNothing) {
    const auto view = decodeView("v", kModules, {}, [](std::size_t) -> tl::expected<cv::Mat, std::string> {
        return tl::unexpected<std::string>("there is none");
    });
    ASSERT_TRUE(view);
    EXPECT_TRUE(view->found.empty());
}

}  // namespace
}  // namespace skincal
