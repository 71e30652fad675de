#include "core/study/study_world.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/geometry/random.h"

namespace skincal {
namespace {

TEST(MeanSquareOfLength, IsTheTraceWhereThereIsNoLength) {
    const Eigen::Matrix3d covariance = Eigen::Vector3d(1, 4, 9).asDiagonal();
    EXPECT_DOUBLE_EQ(meanSquareOfLength(Eigen::Vector3d::Zero(), covariance), 14);
}

TEST(MeanSquareOfLength, IsTheVarianceAlongALongVector) {
    Random random(1, "long vector");
    for (int trial = 0; trial < 20; ++trial) {
        const Eigen::Matrix3d R = random.rotation();
        const Eigen::Matrix3d covariance = R * Eigen::Vector3d(0.5, 1, 2).asDiagonal() * R.transpose();
        const Eigen::Vector3d n = random.direction();
        const double expected = n.dot(covariance * n);
        EXPECT_NEAR(meanSquareOfLength(1000 * n, covariance), expected, 0.1 * expected);
    }
}

TEST(MeanSquareOfLength, CountsHowMuchNoiseAcrossLengthensAShortOne) {
    // Across only: |v + e| - |v| = e^2 / (2 |v|) to second order, whose mean square is 3 sigma^4 / (4 |v|^2).
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
    covariance(1, 1) = 4;
    EXPECT_NEAR(meanSquareOfLength(Eigen::Vector2d(40, 0), covariance), 3 * 16 / (4 * 1600.0), 0.15 * 0.0075);
}

TEST(BoundOf, OfDepthGrowsWithTheDistance) {
    const auto boundAt = [](double distance) {
        World world = bareWorld({bentPatch(7, 0.04)}, 1, 0.05);
        world.T_r_v = {cameraBefore(world, distance, 0.3)};
        const auto bound = boundOf(world, measurementsOf(world), BoundOn::Views,
                                   [](const std::vector<Isometry3d>& T_r_v, const std::vector<Isometry3d>& T_r_u) {
                                       return Eigen::VectorXd((T_r_v[0].inverse() * T_r_u[0]).translation());
                                   });
        return bound.value();
    };
    const Eigen::MatrixXd near = boundAt(0.6);
    const Eigen::MatrixXd far = boundAt(1.2);
    EXPECT_EQ(near.rows(), 3);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(near).eigenvalues()[0], 0);
    // Depth comes from the size of a picture: in proportion where the patch's own size is in doubt, with the square
    // where the pixels are.
    const double ratio = std::sqrt(far(2, 2) / near(2, 2));
    EXPECT_GT(ratio, 1.95);
    EXPECT_LT(ratio, 4.05);
}

}  // namespace
}  // namespace skincal
