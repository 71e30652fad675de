#include "core/adjustment/adjustment_statistics.h"

#include <gtest/gtest.h>

#include "core/adjustment/selected_inverse.h"
#include "tests/unit/estimation/synthetic.h"

namespace skincal {
namespace {

/// Monte Carlo: sample covariance of the errors against the bound.
void expectBoundMet(const SyntheticOptions& options, bool ofViews) {
    Random random(10, "bound");
    SyntheticOptions exact = options;
    exact.pixelNoise = 0;
    exact.accelerometerNoise = 0;
    const SyntheticWorld world = makeWorld(random, exact);
    const GravityTable exactGravity(world.measurements.skin, world.measurements.gravity);
    AdjustmentOptions adjustment;
    adjustment.accelerometerSigma = options.accelerometerNoise;
    adjustment.pixelSigmaFloor_px = 1e-3;
    adjustment.pixelLoss = adjustment.gravityLoss = adjustment.linkLoss = 0;
    AdjustmentInput input = world.input(exactGravity);
    // Play in the links is drawn as well: the true ports are off by it.
    for (PixelObservation& o : input.pixels)
        o.sigma_px = options.pixelNoise;
    const std::vector<std::size_t> which{1, 2};
    const auto bound = ofViews ? viewPoseBound(input, world.state(), which, Gauge{{0}, {}}, adjustment)
                               : modulePoseBound(input, world.state(), which, Gauge{{0}, {}}, adjustment);
    ASSERT_TRUE(bound);
    ASSERT_EQ(bound->rows(), 12);
    EXPECT_LT((*bound - bound->transpose()).norm(), 1e-9 * bound->norm());

    constexpr int kRounds = 150;
    Eigen::Matrix<double, 12, 1> squares = Eigen::Matrix<double, 12, 1>::Zero();
    for (int round = 0; round < kRounds; ++round) {
        AdjustmentInput noisy = input;
        for (PixelObservation& o : noisy.pixels)
            o.pixel += options.pixelNoise * Vector2d(random.normal(), random.normal());
        for (PortPair& link : noisy.links)
            link.port_a += world.T_r_u[link.a].linear().transpose() * random.normal3() * adjustment.linkSigma;
        auto readings = world.measurements.gravity;
        for (GravityReading& reading : readings)
            reading.acceleration += options.accelerometerNoise * random.normal3();
        const GravityTable gravity(world.measurements.skin, readings);
        noisy.gravity = &gravity;
        // Priors are measurements, too: the truth is drawn from them by shifting what they expect.
        const auto found = adjustBody(noisy, world.state(), Gauge{{0}, {}}, adjustment).value();
        for (std::size_t i = 0; i < which.size(); ++i) {
            const Isometry3d& T = ofViews ? *found.state.T_r_v[which[i]] : *found.state.T_r_u[which[i]];
            const Isometry3d& truth = ofViews ? world.T_r_v[which[i]] : world.T_r_u[which[i]];
            const auto row = static_cast<Eigen::Index>(6 * i);
            squares.segment<3>(row) += so3Log(T.linear() * truth.linear().transpose()).cwiseAbs2() / kRounds;
            squares.segment<3>(row + 3) += (T.translation() - truth.translation()).cwiseAbs2() / kRounds;
        }
    }
    // Traces rather than single entries: 150 rounds fix one variance to 12 %, three of them to some 7 %.
    for (Eigen::Index block = 0; block < 12; block += 3)
        EXPECT_NEAR(squares.segment<3>(block).sum() / bound->diagonal().segment<3>(block).sum(), 1, 0.3) << block;
}

SyntheticOptions boundOptions() {
    SyntheticOptions options;
    options.patches = {{2, 2, 0.08}};
    options.views = 3;
    options.poses = 8;
    options.pixelNoise = 0.1;
    options.accelerometerNoise = 0.03;
    return options;
}

TEST(PoseBounds, ModulesScatterAsForecast) {
    expectBoundMet(boundOptions(), false);
}

TEST(PoseBounds, ViewsScatterAsForecast) {
    expectBoundMet(boundOptions(), true);
}

TEST(PoseBounds, WhatTheDataDoNotFixIsRefused) {
    Random random(11, "loose");
    SyntheticOptions options = boundOptions();
    options.poses = 0;
    const SyntheticWorld world = makeWorld(random, options);
    const GravityTable gravity(world.measurements.skin, {});
    AdjustmentInput input = world.input(gravity);
    input.links.clear();
    // A module that only two pixels of one view tell about.
    std::erase_if(input.pixels, [](const PixelObservation& o) { return o.module == 1 && o.view != 0; });
    const auto loose = modulePoseBound(input, world.state(), {1}, Gauge{{0}, {}});
    ASSERT_FALSE(loose);
    EXPECT_EQ(loose.error().code, ErrorCode::DegeneratePoints);
    EXPECT_EQ(viewPoseBound(input, world.state(), {1}, Gauge{}).error().code, ErrorCode::DegeneratePoints);
}

TEST(SelectedInverse, HasTheEntriesOfTheDenseOne) {
    Random random(12, "selected");
    for (int round = 0; round < 20; ++round) {
        const auto n = static_cast<Eigen::Index>(2 + random.index(40));
        Eigen::MatrixXd dense = Eigen::MatrixXd::Identity(n, n);
        for (Eigen::Index k = 0; k < 3 * n; ++k) {
            const auto i = static_cast<Eigen::Index>(random.index(static_cast<std::size_t>(n)));
            const auto j = static_cast<Eigen::Index>(random.index(static_cast<std::size_t>(n)));
            Eigen::VectorXd v = Eigen::VectorXd::Zero(n);
            v[i] = random.normal();
            v[j] += random.normal();
            dense += v * v.transpose();
        }
        const Eigen::SparseMatrix<double> A = dense.sparseView();
        const SparseCholesky factor(A);
        const SelectedInverse inverse(factor);
        const Eigen::MatrixXd expected = dense.inverse();
        for (Eigen::Index i = 0; i < n; ++i) {
            for (Eigen::Index j = 0; j < n; ++j) {
                if (dense(i, j) != 0) {
                    EXPECT_NEAR(inverse(i, j), expected(i, j), 1e-10 * expected.norm());
                }
            }
        }
    }
    const SparseCholesky two(Eigen::MatrixXd(Eigen::Vector2d(4, 9).asDiagonal()).sparseView());
    EXPECT_THROW((void)SelectedInverse(two)(0, 1), std::out_of_range);
    EXPECT_DOUBLE_EQ(SelectedInverse(two)(1, 1), 1.0 / 9);
}

struct NoisyWorld {
    SyntheticWorld world;
    GravityTable gravity;
    AdjustmentInput input;

    NoisyWorld(Random& random, const SyntheticOptions& options, double play)
        : world(makeWorld(random, options)),
          gravity(world.measurements.skin, world.measurements.gravity),
          input(world.input(gravity)) {
        for (PortPair& link : input.links)
            link.port_a += play * random.normal3();
    }
};

SyntheticOptions noisyOptions() {
    SyntheticOptions options;
    options.patches = {{5, 4, 0.08}};
    options.views = 6;
    options.poses = 12;
    options.pixelNoise = 0.08;
    options.accelerometerNoise = 0.05;
    options.bias = 0.2;
    options.scale = 0.01;
    return options;
}

AdjustmentOptions plainSquares() {
    AdjustmentOptions options;
    options.pixelLoss = options.gravityLoss = options.linkLoss = 0;
    options.pixelSigmaFloor_px = 1e-3;
    return options;
}

TEST(ModuleCovariances, AreThoseOfTheGeneralSolver) {
    Random random(13, "covariances");
    const NoisyWorld noisy(random, noisyOptions(), 0.3e-3);
    const Gauge gauge{{0}, {}};
    const auto found = moduleCovariances(noisy.input, noisy.world.state(), gauge, plainSquares());
    ASSERT_TRUE(found);
    for (const std::size_t u : {0U, 7U, 19U}) {
        const auto expected = modulePoseBound(noisy.input, noisy.world.state(), {u}, gauge, plainSquares());
        ASSERT_TRUE(expected);
        const Eigen::VectorXd scale = expected->diagonal().cwiseSqrt().cwiseInverse();
        const Eigen::MatrixXd difference = scale.asDiagonal() * (*(*found)[u] - *expected) * scale.asDiagonal();
        EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-5) << u;
    }
    const auto byModule = moduleCovariances(noisy.input, noisy.world.state(), Gauge{{}, {3}}, plainSquares());
    ASSERT_TRUE(byModule);
    EXPECT_EQ((*byModule)[3]->norm(), 0) << "the gauge is certain";
    EXPECT_FALSE(moduleCovariances(noisy.input, noisy.world.state(), Gauge{}, plainSquares()));
}

TEST(EstimateNoise, FindsTheWeightsFromTheResidualsAlone) {
    Random random(14, "weights");
    const NoisyWorld noisy(random, noisyOptions(), 0.3e-3);
    AdjustmentInput input = noisy.input;
    for (PixelObservation& o : input.pixels)
        o.sigma_px = 0.3;  // said to be four times what it is
    AdjustmentOptions options = plainSquares();
    options.accelerometerSigma = 0.01;
    options.linkSigma = 1e-3;
    BodyState state = noisy.world.state();
    for (int i = 0; i < 10; ++i) {
        state = adjustBody(input, state, Gauge{{0}, {}}, options).value().state;
        const NoiseFactors factors = estimateNoise(input, state, Gauge{{0}, {}}, options).value();
        options.pixelSigmaFactor *= factors.pixel;
        options.accelerometerSigma *= factors.accelerometer;
        options.linkSigma *= factors.link;
        options.biasSigma *= factors.bias;
        options.scaleSigma *= factors.scale;
    }
    EXPECT_NEAR(0.3 * options.pixelSigmaFactor, 0.08, 0.015);
    EXPECT_NEAR(options.accelerometerSigma, 0.05, 0.005);
    EXPECT_NEAR(options.linkSigma, 0.3e-3, 0.08e-3);
    EXPECT_NEAR(options.biasSigma, 0.2, 0.06);
    // The same again, to the last bit.
    const NoiseFactors a = estimateNoise(input, state, Gauge{{0}, {}}, options).value();
    const NoiseFactors b = estimateNoise(input, state, Gauge{{0}, {}}, options).value();
    EXPECT_EQ(a.pixel, b.pixel);
    EXPECT_EQ(a.link, b.link);
}

TEST(EstimateNoise, WhatTheDataDoNotFixIsRefused) {
    Random random(15, "loose noise");
    const NoisyWorld noisy(random, noisyOptions(), 0);
    EXPECT_EQ(estimateNoise(noisy.input, noisy.world.state(), Gauge{}, plainSquares()).error().code,
              ErrorCode::DegeneratePoints);
    EXPECT_THROW((void)estimateNoise(noisy.input, noisy.world.state(), Gauge{{0}, {}}, plainSquares(), {0, 12}),
                 std::logic_error);
}

}  // namespace
}  // namespace skincal
