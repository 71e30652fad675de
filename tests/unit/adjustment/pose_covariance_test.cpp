#include "core/adjustment/pose_covariance.h"

#include <gtest/gtest.h>

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
    const auto bound = poseCovariance(input, world.state(), ofViews ? PosesOf::Views : PosesOf::Modules, which,
                                      Gauge{{0}, {}}, adjustment);
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

TEST(PoseCovariance, ModulesScatterAsForecast) {
    expectBoundMet(boundOptions(), false);
}

TEST(PoseCovariance, ViewsScatterAsForecast) {
    expectBoundMet(boundOptions(), true);
}

TEST(PoseCovariance, WhatTheDataDoNotFixIsRefused) {
    Random random(11, "loose");
    SyntheticOptions options = boundOptions();
    options.poses = 0;
    const SyntheticWorld world = makeWorld(random, options);
    const GravityTable gravity(world.measurements.skin, {});
    AdjustmentInput input = world.input(gravity);
    input.links.clear();
    // A module that only two pixels of one view tell about.
    std::erase_if(input.pixels, [](const PixelObservation& o) { return o.module == 1 && o.view != 0; });
    const auto loose = poseCovariance(input, world.state(), PosesOf::Modules, {1}, Gauge{{0}, {}});
    ASSERT_FALSE(loose);
    EXPECT_EQ(loose.error().code, ErrorCode::DegeneratePoints);
    EXPECT_EQ(poseCovariance(input, world.state(), PosesOf::Views, {1}, Gauge{}).error().code,
              ErrorCode::DegeneratePoints);
}

TEST(PoseCovariance, BetweenTwoModulesDoesNotDependOnTheGauge) {
    Random random(16, "between");
    const SyntheticWorld world = makeWorld(random, boundOptions());
    const GravityTable gravity(world.measurements.skin, world.measurements.gravity);
    const AdjustmentInput input = world.input(gravity);
    AdjustmentOptions options;
    options.pixelLoss = options.gravityLoss = options.linkLoss = 0;
    std::vector<Matrix6d> found;
    for (const Gauge& gauge : {Gauge{{0}, {}}, Gauge{{1}, {}}, Gauge{{}, {1}}, Gauge{{}, {3}}}) {
        const auto both = poseCovariance(input, world.state(), PosesOf::Modules, {1, 2}, gauge, options);
        ASSERT_TRUE(both);
        found.push_back(relativeCovariance(world.T_r_u[1], world.T_r_u[2], *both));
    }
    const Vector6d scale = found[0].diagonal().cwiseSqrt().cwiseInverse();
    for (const Matrix6d& other : found)
        EXPECT_LT((scale.asDiagonal() * (other - found[0]) * scale.asDiagonal()).cwiseAbs().maxCoeff(), 1e-4);
}

}  // namespace
}  // namespace skincal
