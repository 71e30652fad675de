#include "core/vision/late_pictures.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"
#include "tests/unit/vision/coded_book.h"

namespace skincal {
namespace {

/// Words of so many modules, and spots that show what was lit so many pictures before; room for other spots.
SpotScan scanOf(std::size_t count, int late, double noise, std::uint64_t seed, std::size_t others = 0) {
    SpotScan scan;
    scan.codebook = testing::codedBook(count, seed);
    const std::size_t planes = scan.codebook.planes();
    scan.series = SpotSeries(planes, count + others);
    scan.gains.assign(planes, 1);
    scan.sigma.assign(count + others, noise);
    Random random(seed, "late pictures");
    Eigen::MatrixXf& light = scan.series.light;
    light.setZero();
    scan.series.around.setConstant(50);
    for (std::size_t u = 0; u < count; ++u) {
        const double amplitude = 20 + 150 * random.uniform();
        for (Eigen::Index k = 0; k < light.rows(); ++k) {
            const auto& lit = scan.codebook.lit[u];
            const bool isLit = k >= late && std::count(lit.begin(), lit.end(), static_cast<std::size_t>(k - late)) > 0;
            light(k, static_cast<Eigen::Index>(u)) =
                static_cast<float>((isLit ? amplitude : 0) + noise * random.normal());
        }
    }
    return scan;
}

/// What of it blinks a word as it is.
std::size_t wordsIn(const SpotScan& scan) {
    const WordMatcher matcher(scan.codebook);
    std::size_t words = 0;
    for (std::size_t spot = 0; spot < scan.sigma.size(); ++spot) {
        const Eigen::VectorXd y = scan.levelled(spot);
        words += matcher.match({y.data(), static_cast<std::size_t>(y.size())}, scan.sigma[spot]).verdict ==
                         SeriesVerdict::Matched
                     ? 1
                     : 0;
    }
    return words;
}

TEST(LatePictures, AreToldByHowManyTheyAreLate) {
    for (std::uint64_t seed = 0; seed < 50; ++seed)
        for (const std::size_t modules : {7, 55, 300})
            for (const int late : {0, 1, 2}) {
                const SpotScan scan = scanOf(modules, late, 2, seed);
                const auto told = picturesLate(scan, wordsIn(scan));
                EXPECT_EQ(told.value_or(0), late) << modules << ", seed " << seed;
            }
}

TEST(LatePictures, WhatElseIsInAPictureDoesNotMakeItLate) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        constexpr Eigen::Index kOwn = 6;
        SpotScan scan = scanOf(kOwn, 0, 2, seed, 300);
        Random random(seed, "disturbances");
        Eigen::MatrixXf& light = scan.series.light;
        const Eigen::Index planes = light.rows();
        for (Eigen::Index spot = kOwn; spot < light.cols(); ++spot) {
            const auto from = static_cast<Eigen::Index>(random.index(static_cast<std::size_t>(planes)));
            for (Eigen::Index k = 0; k < planes; ++k) {
                const bool isBright = spot % 3 == 0   ? k >= from                // somebody has put something down
                                      : spot % 3 == 1 ? k % 7 < 3                // a lamp
                                                      : random.uniform() < 0.5;  // a screen
                light(k, spot) = static_cast<float>((isBright ? 100 : 0) + 2 * random.normal());
            }
        }
        EXPECT_EQ(picturesLate(scan, wordsIn(scan)), std::nullopt) << seed;
    }
}

TEST(LatePictures, ManySpotsThatBlinkOneWordAreALampsAndNotLate) {
    for (std::uint64_t seed = 0; seed < 30; ++seed)
        for (const auto& [own, others] : {std::pair(2, 300), std::pair(6, 300), std::pair(6, 1200)}) {
            SpotScan scan = scanOf(static_cast<std::size_t>(own), 0, 2, seed, static_cast<std::size_t>(others));
            const SpotScan late = scanOf(static_cast<std::size_t>(own), 1, 2, seed);
            for (Eigen::Index spot = own; spot < scan.series.light.cols(); ++spot)
                scan.series.light.col(spot) = late.series.light.col(0);
            EXPECT_EQ(picturesLate(scan, wordsIn(scan)), std::nullopt) << own << ", " << others << ", seed " << seed;
        }
}

// Half of the spots end in the middle, and as many begin there.
TEST(LatePictures, AKnockIsNoLateness) {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        constexpr Eigen::Index kOwn = 40;
        SpotScan scan = scanOf(kOwn, 0, 2, seed, kOwn);
        Eigen::MatrixXf& light = scan.series.light;
        const Eigen::Index half = light.rows() / 2;
        light.rightCols(kOwn) = light.leftCols(kOwn);
        light.topRightCorner(half, kOwn).setZero();
        light.bottomLeftCorner(light.rows() - half, kOwn).setZero();
        EXPECT_EQ(picturesLate(scan, wordsIn(scan)), std::nullopt) << seed;
    }
}

TEST(LatePictures, WithoutPicturesOfAllLedsNothingIsTold) {
    std::vector<ModuleId> modules{ModuleId(1), ModuleId(2), ModuleId(3)};
    std::vector<FrameInfo> frames(7);
    for (std::size_t u = 0; u < modules.size(); ++u)
        frames[2 * u + 1].lit = {{modules[u], std::nullopt}};
    SpotScan scan;
    scan.codebook = makeCodebook(litWords(modules, frames).value());
    scan.series = SpotSeries(frames.size(), 40);
    scan.series.light = Eigen::MatrixXf::Random(7, 40);
    scan.gains.assign(frames.size(), 1);
    scan.sigma.assign(40, 0.1);
    EXPECT_EQ(picturesLate(scan, 0), std::nullopt);
}

}  // namespace
}  // namespace skincal
