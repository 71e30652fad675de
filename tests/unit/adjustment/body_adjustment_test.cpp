#include "core/adjustment/body_adjustment.h"

#include <gtest/gtest.h>

#include "tests/unit/estimation/synthetic.h"

namespace skincal {
namespace {

SyntheticOptions twoPatches() {
    SyntheticOptions options;
    options.patches = {{3, 3, 0.08}, {3, 2, 0, makeIsometry(so3Exp({0.3, 0.2, 0.4}), {0.15, 0.02, -0.01}), true}};
    options.views = 3;
    options.poses = 8;
    return options;
}

BodyState disturbed(Random& random, const BodyState& truth, std::size_t fixedView) {
    BodyState start = truth;
    for (auto& T : start.T_r_u)
        T = perturbed(random, *T, 0.05, 0.003);
    for (std::size_t v = 0; v < start.T_r_v.size(); ++v) {
        if (v != fixedView)
            start.T_r_v[v] = perturbed(random, *start.T_r_v[v], 0.02, 0.005);
    }
    for (AccelerometerCalibration& c : start.accelerometers)
        c = {};
    start.up_r.clear();
    return start;
}

TEST(AdjustBody, RecoversTheTruthFromAPerturbedStart) {
    Random random(1, "recover");
    for (int i = 0; i < 5; ++i) {
        const SyntheticWorld world = makeWorld(random, twoPatches());
        const GravityTable gravity(world.measurements.skin, world.measurements.gravity);
        const AdjustmentInput input = world.input(gravity);
        const auto found = adjustBody(input, disturbed(random, world.state(), 0), Gauge{{0}, {}});
        ASSERT_TRUE(found) << found.error().message();
        EXPECT_TRUE(found->summary.usable);
        EXPECT_GT(found->summary.iterations, 1);
        EXPECT_LT(found->summary.finalCost, 1e-4);
        EXPECT_GT(found->summary.initialCost, 1);
        EXPECT_EQ(found->summary.residuals, 2 * input.pixels.size() + 3 * world.measurements.gravity.size() +
                                                3 * input.links.size() + 6 * world.T_r_u.size());
        EXPECT_LT(largestDifference(found->state.T_r_u, world.T_r_u).angle, 1e-4);
        EXPECT_LT(largestDifference(found->state.T_r_u, world.T_r_u).distance, 1e-5);
        EXPECT_LT(largestDifference(found->state.T_r_v, world.T_r_v).distance, 1e-4);
        for (std::size_t p = 0; p < world.up_r.size(); ++p)
            EXPECT_LT((*found->state.up_r[0][p] - world.up_r[p]).norm(), 1e-4);
    }
}

TEST(AdjustBody, TheGaugeKeepsItsPose) {
    Random random(2, "gauge");
    const SyntheticWorld world = makeWorld(random, twoPatches());
    const GravityTable gravity(world.measurements.skin, world.measurements.gravity);
    const AdjustmentInput input = world.input(gravity);
    const BodyState start = disturbed(random, world.state(), 99);
    const auto byView = adjustBody(input, start, Gauge{{2}, {}}).value();
    EXPECT_LT(poseDifference(*byView.state.T_r_v[2], *start.T_r_v[2]).angle, 1e-12);
    EXPECT_EQ(byView.state.T_r_v[2]->translation(), start.T_r_v[2]->translation());
    const auto byModule = adjustBody(input, start, Gauge{{}, {4}}).value();
    EXPECT_LT(poseDifference(*byModule.state.T_r_u[4], *start.T_r_u[4]).angle, 1e-12);
    EXPECT_EQ(byModule.state.T_r_u[4]->translation(), start.T_r_u[4]->translation());
    // Both give the same body, only placed elsewhere.
    const Isometry3d T = *byModule.state.T_r_u[4] * byView.state.T_r_u[4]->inverse();
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
        EXPECT_LT(poseDifference(T * *byView.state.T_r_u[u], *byModule.state.T_r_u[u]).distance, 1e-4);
}

TEST(AdjustBody, CalibratesAccelerometersUnlessToldNotTo) {
    Random random(3, "sensors");
    SyntheticOptions options = twoPatches();
    options.bias = 0.3;
    options.scale = 0.01;
    options.poses = 15;
    const SyntheticWorld world = makeWorld(random, options);
    const GravityTable gravity(world.measurements.skin, world.measurements.gravity);
    const AdjustmentInput input = world.input(gravity);
    AdjustmentOptions plain;
    plain.accelerometerSigma = 1e-3;
    const auto found = adjustBody(input, disturbed(random, world.state(), 0), Gauge{{0}, {}}, plain).value();
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u) {
        EXPECT_LT((found.state.accelerometers[u].bias - world.accelerometers[u].bias).norm(), 0.01);
        EXPECT_LT((found.state.accelerometers[u].scale - world.accelerometers[u].scale).norm(), 0.002);
    }
    AdjustmentOptions asIs;
    asIs.calibrateAccelerometers = false;
    const auto kept = adjustBody(input, disturbed(random, world.state(), 0), Gauge{{0}, {}}, asIs).value();
    for (const AccelerometerCalibration& c : kept.state.accelerometers) {
        EXPECT_EQ(c.bias, Vector3d::Zero());
        EXPECT_EQ(c.scale, Vector3d::Ones());
    }
}

TEST(AdjustBody, OutliersWeighLittle) {
    Random random(4, "outliers");
    SyntheticOptions options = twoPatches();
    options.pixelNoise = 0.05;
    options.outliers = 0.1;
    options.views = 5;
    const SyntheticWorld world = makeWorld(random, options);
    const GravityTable gravity(world.measurements.skin, world.measurements.gravity);
    const auto robust = adjustBody(world.input(gravity), world.state(), Gauge{{0}, {}}).value();
    AdjustmentOptions squares;
    squares.pixelLoss = squares.gravityLoss = squares.linkLoss = 0;
    const auto plain = adjustBody(world.input(gravity), world.state(), Gauge{{0}, {}}, squares).value();
    EXPECT_LT(largestDifference(robust.state.T_r_u, world.T_r_u).distance, 1e-3);
    EXPECT_GT(largestDifference(plain.state.T_r_u, world.T_r_u).distance,
              3 * largestDifference(robust.state.T_r_u, world.T_r_u).distance);
}

TEST(AdjustBody, WhatHasNoPoseTakesNoPart) {
    Random random(5, "absent");
    const SyntheticWorld world = makeWorld(random, twoPatches());
    const GravityTable gravity(world.measurements.skin, world.measurements.gravity);
    BodyState start = world.state();
    start.T_r_u[3].reset();
    start.T_r_v[1].reset();
    const auto found = adjustBody(world.input(gravity), start, Gauge{{0}, {}}).value();
    EXPECT_FALSE(found.state.T_r_u[3]);
    EXPECT_FALSE(found.state.T_r_v[1]);
    EXPECT_LT(poseDifference(*found.state.T_r_u[2], world.T_r_u[2]).distance, 1e-5);
}

TEST(AdjustBody, CancelledOrNothingToAdjust) {
    Random random(6, "cancel");
    const SyntheticWorld world = makeWorld(random, twoPatches());
    const GravityTable gravity(world.measurements.skin, world.measurements.gravity);
    const AdjustmentInput input = world.input(gravity);
    RunContext context;
    context.isCancelled = [] { return true; };
    EXPECT_EQ(adjustBody(input, world.state(), Gauge{{0}, {}}, {}, context).error().code, ErrorCode::Cancelled);
    // In the middle of the iterations, too.
    int calls = 0;
    context.isCancelled = [&] { return ++calls > 2; };
    const BodyState start = disturbed(random, world.state(), 0);
    EXPECT_EQ(adjustBody(input, start, Gauge{{0}, {}}, {}, context).error().code, ErrorCode::Cancelled);

    const GravityTable silent(world.measurements.skin, {});
    AdjustmentInput nothing = input;
    nothing.gravity = &silent;
    nothing.pixels.clear();
    nothing.links.clear();
    EXPECT_EQ(adjustBody(nothing, world.state(), Gauge{{0}, {}}).error().code, ErrorCode::TooFewPoints);
    EXPECT_EQ(adjustBody(input, world.state(), Gauge{}).error().code, ErrorCode::TooFewPoints);
}

TEST(AdjustBody, BrokenContractsThrow) {
    Random random(7, "contract");
    const SyntheticWorld world = makeWorld(random, twoPatches());
    const GravityTable gravity(world.measurements.skin, world.measurements.gravity);
    AdjustmentInput input = world.input(gravity);
    BodyState state = world.state();
    const auto adjust = [&](const AdjustmentOptions& options = {}) {
        (void)adjustBody(input, state, Gauge{{0}, {}}, options);
    };
    std::vector<AdjustmentOptions> bad(10);
    bad[0].accelerometerSigma = 0;
    bad[1].linkSigma = 0;
    bad[2].biasSigma = 0;
    bad[3].scaleSigma = -1;
    bad[4].gravity = 0;
    bad[5].pixelSigmaFloor_px = 0;
    bad[6].pixelLoss = -1;
    bad[7].gravityLoss = -1;
    bad[8].linkLoss = -1;
    bad[9].maxIterations = 0;
    for (const AdjustmentOptions& options : bad)
        EXPECT_THROW(adjust(options), std::logic_error);
    input.camera = nullptr;
    EXPECT_THROW(adjust(), std::logic_error);
    input = world.input(gravity);
    input.gravityGroup.pop_back();
    EXPECT_THROW(adjust(), std::logic_error);
    input = world.input(gravity);
    state.accelerometers.pop_back();
    EXPECT_THROW(adjust(), std::logic_error);
}

TEST(PixelResidual, IsMeasuredMinusPredicted) {
    Random random(8, "residual");
    const SyntheticWorld world = makeWorld(random, twoPatches());
    const GravityTable gravity(world.measurements.skin, world.measurements.gravity);
    const AdjustmentInput input = world.input(gravity);
    BodyState state = world.state();
    PixelObservation o = input.pixels.at(5);
    EXPECT_LT(pixelResidual(input, state, o)->norm(), 1e-9);
    o.pixel += Vector2d(3, -4);
    EXPECT_LT((*pixelResidual(input, state, o) - Vector2d(3, -4)).norm(), 1e-9);
    BodyState behind = state;
    behind.T_r_v[o.view]->linear() = behind.T_r_v[o.view]->linear() * so3Exp({3.14, 0, 0});
    EXPECT_FALSE(pixelResidual(input, behind, o));
    state.T_r_u[o.module].reset();
    EXPECT_FALSE(pixelResidual(input, state, o));
    state = world.state();
    state.T_r_v[o.view].reset();
    EXPECT_FALSE(pixelResidual(input, state, o));
}

TEST(EstimateUpDirections, UndoesCalibrationAndRotation) {
    Random random(9, "up");
    SyntheticOptions options = twoPatches();
    options.bias = 0.3;
    options.scale = 0.02;
    const SyntheticWorld world = makeWorld(random, options);
    const GravityTable gravity(world.measurements.skin, world.measurements.gravity);
    AdjustmentInput input = world.input(gravity);
    for (std::size_t u = 0; u < input.gravityGroup.size(); ++u)
        input.gravityGroup[u] = world.patchOf[u];
    BodyState state = world.state();
    for (std::size_t u = 0; u < state.T_r_u.size(); ++u) {
        if (world.patchOf[u] == 1)
            state.T_r_u[u].reset();
    }
    estimateUpDirections(input, state);
    ASSERT_EQ(state.up_r.size(), 2U);
    for (std::size_t p = 0; p < world.up_r.size(); ++p) {
        EXPECT_LT((*state.up_r[0][p] - world.up_r[p]).norm(), 1e-9);
        EXPECT_FALSE(state.up_r[1][p]);
    }
}

}  // namespace
}  // namespace skincal
