#include "core/vision/spot_fit.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"
#include "core/vision/spot_model.h"

namespace skincal {
namespace {

struct Drawn {
    SpotWindow window;
    Vector2d centre;
};

/// A noisy spot in an 11x11 window whose pixels end at `top`.
Drawn drawSpot(Random& random, double peak, double width, double top, double readNoise = 1.5, double gain = 0.02,
               double halo = 0.04) {
    constexpr int kSize = 11;
    Drawn drawn;
    drawn.window.x0 = 200;
    drawn.window.y0 = 100;
    drawn.centre = Vector2d(205 + random.uniform(-0.7, 0.7), 105 + random.uniform(-0.7, 0.7));
    drawn.window.value.resize(kSize, kSize);
    drawn.window.variance.resize(kSize, kSize);
    drawn.window.state.setConstant(kSize, kSize, PixelState::Good);
    for (int row = 0; row < kSize; ++row) {
        for (int col = 0; col < kSize; ++col) {
            const double r2 = (Vector2d(200 + col, 100 + row) - drawn.centre).squaredNorm() / (2 * width * width);
            const double clean = 1.5 + peak * (std::exp(-r2) + halo * std::exp(-r2 / 6.25));
            const double variance = readNoise * readNoise + gain * std::max(0.0, clean);
            double value = clean + std::sqrt(variance) * random.normal();
            if (value >= top) {
                value = top;
                drawn.window.state(row, col) = PixelState::Saturated;
            }
            drawn.window.value(row, col) = value;
            drawn.window.variance(row, col) = readNoise * readNoise + gain * std::max(0.0, value);
        }
    }
    return drawn;
}

struct Case {
    const char* name;
    double peak;
    double width;
    double top;
};

class SpotFitCases : public ::testing::TestWithParam<Case> {};

TEST_P(SpotFitCases, SigmaIsTheErrorThatHappens) {
    const Case& c = GetParam();
    Random random(1, c.name);
    constexpr int kDraws = 1500;
    double normalised = 0;
    int count = 0;
    for (int i = 0; i < kDraws; ++i) {
        const Drawn drawn = drawSpot(random, c.peak, c.width, c.top);
        const auto fit = fitSpot(drawn.window);
        if (!fit)
            continue;
        normalised += (fit->centre - drawn.centre).squaredNorm() / (2 * fit->sigma_px * fit->sigma_px);
        EXPECT_EQ(fit->clipped, (drawn.window.state == PixelState::Saturated).any());
        ++count;
    }
    EXPECT_GE(count, kDraws * 99 / 100);
    EXPECT_NEAR(normalised / count, 1, 0.2);
}

INSTANTIATE_TEST_SUITE_P(Spots, SpotFitCases,
                         ::testing::Values(Case{"Faint", 30, 1.1, 1e9}, Case{"Medium", 90, 1.1, 1e9},
                                           Case{"Bright", 200, 1.2, 1e9}, Case{"Narrow", 120, 0.7, 1e9},
                                           Case{"Wide", 120, 2.2, 1e9}, Case{"JustClipped", 240, 1.1, 200},
                                           Case{"Clipped", 500, 1.1, 200}, Case{"FarClipped", 1500, 1.2, 200}),
                         [](const auto& c) { return std::string(c.param.name); });

TEST(SpotFit, RecoversShapeWithoutNoise) {
    Random random(2, "shape");
    for (int i = 0; i < 50; ++i) {
        const double peak = random.uniform(50, 200);
        const double width = random.uniform(0.8, 1.8);
        const Drawn drawn = drawSpot(random, peak, width, 1e9, 0.05, 0);
        const auto fit = fitSpot(drawn.window);
        ASSERT_TRUE(fit.has_value());
        EXPECT_LT((fit->centre - drawn.centre).norm(), 0.01);
        EXPECT_NEAR(fit->width_px, width, 0.05);
        EXPECT_NEAR(fit->amplitude, peak, 0.05 * peak);
        EXPECT_NEAR(fit->flux(), 6.2832 * peak * width * width, 0.1 * fit->flux());
    }
}

TEST(SpotFit, ClippedAmplitudeIsExtrapolated) {
    Random random(3, "clipped");
    for (int i = 0; i < 30; ++i) {
        const Drawn drawn = drawSpot(random, 600, 1.1, 200);
        const auto fit = fitSpot(drawn.window);
        ASSERT_TRUE(fit.has_value());
        EXPECT_TRUE(fit->clipped);
        EXPECT_NEAR(fit->amplitude, 600, 200);
    }
}

TEST(SpotModel, DerivativesAreThoseOfTheFunction) {
    Random random(4, "derivatives");
    for (int i = 0; i < 20; ++i) {
        Drawn drawn = drawSpot(random, random.uniform(50, 400), random.uniform(0.8, 2), 200);
        drawn.window.state(2, 3) = PixelState::Excluded;
        const SpotModel model(drawn.window, SpotPrior{}, 2.5);
        SpotParameters p;
        p << drawn.centre.x() + random.uniform(-0.5, 0.5), drawn.centre.y() + random.uniform(-0.5, 0.5),
            std::log(random.uniform(50, 400)), random.uniform(-0.3, 0.6), random.uniform(-5, 5), random.uniform(0, 0.1);
        const SpotModel::Normals normals = model.at(p);
        for (Eigen::Index k = 0; k < 6; ++k) {
            constexpr double kStep = 1e-6;
            SpotParameters above = p;
            SpotParameters below = p;
            above[k] += kStep;
            below[k] -= kStep;
            const double numeric = (model.at(above).cost - model.at(below).cost) / (4 * kStep);
            EXPECT_NEAR(normals.g[k], numeric, 1e-5 * (1 + std::abs(numeric)) * std::sqrt(normals.N(k, k))) << k;
        }
    }
}

TEST(SpotModel, NormalMatrixIsHalfTheCurvatureWhereNothingIsLeftOver) {
    SpotWindow window{0, 0, Eigen::ArrayXXd(11, 11), Eigen::ArrayXXd::Constant(11, 11, 2.0), {}};
    window.state.setConstant(11, 11, PixelState::Good);
    SpotPrior prior;
    SpotParameters p;
    p << 5.2, 4.9, std::log(150.0), prior.logWidth, 2, prior.halo;
    const double s = std::exp(p[3]);
    for (int row = 0; row < 11; ++row) {
        for (int col = 0; col < 11; ++col) {
            const double r2 = (Vector2d(col, row) - p.head<2>()).squaredNorm() / (2 * s * s);
            window.value(row, col) = 2 + 150 * (std::exp(-r2) + prior.halo * std::exp(-r2 / 6.25));
        }
    }
    const SpotModel model(window, prior, 2.5);
    const SpotModel::Normals normals = model.at(p);
    EXPECT_NEAR(normals.cost, 0, 1e-18);
    Random random(5, "curvature");
    for (int i = 0; i < 20; ++i) {
        SpotParameters d;
        for (Eigen::Index k = 0; k < 6; ++k)
            d[k] = 1e-4 * random.normal() / std::sqrt(normals.N(k, k));
        const double curved = model.at(p + d).cost + model.at(p - d).cost;
        EXPECT_NEAR(curved / (2 * d.dot(normals.N * d)), 1, 1e-4);
    }
    const SpotModel::Normals least = model.minimise(p);
    EXPECT_LT(least.cost, 1e-9);
}

TEST(SpotFit, NoiseIsNoSpot) {
    Random random(5, "noise");
    int found = 0;
    for (int i = 0; i < 500; ++i)
        found += fitSpot(drawSpot(random, 0, 1.1, 1e9).window).has_value() ? 1 : 0;
    EXPECT_EQ(found, 0);
}

TEST(SpotFit, DarkWindowHasNoLight) {
    Random random(6, "dark");
    Drawn drawn = drawSpot(random, 0, 1.1, 1e9);
    drawn.window.value.setConstant(3);
    const auto fit = fitSpot(drawn.window);
    ASSERT_FALSE(fit.has_value());
    EXPECT_EQ(fit.error(), SpotFitError::NoLight);
}

TEST(SpotFit, EdgeIsNoSpot) {
    Random random(7, "edge");
    for (int i = 0; i < 20; ++i) {
        Drawn drawn = drawSpot(random, 0, 1.1, 1e9);
        drawn.window.value.rightCols(5) += 80;
        EXPECT_FALSE(fitSpot(drawn.window).has_value());
    }
}

TEST(SpotFit, HotPixelIsNoSpot) {
    Random random(8, "hot");
    Drawn drawn = drawSpot(random, 0, 1.1, 1e9);
    drawn.window.value(5, 5) += 150;
    const auto fit = fitSpot(drawn.window);
    ASSERT_FALSE(fit.has_value());
    EXPECT_EQ(fit.error(), SpotFitError::WrongShape);
}

TEST(SpotFit, LightFromBeyondTheWindowIsRefused) {
    Random random(9, "beyond");
    Drawn drawn = drawSpot(random, 0, 1.1, 1e9);
    for (int row = 0; row < 11; ++row) {
        for (int col = 0; col < 11; ++col)
            drawn.window.value(row, col) += 400 * std::exp(-0.5 * (std::pow(col - 13.0, 2) + std::pow(row - 5.0, 2)));
    }
    EXPECT_FALSE(fitSpot(drawn.window).has_value());
}

TEST(SpotFit, TooFewPixelsAreRefused) {
    Random random(10, "few");
    Drawn drawn = drawSpot(random, 150, 1.1, 1e9);
    drawn.window.state.topRows(10).setConstant(PixelState::Excluded);
    const auto fit = fitSpot(drawn.window);
    ASSERT_FALSE(fit.has_value());
    EXPECT_EQ(fit.error(), SpotFitError::TooFewPixels);
    drawn.window.state.setConstant(PixelState::Saturated);
    EXPECT_FALSE(fitSpot(drawn.window).has_value());
}

TEST(SpotFit, ExcludedPixelsDoNotCount) {
    Random random(11, "excluded");
    Drawn drawn = drawSpot(random, 150, 1.1, 1e9);
    const auto whole = fitSpot(drawn.window);
    drawn.window.value.row(0) = 1e6;
    drawn.window.state.row(0).setConstant(PixelState::Excluded);
    const auto fit = fitSpot(drawn.window);
    ASSERT_TRUE(whole.has_value() && fit.has_value());
    EXPECT_LT((whole->centre - fit->centre).norm(), 0.01);
}

/// Excludes what lies so near to the window's middle, as where the ground alone is clipped.
void blindMiddle(SpotWindow& window, double radius_px) {
    for (Eigen::Index row = 0; row < window.state.rows(); ++row) {
        for (Eigen::Index col = 0; col < window.state.cols(); ++col) {
            if ((Vector2d(static_cast<double>(col), static_cast<double>(row)) - Vector2d(5, 5)).norm() < radius_px)
                window.state(row, col) = PixelState::Excluded;
        }
    }
}

TEST(SpotFit, WhereTheMiddleIsBlindTheRimShowsLightAndPlace) {
    Random random(11, "blind middle");
    constexpr int kDraws = 600;
    int found = 0;
    double normalised = 0;
    for (int i = 0; i < kDraws; ++i) {
        Drawn drawn = drawSpot(random, 150, 0.95, 1e9, 0.3, 0);
        blindMiddle(drawn.window, 3);
        const auto fit = fitSpot(drawn.window);
        if (!fit)
            continue;
        ++found;
        normalised += (fit->centre - drawn.centre).squaredNorm() / (2 * fit->sigma_px * fit->sigma_px);
    }
    EXPECT_GE(found, kDraws * 95 / 100);
    EXPECT_NEAR(normalised / found, 1, 0.25);
    for (int i = 0; i < kDraws; ++i) {
        Drawn dark = drawSpot(random, 0, 1.2, 1e9, 0.4, 0);
        blindMiddle(dark.window, 3);
        EXPECT_FALSE(fitSpot(dark.window).has_value()) << i;
    }
    // Nor does a slope, as of an LED beside it.
    for (int i = 0; i < kDraws; ++i) {
        Drawn slope = drawSpot(random, 0, 1.2, 1e9, 0.4, 0);
        const Vector2d along(random.uniform(-2, 2), random.uniform(-2, 2));
        for (Eigen::Index row = 0; row < 11; ++row) {
            for (Eigen::Index col = 0; col < 11; ++col)
                slope.window.value(row, col) +=
                    along.dot(Vector2d(static_cast<double>(col - 5), static_cast<double>(row - 5)));
        }
        blindMiddle(slope.window, 3);
        EXPECT_FALSE(fitSpot(slope.window).has_value()) << i;
    }
}

TEST(SpotFit, ABlindMiddleIsNoNarrowCoreInAStrongHalo) {
    Random random(12, "narrow core");
    constexpr double kWidth = 1.09;
    for (int i = 0; i < 300; ++i) {
        Drawn drawn = drawSpot(random, random.uniform(250, 400), kWidth, random.uniform(100, 190), 0.25, 0, 0.02);
        blindMiddle(drawn.window, 2.1);
        const auto fit = fitSpot(drawn.window);
        ASSERT_TRUE(fit.has_value());
        EXPECT_NEAR(std::log(fit->width_px / kWidth), 0, 0.2) << i;
    }
}

TEST(SpotFit, MisuseThrows) {
    Random random(12, "misuse");
    Drawn drawn = drawSpot(random, 150, 1.1, 1e9);
    SpotFitOptions options;
    options.maxWidth_px = 0.1;
    EXPECT_THROW((void)fitSpot(drawn.window, options), std::logic_error);
    drawn.window.variance.resize(3, 3);
    EXPECT_THROW((void)fitSpot(drawn.window), std::logic_error);
}

TEST(SpotFit, EveryErrorHasAName) {
    for (const SpotFitError error :
         {SpotFitError::TooFewPixels, SpotFitError::NoLight, SpotFitError::WrongShape, SpotFitError::OutsideWindow})
        EXPECT_FALSE(sentenceOf(error).empty());
}

}  // namespace
}  // namespace skincal
