#include "core/adjustment/residuals.h"

#include <ceres/autodiff_cost_function.h>
#include <ceres/manifold.h>
#include <ceres/sphere_manifold.h>
#include <gtest/gtest.h>

#include "core/geometry/random.h"
#include "tests/unit/estimation/synthetic.h"

namespace skincal {
namespace {

struct Blocks {
    std::array<double, 4> q{};
    std::array<double, 3> t{};
};

Blocks toBlocks(const Isometry3d& T) {
    const Quaterniond q(T.linear());
    return {{q.x(), q.y(), q.z(), q.w()}, {T.translation().x(), T.translation().y(), T.translation().z()}};
}

/// Derivatives along the manifold of each block against central differences of the plain evaluation.
void expectDerivativesRight(const ceres::CostFunction& cost, const std::vector<const ceres::Manifold*>& manifolds,
                            const std::vector<const double*>& blocks) {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const int rows = cost.num_residuals();
    std::vector<RowMajor> jacobians;
    std::vector<double*> pointers;
    for (const int size : cost.parameter_block_sizes())
        jacobians.emplace_back(rows, size);
    for (RowMajor& J : jacobians)
        pointers.push_back(J.data());
    Eigen::VectorXd residual(rows);
    ASSERT_TRUE(cost.Evaluate(blocks.data(), residual.data(), pointers.data()));

    constexpr double kStep = 1e-6;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        const int tangent = manifolds[b]->TangentSize();
        RowMajor plus(manifolds[b]->AmbientSize(), tangent);
        ASSERT_TRUE(manifolds[b]->PlusJacobian(blocks[b], plus.data()));
        const Eigen::MatrixXd J = jacobians[b] * plus;
        for (int k = 0; k < tangent; ++k) {
            Eigen::MatrixXd side(rows, 2);
            for (int sign = 0; sign < 2; ++sign) {
                const Eigen::VectorXd delta = Eigen::VectorXd::Unit(tangent, k) * (sign == 0 ? -kStep : kStep);
                Eigen::VectorXd moved(manifolds[b]->AmbientSize());
                ASSERT_TRUE(manifolds[b]->Plus(blocks[b], delta.data(), moved.data()));
                std::vector<const double*> movedBlocks = blocks;
                movedBlocks[b] = moved.data();
                ASSERT_TRUE(cost.Evaluate(movedBlocks.data(), side.col(sign).data(), nullptr));
            }
            const Eigen::VectorXd difference = (side.col(1) - side.col(0)) / (2 * kStep);
            EXPECT_LT((J.col(k) - difference).norm(), 1e-5 * (1 + J.norm())) << "block " << b << ", column " << k;
        }
    }
}

class Residuals : public testing::Test {
  protected:
    ceres::EigenQuaternionManifold quaternion_;
    ceres::SphereManifold<3> sphere_;
    ceres::EuclideanManifold<3> plain_;
};

CameraModel cameraOf(DistortionModel model) {
    CameraModel camera = syntheticCamera(false);
    camera.distortionModel = model;
    camera.distortion.assign(coefficientCount(model), 0.01);
    camera.distortion[0] = 0.1;
    return camera;
}

TEST_F(Residuals, LedPixelsAreTheCamerasAndHaveRightDerivatives) {
    Random random(1, "pixels");
    for (const DistortionModel model :
         {DistortionModel::PlumbBob, DistortionModel::RationalPolynomial, DistortionModel::Equidistant}) {
        const CameraModel camera = cameraOf(model);
        for (int i = 0; i < 50; ++i) {
            const Isometry3d T_r_u = makeIsometry(random.rotation(), random.normal3() * 0.1);
            const Isometry3d T_r_v = lookAt(random.direction() * 0.8, random.normal3() * 0.05, random.uniform(-3, 3));
            const Vector3d led(0.0079, 0.001, 0.002);
            const Vector2d pixel(random.uniform(0, 1280), random.uniform(0, 720));
            const ceres::AutoDiffCostFunction<LedPixelResidual, 2, 4, 3, 4, 3> cost(
                new LedPixelResidual{&camera, pixel, led, 4.0});
            const Blocks u = toBlocks(T_r_u);
            const Blocks v = toBlocks(T_r_v);
            const std::vector<const double*> blocks{u.q.data(), u.t.data(), v.q.data(), v.t.data()};
            Vector2d residual;
            ASSERT_TRUE(cost.Evaluate(blocks.data(), residual.data(), nullptr));
            const Vector2d expected = 4.0 * (camera.project(T_r_v.inverse() * (T_r_u * led)).value() - pixel);
            EXPECT_LT((residual - expected).norm(), 1e-7);
            expectDerivativesRight(cost, {&quaternion_, &plain_, &quaternion_, &plain_}, blocks);
        }
    }
}

TEST_F(Residuals, AnLedBehindTheCameraIsRefused) {
    const CameraModel camera = syntheticCamera(true);
    const LedPixelResidual cost{&camera, {640, 360}, Vector3d::Zero(), 1};
    const Blocks v = toBlocks(Isometry3d::Identity());
    for (const double z : {-0.5, 0.0, 0.0009, 0.0011, 0.5}) {
        const Blocks u = toBlocks(makeIsometry(Matrix3d::Identity(), {0, 0, z}));
        Vector2d residual;
        EXPECT_EQ(cost(u.q.data(), u.t.data(), v.q.data(), v.t.data(), residual.data()), z > 0.001) << z;
    }
}

TEST_F(Residuals, GravityVanishesAtTheTruthAndHasRightDerivatives) {
    Random random(2, "gravity");
    for (int i = 0; i < 100; ++i) {
        const Isometry3d T_r_u = makeIsometry(random.rotation(), Vector3d::Zero());
        const Vector3d up = random.direction();
        const Vector3d bias = random.normal3() * 0.3;
        const Vector3d scale = Vector3d::Ones() + random.normal3() * 0.02;
        const Vector3d reading = scale.cwiseProduct(T_r_u.linear().transpose() * up * 9.81) + bias;
        const Blocks u = toBlocks(T_r_u);
        const std::vector<const double*> blocks{u.q.data(), up.data(), bias.data(), scale.data()};
        const std::vector<const ceres::Manifold*> manifolds{&quaternion_, &sphere_, &plain_, &plain_};
        const ceres::AutoDiffCostFunction<GravityResidual, 3, 4, 3, 3, 3> exact(
            new GravityResidual{reading, 9.81, 30.0});
        Vector3d residual;
        ASSERT_TRUE(exact.Evaluate(blocks.data(), residual.data(), nullptr));
        EXPECT_LT(residual.norm(), 1e-11);
        const Vector3d off(0.1, -0.2, 0.3);
        const ceres::AutoDiffCostFunction<GravityResidual, 3, 4, 3, 3, 3> cost(
            new GravityResidual{reading + off, 9.81, 30.0});
        ASSERT_TRUE(cost.Evaluate(blocks.data(), residual.data(), nullptr));
        EXPECT_LT((residual + 30 * off).norm(), 1e-10);
        expectDerivativesRight(cost, manifolds, blocks);
    }
}

TEST_F(Residuals, LinksMeasureTheGapAndHaveRightDerivatives) {
    Random random(3, "links");
    for (int i = 0; i < 100; ++i) {
        const Isometry3d T_r_a = makeIsometry(random.rotation(), random.normal3() * 0.1);
        const Isometry3d T_r_b = makeIsometry(random.rotation(), random.normal3() * 0.1);
        const Vector3d port_a = random.normal3() * 0.02;
        const Vector3d port_b = random.normal3() * 0.02;
        const ceres::AutoDiffCostFunction<LinkResidual, 3, 4, 3, 4, 3> cost(new LinkResidual{port_a, port_b, 2000});
        const Blocks a = toBlocks(T_r_a);
        const Blocks b = toBlocks(T_r_b);
        const std::vector<const double*> blocks{a.q.data(), a.t.data(), b.q.data(), b.t.data()};
        Vector3d residual;
        ASSERT_TRUE(cost.Evaluate(blocks.data(), residual.data(), nullptr));
        EXPECT_LT((residual - 2000 * (T_r_a * port_a - T_r_b * port_b)).norm(), 1e-9);
        expectDerivativesRight(cost, {&quaternion_, &plain_, &quaternion_, &plain_}, blocks);
    }
}

TEST_F(Residuals, PriorsPullTowardsWhatIsExpected) {
    const ceres::AutoDiffCostFunction<PriorResidual, 3, 3> cost(new PriorResidual{{1, 2, 3}, 10});
    const Vector3d value(1.1, 1.8, 3);
    const std::vector<const double*> blocks{value.data()};
    Vector3d residual;
    ASSERT_TRUE(cost.Evaluate(blocks.data(), residual.data(), nullptr));
    EXPECT_LT((residual - Vector3d(1, -2, 0)).norm(), 1e-12);
    expectDerivativesRight(cost, {&plain_}, blocks);
}

}  // namespace
}  // namespace skincal
