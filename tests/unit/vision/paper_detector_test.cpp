#include "core/vision/paper_detector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/unit/vision/spot_painter.h"

namespace skincal {
namespace {

const std::vector<ModuleId> kModules{ModuleId(5), ModuleId(6), ModuleId(7)};
const std::vector<Vector2d> kPlaces{{40.3, 30.7}, {110.2, 60.5}, {60.6, 90.1}};

/// One LED at a time, `repeats` foreground frames each, a background before each.
struct PaperScan {
    std::vector<FrameInfo> frames;
    std::vector<cv::Mat> pictures;
    explicit PaperScan(int repeats, double peak,
                       const std::function<void(std::size_t, std::vector<test::Painter::Spot>&)>& extra = {}) {
        Random random(21, "paper scan");
        test::Painter painter;
        painter.sigma = 1.6;
        const auto add = [&](std::optional<std::size_t> lit) {
            FrameInfo info;
            std::vector<test::Painter::Spot> spots;
            if (lit) {
                info.lit.push_back({kModules[*lit], std::nullopt});
                spots.push_back({kPlaces[*lit], peak});
            }
            if (extra)
                extra(frames.size(), spots);
            frames.push_back(info);
            pictures.push_back(painter.paint(spots, random));
        };
        for (std::size_t u = 0; u < kModules.size(); ++u) {
            for (int r = 0; r < repeats; ++r) {
                add(std::nullopt);
                add(u);
            }
        }
        add(std::nullopt);
    }
    [[nodiscard]] FrameLoader loader() const {
        return [this](std::size_t k) -> tl::expected<cv::Mat, std::string> { return pictures[k]; };
    }
};

TEST(PaperDetector, FindsLedsToATenthOfAPixelOrSo) {
    const PaperScan scan(3, 180);
    const auto view = detectPaper("v", kModules, scan.frames, scan.loader());
    ASSERT_TRUE(view);
    ASSERT_EQ(view->found.size(), 3U);
    for (std::size_t u = 0; u < 3; ++u)
        EXPECT_LT((view->found[u].pixel - kPlaces[u]).norm(), 0.5);
}

TEST(PaperDetector, AFaintLedIsBelowTheThreshold) {
    const PaperScan scan(3, 35);
    const auto view = detectPaper("v", kModules, scan.frames, scan.loader());
    ASSERT_TRUE(view);
    EXPECT_TRUE(view->found.empty());
    EXPECT_THAT(view->undetected[0].reason, testing::HasSubstr("no blob"));
}

TEST(PaperDetector, TwoBlobsAreNone) {
    const PaperScan scan(3, 180, [](std::size_t k, auto& spots) {
        if (k % 2 == 1)
            spots.push_back({{20, 100}, 180});
    });
    const auto view = detectPaper("v", kModules, scan.frames, scan.loader());
    ASSERT_TRUE(view);
    EXPECT_TRUE(view->found.empty());
    EXPECT_THAT(view->undetected[0].reason, testing::HasSubstr("blobs instead of one"));
}

TEST(PaperDetector, MultiplyingBinaryImagesRemovesWhatFlickers) {
    // A flash in one of three foreground frames of the first module: gone in the product, fatal without it.
    const auto flash = [](std::size_t k, auto& spots) {
        if (k == 1)
            spots.push_back({{20, 100}, 180});
    };
    const PaperScan scan(3, 180, flash);
    const auto three = detectPaper("v", kModules, scan.frames, scan.loader());
    PaperDetectorOptions once;
    once.binaryImages = 1;
    const auto one = detectPaper("v", kModules, scan.frames, scan.loader(), once);
    ASSERT_TRUE(three && one);
    EXPECT_EQ(three->found.size(), 3U);
    EXPECT_EQ(one->found.size(), 2U);
}

TEST(PaperDetector, HasNoWayWithPatterns) {
    const auto frames = test::framesOf(kModules, {"0101", "0110", "0011"});
    EXPECT_FALSE(suitsPaperDetector(std::span(frames).subspan(1, 2)));
    const auto view = detectPaper("v", kModules, std::span(frames).subspan(1, 2),
                                  [](std::size_t) -> tl::expected<cv::Mat, std::string> { return cv::Mat(); });
    ASSERT_TRUE(view);
    EXPECT_EQ(view->undetected.size(), 3U);
    EXPECT_THAT(view->undetected[0].reason, testing::HasSubstr("together with others"));
}

TEST(PaperDetector, TellsColoursApart) {
    std::vector<FrameInfo> frames(2);
    const std::vector<std::array<int, 3>> colours{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t u = 0; u < 3; ++u)
        frames[1].lit.push_back({kModules[u], colours[u]});
    Random random(23, "colours");
    test::Painter painter;
    painter.sigma = 1.6;
    std::vector<cv::Mat> pictures;
    for (const bool on : {false, true}) {
        std::vector<cv::Mat> channels;
        for (std::size_t c = 0; c < 3; ++c) {
            std::vector<test::Painter::Spot> spots;
            if (on) {
                for (std::size_t u = 0; u < 3; ++u)
                    spots.push_back({kPlaces[u], colours[u].at(2 - c) == 1 ? 170.0 : 15.0});
            }
            channels.push_back(painter.paint(spots, random));
        }
        pictures.emplace_back();
        cv::merge(channels, pictures.back());
    }
    EXPECT_TRUE(suitsPaperDetector(frames));
    const auto view = detectPaper("v", kModules, frames,
                                  [&](std::size_t k) -> tl::expected<cv::Mat, std::string> { return pictures[k]; });
    ASSERT_TRUE(view);
    ASSERT_EQ(view->found.size(), 3U);
    for (std::size_t u = 0; u < 3; ++u)
        EXPECT_LT((view->found[u].pixel - kPlaces[u]).norm(), 0.5);
}

TEST(PaperDetector, LoaderErrorsAndCancellation) {
    const PaperScan scan(1, 180);
    const auto failed = detectPaper("v", kModules, scan.frames, [](std::size_t) -> tl::expected<cv::Mat, std::string> {
        return tl::unexpected<std::string>("gone");
    });
    ASSERT_FALSE(failed);
    EXPECT_EQ(failed.error().message, "gone");
    RunContext context;
    context.isCancelled = [] { return true; };
    const auto cancelled = detectPaper("v", kModules, scan.frames, scan.loader(), {}, context);
    ASSERT_FALSE(cancelled);
    EXPECT_TRUE(cancelled.error().cancelled);
}

}  // namespace
}  // namespace skincal
