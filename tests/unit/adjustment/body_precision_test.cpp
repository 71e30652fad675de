#include "core/adjustment/body_precision.h"

#include <gtest/gtest.h>

#include <numeric>

#include "core/adjustment/pose_covariance.h"
#include "tests/unit/estimation/synthetic.h"

namespace skincal {
namespace {

struct Bench {
    SyntheticWorld world;
    GravityTable gravity;
    AdjustmentInput input;

    Bench(Random& random, const SyntheticOptions& options)
        : world(makeWorld(random, options)),
          gravity(world.measurements.skin, world.measurements.gravity),
          input(world.input(gravity)) {}
};

SyntheticOptions smallBody() {
    SyntheticOptions options;
    options.patches = {{4, 3, 0.08}};
    options.views = 4;
    options.poses = 8;
    return options;
}

AdjustmentOptions plainSquares() {
    AdjustmentOptions options;
    options.pixelLoss = options.gravityLoss = options.linkLoss = 0;
    return options;
}

/// Positions of all modules, one below the other, after the similarity (or with unit scale the rigid motion) that fits
/// them onto `onto` best was taken out, to first order by solving the least squares problem in full.
Eigen::VectorXd residualAfterFit(const Eigen::VectorXd& error, const std::vector<Isometry3d>& T_r_u, bool withScale,
                                 double* scale = nullptr) {
    Vector3d mean = Vector3d::Zero();
    for (const Isometry3d& T : T_r_u)
        mean += T.translation() / static_cast<double>(T_r_u.size());
    Eigen::MatrixXd A(3 * T_r_u.size(), withScale ? 7 : 6);
    for (std::size_t u = 0; u < T_r_u.size(); ++u) {
        const auto row = static_cast<Eigen::Index>(3 * u);
        const Vector3d p = T_r_u[u].translation() - mean;
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            A.block<3, 1>(row, axis) = Vector3d::Unit(axis);
            A.block<3, 1>(row, 3 + axis) = Vector3d::Unit(axis).cross(p);
        }
        if (withScale)
            A.block<3, 1>(row, 6) = p;
    }
    const Eigen::VectorXd x = A.colPivHouseholderQr().solve(error);
    if (scale != nullptr)
        *scale = x[6];
    return error - A * x;
}

TEST(BodyPrecision, IsWhatIsLeftOfTheFullCovarianceAfterAFit) {
    Random random(41, "body precision");
    for (int trial = 0; trial < 3; ++trial) {
        const Bench bench(random, smallBody());
        const std::size_t n = bench.world.T_r_u.size();
        std::vector<std::size_t> all(n);
        std::iota(all.begin(), all.end(), 0U);
        const Gauge gauge{{0}, {}};
        const auto full =
            poseCovariance(bench.input, bench.world.state(), PosesOf::Modules, all, gauge, plainSquares());
        const auto found = bodyPrecision(bench.input, bench.world.state(), gauge, plainSquares());
        ASSERT_TRUE(full && found);
        Eigen::MatrixXd C(3 * n, 3 * n);
        for (std::size_t a = 0; a < n; ++a) {
            for (std::size_t b = 0; b < n; ++b)
                C.block<3, 3>(3 * a, 3 * b) = full->block<3, 3>(6 * a + 3, 6 * b + 3);
        }
        Eigen::MatrixXd fit(3 * n, 3 * n);
        Eigen::VectorXd growth(3 * n);
        for (Eigen::Index i = 0; i < fit.cols(); ++i) {
            const Eigen::VectorXd unit = Eigen::VectorXd::Unit(fit.rows(), i);
            fit.col(i) = residualAfterFit(unit, bench.world.T_r_u, false);
            (void)residualAfterFit(unit, bench.world.T_r_u, true, &growth[i]);
        }
        const Eigen::MatrixXd expected = fit * C * fit.transpose();
        for (std::size_t u = 0; u < n; ++u) {
            ASSERT_TRUE(found->positions[u]);
            const Matrix3d block = expected.block<3, 3>(3 * u, 3 * u);
            EXPECT_LT((*found->positions[u] - block).norm(), 1e-5 * block.norm()) << u;
        }
        EXPECT_NEAR(found->scale, std::sqrt(growth.dot(C * growth)), 1e-6 * found->scale);
    }
}

TEST(BodyPrecision, DoesNotDependOnTheGauge) {
    Random random(42, "gauges");
    const Bench bench(random, smallBody());
    const auto byView = bodyPrecision(bench.input, bench.world.state(), Gauge{{0}, {}}, plainSquares());
    for (const Gauge& gauge : {Gauge{{2}, {}}, Gauge{{}, {0}}, Gauge{{}, {7}}}) {
        const auto other = bodyPrecision(bench.input, bench.world.state(), gauge, plainSquares());
        ASSERT_TRUE(byView && other);
        EXPECT_EQ(other->worst(), byView->worst());
        EXPECT_NEAR(other->worstSigma(), byView->worstSigma(), 1e-5 * byView->worstSigma());
        EXPECT_NEAR(other->rmsSigma(), byView->rmsSigma(), 1e-5 * byView->rmsSigma());
        EXPECT_NEAR(other->scale, byView->scale, 1e-5 * byView->scale);
    }
}

TEST(BodyPrecision, LeavesOutWhatTakesNoPart) {
    Random random(43, "absent");
    const Bench bench(random, smallBody());
    BodyState state = bench.world.state();
    state.T_r_u[3].reset();
    const auto found = bodyPrecision(bench.input, state, Gauge{{0}, {}}, plainSquares());
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->positions[3]);
    EXPECT_EQ(found->sigma(3), 0);
    EXPECT_NE(found->worst(), std::optional<std::size_t>(3));
    EXPECT_EQ(BodyPrecision{}.worst(), std::nullopt);
    EXPECT_EQ(BodyPrecision{}.worstSigma(), 0);
    EXPECT_EQ(BodyPrecision{}.rmsSigma(), 0);
}

TEST(BodyPrecision, FailsWhereTheDataLeaveSomethingOpen) {
    Random random(44, "open");
    const Bench bench(random, smallBody());
    EXPECT_FALSE(bodyPrecision(bench.input, bench.world.state(), Gauge{}, plainSquares()));
    AdjustmentInput blind = bench.input;
    blind.pixels.clear();
    blind.links.clear();
    const auto found = bodyPrecision(blind, bench.world.state(), Gauge{{}, {0}}, plainSquares());
    if (found) {
        EXPECT_FALSE(found->worst()) << "no position is told";
    }
}

}  // namespace
}  // namespace skincal
