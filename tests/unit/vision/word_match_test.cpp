#include "core/vision/word_match.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/vision/amplitude_map.h"
#include "core/vision/codebook.h"
#include "core/vision/frame_pixels.h"
#include "core/vision/spot_series.h"
#include "core/vision/surroundings.h"
#include "tests/unit/vision/scan_painter.h"

namespace skincal::testing {
namespace {

struct Scan {
    std::vector<PaintedLed> leds;
    std::vector<FrameInfo> frames;
    Codebook book;
};

Scan makeScan(std::uint64_t seed, std::size_t modules, bool single) {
    Random random(seed, "words");
    Scan scan;
    for (std::size_t u = 0; u < modules; ++u)
        scan.leds.push_back({ModuleId(static_cast<std::uint32_t>(u + 1)), {}, 100});
    scan.frames = single ? oneAtATime(scan.leds) : coded(scan.leds, random);
    std::vector<ModuleId> ids;
    for (const PaintedLed& led : scan.leds)
        ids.push_back(led.module);
    scan.book = makeCodebook(*litWords(ids, scan.frames));
    return scan;
}

std::vector<double> series(const Scan& scan, std::vector<std::pair<std::size_t, double>> light, Random& random,
                           double sigma = 1) {
    std::vector<double> y(scan.frames.size());
    for (std::size_t k = 0; k < y.size(); ++k)
        y[k] = 20 + 0.2 * static_cast<double>(k) + sigma * random.normal();
    for (const auto& [module, amplitude] : light) {
        for (const std::size_t plane : scan.book.lit[module])
            y[plane] += amplitude;
    }
    return y;
}

class WordMatch : public ::testing::TestWithParam<bool> {};

TEST_P(WordMatch, NamesTheModule) {
    Random random(1, "one");
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Scan scan = makeScan(seed, 30, GetParam());
        for (std::size_t u = 0; u < 30; ++u) {
            const double amplitude = random.uniform(15, 150);
            const SeriesMatch match = WordMatcher(scan.book).match(series(scan, {{u, amplitude}}, random), 1);
            ASSERT_EQ(match.verdict, SeriesVerdict::Matched);
            ASSERT_EQ(match.words, std::vector{u});
            EXPECT_NEAR(match.amplitudes[0], amplitude, 6);
            EXPECT_GE(match.margin, WordMatchOptions{}.minMargin);
        }
    }
}

TEST_P(WordMatch, NoiseNamesNobody) {
    Random random(2, "noise");
    const Scan scan = makeScan(2, 60, GetParam());
    for (int i = 0; i < 500; ++i)
        EXPECT_NE(WordMatcher(scan.book).match(series(scan, {}, random), 1).verdict, SeriesVerdict::Matched);
}

TEST_P(WordMatch, DisturbedPlanesMakeNoWrongName) {
    Random random(3, "disturbed");
    int right = 0;
    constexpr int kDraws = 400;
    for (int i = 0; i < kDraws; ++i) {
        const Scan scan = makeScan(static_cast<std::uint64_t>(i), 20, GetParam());
        const std::size_t u = random.index(20);
        auto y = series(scan, {{u, random.uniform(40, 120)}}, random);
        y[random.index(y.size())] += random.uniform(-150, 150);
        const SeriesMatch match = WordMatcher(scan.book).match(y, 1);
        if (match.verdict != SeriesVerdict::Matched)
            continue;
        EXPECT_EQ(match.words, std::vector{u});
        ++right;
    }
    // One at a time, whatever hits a lit plane is as good as another module.
    EXPECT_GE(right, GetParam() ? kDraws / 4 : kDraws * 3 / 4);
}

TEST_P(WordMatch, SumsAreTakenApartOrRefused) {
    Random random(4, "sums");
    int both = 0;
    constexpr int kDraws = 300;
    for (int i = 0; i < kDraws; ++i) {
        const Scan scan = makeScan(static_cast<std::uint64_t>(i), 20, GetParam());
        const std::size_t u = random.index(20);
        const std::size_t v = (u + 1 + random.index(19)) % 20;
        const auto y = series(scan, {{u, random.uniform(30, 100)}, {v, random.uniform(30, 100)}}, random);
        const SeriesMatch match = WordMatcher(scan.book).match(y, 1);
        if (match.verdict != SeriesVerdict::Matched)
            continue;
        for (const std::size_t word : match.words)
            EXPECT_TRUE(word == u || word == v) << "draw " << i;
        both += match.words.size() == 2 ? 1 : 0;
    }
    // One at a time, a second module and one disturbed frame look the same.
    if (!GetParam()) {
        EXPECT_GE(both, kDraws / 2);
    }
}

INSTANTIATE_TEST_SUITE_P(Schemes, WordMatch, ::testing::Bool(),
                         [](const auto& single) { return single.param ? "OneAtATime" : "Coded"; });

TEST(WordMatching, NeighboursInTheCodeAreAmbiguousWhenFaint) {
    // Two words that differ in one frame, and light too faint to see which it is.
    const std::vector<ModuleId> ids{ModuleId(1), ModuleId(2)};
    std::vector<FrameInfo> frames;
    for (int k = 0; k < 12; ++k) {
        FrameInfo frame{"f", {}};
        if (k % 2 == 1)
            frame.lit.push_back({ids[0]});
        if (k % 2 == 1 && k != 5)
            frame.lit.push_back({ids[1]});
        frames.push_back(frame);
    }
    const Codebook book = makeCodebook(*litWords(ids, frames));
    std::vector<double> y(12);
    for (std::size_t k = 0; k < 12; ++k)
        y[k] = k % 2 == 1 ? 4.0 : 0.0;
    const SeriesMatch match = WordMatcher(book).match(y, 1);
    EXPECT_EQ(match.verdict, SeriesVerdict::Ambiguous);
    ASSERT_TRUE(match.runnerUp.has_value());
    EXPECT_EQ(match.words[0] + *match.runnerUp, 1U) << "each is the other's rival";
}

TEST(WordMatching, BlinkingLikeNobodyIsUnlike) {
    Random random(5, "unlike");
    int unlike = 0;
    for (int i = 0; i < 100; ++i) {
        const Scan scan = makeScan(static_cast<std::uint64_t>(i), 12, false);
        std::vector<double> y(scan.frames.size());
        for (double& value : y)
            value = 100 * random.uniform();
        const SeriesMatch match = WordMatcher(scan.book).match(y, 1);
        EXPECT_NE(match.verdict, SeriesVerdict::Matched);
        unlike += match.verdict == SeriesVerdict::Unlike ? 1 : 0;
    }
    EXPECT_GT(unlike, 10);
}

TEST(WordMatching, ConstantWordsDoNotBlink) {
    const std::vector<ModuleId> ids{ModuleId(1), ModuleId(2), ModuleId(3), ModuleId(4)};
    std::vector<FrameInfo> frames;
    for (int k = 0; k < 10; ++k) {
        FrameInfo frame{"f", {{ids[0]}}};
        if (k % 3 == 0)
            frame.lit.insert(frame.lit.end(), {{ids[2]}, {ids[3]}});
        frames.push_back(frame);
    }
    const Codebook book = makeCodebook(*litWords(ids, frames));
    EXPECT_FALSE(book.blinks(0));  // always lit
    EXPECT_FALSE(book.blinks(1));  // never lit
    EXPECT_TRUE(book.blinks(2));
    EXPECT_EQ(book.representative[3], 2U);
}

TEST(WordMatching, AmplitudeWeightsReturnTheAmplitudes) {
    Random random(6, "weights");
    const Scan scan = makeScan(6, 16, false);
    const std::vector<std::uint8_t> used(scan.frames.size(), 1);
    const std::vector<std::size_t> words{3, 7};
    const auto y = series(scan, {{3, 50}, {7, 80}}, random, 0);
    const Eigen::VectorXd light = amplitudeWeights(scan.book, words, used) *
                                  Eigen::Map<const Eigen::VectorXd>(y.data(), static_cast<Eigen::Index>(y.size()));
    EXPECT_NEAR(light[0], 50, 1e-9);
    EXPECT_NEAR(light[1], 80, 1e-9);
    const Eigen::MatrixXd Q = explainedSpace(scan.book, words, used);
    EXPECT_TRUE((Q.transpose() * Q).isIdentity(1e-9));
}

TEST(WordMatching, WeightsOfTheSameWordTwiceDoNotExist) {
    const Scan scan = makeScan(7, 8, false);
    const std::vector<std::uint8_t> used(scan.frames.size(), 1);
    EXPECT_EQ(amplitudeWeights(scan.book, std::vector<std::size_t>{2, 2}, used).size(), 0);
}

/// A long series of one blinking LED on light that changes faster and faster: the planes at its end are dropped a few
/// at a time.
struct BentSeries {
    Codebook book;
    std::vector<double> y;

    explicit BentSeries(std::uint64_t seed) {
        Random random(seed, "bent series");
        const std::vector<ModuleId> ids{ModuleId(1), ModuleId(2)};
        std::vector<FrameInfo> frames(600 + random.index(200));
        for (FrameInfo& frame : frames) {
            for (const ModuleId id : ids) {
                if (random.uniform() < 0.5)
                    frame.lit.push_back({id});
            }
        }
        book = makeCodebook(*litWords(ids, frames));
        const double bend = random.uniform(25, 45);
        const int power = 3 + static_cast<int>(random.index(3));
        for (std::size_t k = 0; k < frames.size(); ++k)
            y.push_back(bend * std::pow(static_cast<double>(k) / static_cast<double>(frames.size()), power) +
                        random.normal());
        const double amplitude = random.uniform(10, 40);
        for (const std::size_t plane : book.lit[0])
            y[plane] += amplitude;
    }
};

TEST(WordMatching, WhatMatchesIsTheLeastSquaresFitToThePlanesItKeeps) {
    int matched = 0;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        const BentSeries bent(seed);
        const SeriesMatch match = WordMatcher(bent.book).match(bent.y, 1);
        if (match.verdict != SeriesVerdict::Matched)
            continue;
        ++matched;
        const Eigen::MatrixXd weights = amplitudeWeights(bent.book, match.words, match.used);
        ASSERT_EQ(weights.rows(), static_cast<Eigen::Index>(match.words.size()));
        const Eigen::VectorXd light =
            weights * Eigen::Map<const Eigen::VectorXd>(bent.y.data(), static_cast<Eigen::Index>(bent.y.size()));
        for (std::size_t j = 0; j < match.words.size(); ++j)
            EXPECT_NEAR(light[static_cast<Eigen::Index>(j)], match.amplitudes[j], 1e-6) << "seed " << seed;
    }
    EXPECT_GE(matched, 200);
}

TEST(WordMatching, AFitThatHasNotSettledIsNone) {
    WordMatchOptions hasty;
    hasty.maxIterations = 1;
    int refused = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const BentSeries bent(seed);
        const SeriesMatch match = WordMatcher(bent.book).match(bent.y, 1);
        const bool dropped = std::find(match.used.begin(), match.used.end(), 0) != match.used.end();
        if (match.verdict != SeriesVerdict::Matched || !dropped)
            continue;
        // Unless it begins with just the planes that it ends with.
        if (WordMatcher(bent.book, hasty).match(bent.y, 1).verdict == SeriesVerdict::Matched)
            continue;
        ++refused;
    }
    EXPECT_GE(refused, 50);
}

TEST(CalmPlanes, WhoPassesIsLeftOutButNoLampAndNoNeighbour) {
    Random random(12, "calm");
    const std::vector<double> gains(24, 1);
    std::vector<std::uint8_t> used(24, 1);
    used[3] = 0;
    Eigen::VectorXf around(24);
    for (Eigen::Index k = 0; k < 24; ++k)
        around[k] = static_cast<float>(70 + random.normal());
    EXPECT_EQ(calmPlanes(around, gains, used), used);
    Eigen::VectorXf passing = around;
    passing.segment(10, 4).array() += 40;
    std::vector<std::uint8_t> calm = used;
    std::fill(calm.begin() + 10, calm.begin() + 14, std::uint8_t{0});
    EXPECT_EQ(calmPlanes(passing, gains, used), calm);
    Eigen::VectorXf lamp = around;
    for (Eigen::Index k = 0; k < 24; ++k)
        lamp[k] += static_cast<float>(50 * std::sin(2.1 * static_cast<double>(k)));
    EXPECT_EQ(calmPlanes(lamp, gains, used), used);
}

TEST(AmplitudeMap, AWordThatNeverBlinksThrows) {
    const std::vector<ModuleId> ids{ModuleId(1), ModuleId(2)};
    const std::vector<FrameInfo> frames{{"", {{ids[0]}, {ids[1]}}}, {"", {{ids[0]}}}};
    const Codebook book = makeCodebook(*litWords(ids, frames));
    LightFilter filter;
    const std::vector<double> gains(2, 1.0);
    filter.words = {0};
    filter.used = {1, 1};
    filter.around = Eigen::VectorXf::Zero(2);
    filter.gains = gains;
    EXPECT_THROW(AmplitudeMap({20, 20, 50}, 5, {40, 40}, book, filter), std::logic_error);
    filter.words = {1, 0};
    EXPECT_NO_THROW(AmplitudeMap({20, 20, 50}, 5, {40, 40}, book, filter)) << "does without its neighbour";
}

TEST(WordMatching, MisuseThrows) {
    const Scan scan = makeScan(8, 8, false);
    const std::vector<double> y(scan.frames.size(), 0.0);
    EXPECT_THROW((void)WordMatcher(scan.book).match(std::vector<double>(3, 0.0), 1), std::logic_error);
    EXPECT_THROW((void)WordMatcher(scan.book).match(y, 0), std::logic_error);
    EXPECT_THROW((void)WordMatcher(scan.book).match(y, 1, {}, std::vector<std::uint8_t>(3, 0)), std::logic_error);
    WordMatchOptions options;
    options.shortlist = 1;
    EXPECT_THROW((void)WordMatcher(scan.book, options).match(y, 1), std::logic_error);
    options = {};
    options.maxIterations = 0;
    EXPECT_THROW((void)WordMatcher(scan.book, options).match(y, 1), std::logic_error);
}

TEST(LitWords, DefectsAreNamed) {
    const std::vector<ModuleId> ids{ModuleId(1), ModuleId(2)};
    const auto unknown = litWords(ids, std::vector<FrameInfo>{{"a.png", {{ModuleId(9)}}}});
    ASSERT_FALSE(unknown.has_value());
    EXPECT_NE(unknown.error().english().find("a.png"), std::string::npos);
    EXPECT_NE(unknown.error().english().find('9'), std::string::npos);
    EXPECT_FALSE(litWords(ids, std::vector<FrameInfo>{{"a.png", {{ids[0]}, {ids[0]}}}}).has_value());
    EXPECT_FALSE(litWords(ids, std::vector<FrameInfo>{{"a.png", {{ids[0], std::array{2, 0, 0}}}}}).has_value());
}

TEST(LitWords, ColoursAreChannelsOfTheirOwn) {
    const std::vector<ModuleId> ids{ModuleId(1), ModuleId(2)};
    const auto words =
        litWords(ids, std::vector<FrameInfo>{{"a.png", {}}, {"b.png", {{ids[0], std::array{1, 1, 0}}, {ids[1]}}}});
    ASSERT_TRUE(words.has_value());
    EXPECT_TRUE(words->coloured);
    ASSERT_EQ(words->planes.size(), 6U);
    EXPECT_EQ(words->lit[0], (std::vector<std::size_t>{4, 5}));  // green and red of a BGR picture
    EXPECT_EQ(words->lit[1], (std::vector<std::size_t>{3, 4, 5}));
}

TEST(FramePixels, PicturesThatCannotBeUsedAreRefused) {
    const auto refused = [](const cv::Mat& picture, bool coloured = false) {
        const auto pixels = FramePixels::make(picture, "views/7.png", cv::Size(8, 6), coloured);
        return !pixels.has_value() && pixels.error().english().find("views/7.png") == 0;
    };
    EXPECT_TRUE(refused(cv::Mat()));
    EXPECT_TRUE(refused(cv::Mat(6, 8, CV_16U, cv::Scalar(0))));
    EXPECT_TRUE(refused(cv::Mat(6, 8, CV_8UC2, cv::Scalar(0))));
    EXPECT_TRUE(refused(cv::Mat(8, 6, CV_8U, cv::Scalar(0))));
    EXPECT_TRUE(refused(cv::Mat(6, 8, CV_8U, cv::Scalar(0)), true));
    EXPECT_FALSE(refused(cv::Mat(6, 8, CV_8U, cv::Scalar(0))));
}

TEST(FramePixels, PlanesAndPixelsAgree) {
    cv::Mat picture(6, 8, CV_8UC3, cv::Scalar(10, 100, 190));
    picture.at<cv::Vec3b>(2, 3) = {20, 255, 30};
    const auto pixels = FramePixels::make(picture, "p", {}, true);
    ASSERT_TRUE(pixels.has_value());
    for (const int channel : {-1, 0, 1, 2}) {
        const cv::Mat plane = pixels->plane(channel);
        for (const auto& [x, y] : {std::pair(0, 0), std::pair(3, 2)})
            EXPECT_NEAR(pixels->value(x, y, channel), plane.at<unsigned char>(y, x), 0.51);
    }
    EXPECT_TRUE(pixels->saturated(3, 2, -1));
    EXPECT_TRUE(pixels->saturated(3, 2, 1));
    EXPECT_FALSE(pixels->saturated(3, 2, 0));
    EXPECT_FALSE(pixels->saturated(0, 0, -1));
}

}  // namespace
}  // namespace skincal::testing
