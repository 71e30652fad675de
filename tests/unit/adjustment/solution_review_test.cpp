#include "core/adjustment/solution_review.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "core/adjustment/pose_covariance.h"
#include "tests/unit/estimation/synthetic.h"

namespace skincal {
namespace {

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

SolutionReview review(const AdjustmentInput& input, const BodyState& state, const Gauge& gauge,
                      const AdjustmentOptions& options) {
    return reviewSolution(input, state, gauge, options).value();
}

TEST(SolutionReview, CovariancesAreThoseOfTheDenseInverse) {
    Random random(13, "covariances");
    const NoisyWorld noisy(random, noisyOptions(), 0.3e-3);
    const Gauge gauge{{0}, {}};
    const auto found = review(noisy.input, noisy.world.state(), gauge, plainSquares()).covariances;
    for (const std::size_t u : {0U, 7U, 19U}) {
        const auto expected =
            poseCovariance(noisy.input, noisy.world.state(), PosesOf::Modules, {u}, gauge, plainSquares());
        ASSERT_TRUE(expected);
        const Eigen::VectorXd scale = expected->diagonal().cwiseSqrt().cwiseInverse();
        const Eigen::MatrixXd difference = scale.asDiagonal() * (*found[u] - *expected) * scale.asDiagonal();
        EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-5) << u;
    }
    const auto byModule = review(noisy.input, noisy.world.state(), Gauge{{}, {3}}, plainSquares()).covariances;
    EXPECT_EQ(byModule[3]->norm(), 0) << "the gauge is certain";
    EXPECT_FALSE(reviewSolution(noisy.input, noisy.world.state(), Gauge{}, plainSquares()));
}

TEST(SolutionReview, FindsTheWeightsFromTheResidualsAlone) {
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
        const NoiseComponents found = review(input, state, Gauge{{0}, {}}, options).noise;
        options.pixelSigmaFactor *= found.pixel.factor();
        options.accelerometerSigma *= found.gravity.factor();
        options.linkSigma *= found.link.factor();
        options.biasSigma *= found.bias.factor();
        options.scaleSigma *= found.scale.factor();
    }
    EXPECT_NEAR(0.3 * options.pixelSigmaFactor, 0.08, 0.015);
    EXPECT_NEAR(options.accelerometerSigma, 0.05, 0.005);
    EXPECT_NEAR(options.linkSigma, 0.3e-3, 0.08e-3);
    EXPECT_NEAR(options.biasSigma, 0.2, 0.06);
}

/// The definition, by leaving a measurement out and solving again.
TEST(SolutionReview, DisagreementIsTheDistanceFromWhatTheOthersForecast) {
    Random random(17, "leave one out");
    const NoisyWorld noisy(random, noisyOptions(), 0.3e-3);
    const Gauge gauge{{0}, {}};
    AdjustmentOptions options = plainSquares();
    options.linkSigma = 0.3e-3;
    for (const double loss : {0.0, 3.0}) {
        options.linkLoss = loss;
        AdjustmentInput input = noisy.input;
        constexpr std::size_t kWrong = 4;
        input.links[kWrong].port_a += Vector3d(0.004, 0, 0.002);
        const BodyState state = adjustBody(input, noisy.world.state(), gauge, options).value().state;
        const double found = review(input, state, gauge, options).links[kWrong]->disagreement;

        AdjustmentInput others = input;
        others.links.erase(others.links.begin() + kWrong);
        const BodyState without = adjustBody(others, state, gauge, options).value().state;
        const PortPair& link = input.links[kWrong];
        const Isometry3d& T_r_a = *without.T_r_u[link.a];
        const Isometry3d& T_r_b = *without.T_r_u[link.b];
        const auto C = poseCovariance(others, without, PosesOf::Modules, {link.a, link.b}, gauge, options).value();
        Eigen::Matrix<double, 3, 12> J;
        J << -skew(T_r_a.linear() * link.port_a), Matrix3d::Identity(), skew(T_r_b.linear() * link.port_b),
            -Matrix3d::Identity();
        const Vector3d gap = T_r_a * link.port_a - T_r_b * link.port_b;
        const Matrix3d S = J * C * J.transpose() + options.linkSigma * options.linkSigma * Matrix3d::Identity();
        const double expected = gap.dot(S.inverse() * gap);
        EXPECT_GT(expected, 40);
        EXPECT_NEAR(found / expected, 1, loss > 0 ? 0.15 : 0.02) << "with loss " << loss;
    }
}

TEST(SolutionReview, RedundanciesAddUpToMeasurementsMinusUnknowns) {
    Random random(18, "redundancy");
    const NoisyWorld noisy(random, noisyOptions(), 0.3e-3);
    const Gauge gauge{{0}, {}};
    const auto solved = adjustBody(noisy.input, noisy.world.state(), gauge, plainSquares()).value();
    const SolutionReview found = review(noisy.input, solved.state, gauge, plainSquares());
    double sum = 0;
    for (const auto& list : {found.pixels, found.links}) {
        for (const auto& one : list)
            sum += one->redundancy;
    }
    for (const auto& ofModule : found.gravity) {
        for (const auto& one : ofModule)
            sum += one->redundancy;
    }
    const auto priors = static_cast<double>(6 * noisy.world.T_r_u.size());
    const double free = static_cast<double>(solved.summary.residuals) - static_cast<double>(solved.summary.parameters);
    EXPECT_LE(sum, free + 1e-6);
    EXPECT_GE(sum, free - priors) << "the rest is the priors'";
}

TEST(SolutionReview, WhatTheDataDoNotFixIsRefused) {
    Random random(15, "loose noise");
    const NoisyWorld noisy(random, noisyOptions(), 0);
    EXPECT_EQ(reviewSolution(noisy.input, noisy.world.state(), Gauge{}, plainSquares()).error().code,
              ErrorCode::DegeneratePoints);
}

TEST(SolutionReview, StopsWhereverItIsCancelled) {
    Random random(16, "cancelled review");
    const NoisyWorld noisy(random, noisyOptions(), 0);
    const Gauge gauge{{0}, {}};
    int polls = 0;
    int stopAt = -1;
    RunContext context;
    bool wasCancelled = false;
    context.isCancelled = [&] {
        wasCancelled = stopAt >= 0 && polls >= stopAt;
        polls += wasCancelled ? 0 : 1;
        return wasCancelled;
    };
    ASSERT_TRUE(reviewSolution(noisy.input, noisy.world.state(), gauge, plainSquares(), context));
    const int all = polls;
    EXPECT_GE(all, 4) << "before the factorisation, in the inverse, in the reviews and in the covariances";
    for (stopAt = 0; stopAt < all; ++stopAt) {
        polls = 0;
        wasCancelled = false;
        const auto review = reviewSolution(noisy.input, noisy.world.state(), gauge, plainSquares(), context);
        // How often it asks depends on how threads share the work: it may have been done before.
        if (review) {
            EXPECT_LE(polls, stopAt);
            EXPECT_FALSE(wasCancelled) << stopAt;
            continue;
        }
        EXPECT_EQ(review.error().code, ErrorCode::Cancelled);
    }
}

}  // namespace
}  // namespace skincal
