#include "core/geometry/se3.h"

#include <gtest/gtest.h>

#include <limits>

#include "core/geometry/random.h"

namespace skincal {
namespace {

constexpr double kPi = 180 * kDegree;
constexpr int kCases = 1000;

double largest(const Matrix3d& M) {
    return M.cwiseAbs().maxCoeff();
}

TEST(Se3, SkewIsTheCrossProduct) {
    Random random(1, "skew");
    for (int i = 0; i < kCases; ++i) {
        const Vector3d v = random.normal3();
        const Vector3d u = random.normal3();
        EXPECT_LT((skew(v) * u - v.cross(u)).norm(), 1e-14);
        EXPECT_EQ(skew(v), -skew(v).transpose());
    }
}

TEST(Se3, ExpTurnsAboutItsAxis) {
    Random random(2, "exp");
    for (int i = 0; i < kCases; ++i) {
        const Vector3d axis = random.direction();
        const double angle = random.uniform(0, kPi);
        const Matrix3d R = so3Exp(axis * angle);
        EXPECT_TRUE(isRigid(makeIsometry(R, Vector3d::Zero()), 1e-12));
        EXPECT_LT((R * axis - axis).norm(), 1e-13);
        EXPECT_NEAR(R.trace(), 1 + 2 * std::cos(angle), 1e-12);
        // Right-handed: a vector across the axis moves towards axis x vector.
        const Vector3d across = axis.unitOrthogonal();
        EXPECT_LT((R * across - across * std::cos(angle) - axis.cross(across) * std::sin(angle)).norm(), 1e-13);
    }
}

TEST(Se3, LogUndoesExpAtEveryAngle) {
    Random random(3, "log");
    // From below the smallest step that doubles near 1 can show to just short of pi.
    const double angles[] = {0,    1e-15, 1e-13, 9e-13, 2e-12, 1e-9,       1e-7,       1e-4,
                             0.01, 1,     2,     3,     3.14,  kPi - 1e-4, kPi - 1e-7, kPi - 1e-9};
    for (const double angle : angles) {
        for (int i = 0; i < 100; ++i) {
            const Vector3d w = random.direction() * angle;
            EXPECT_LT((so3Log(so3Exp(w)) - w).norm(), 1e-13) << angle;
            EXPECT_NEAR(rotationAngle(so3Exp(w)), angle, 1e-13);
        }
    }
}

TEST(Se3, LogAtPiIsEitherOfTwo) {
    Random random(4, "pi");
    for (int i = 0; i < kCases; ++i) {
        const Vector3d w = random.direction() * kPi;
        const Vector3d found = so3Log(so3Exp(w));
        EXPECT_LT(std::min((found - w).norm(), (found + w).norm()), 1e-12);
        EXPECT_LE(found.norm(), kPi + 1e-12);
    }
    for (int k = 0; k < 3; ++k) {
        Matrix3d R = -Matrix3d::Identity();
        R(k, k) = 1;
        EXPECT_NEAR(rotationAngle(R), kPi, 1e-15);
        EXPECT_NEAR(std::abs(so3Log(R)(k)), kPi, 1e-15);
    }
}

TEST(Se3, ExpUndoesLogOnRandomRotations) {
    Random random(5, "explog");
    for (int i = 0; i < kCases; ++i) {
        const Matrix3d R = random.rotation();
        const Vector3d w = so3Log(R);
        EXPECT_LE(w.norm(), kPi + 1e-12);
        EXPECT_LT(largest(so3Exp(w) - R), 1e-13);
        EXPECT_LT((so3Log(R.transpose()) + w).norm(), 1e-10);
        // The angle does not depend on the frame.
        const Matrix3d S = random.rotation();
        EXPECT_NEAR(rotationAngle(S * R * S.transpose()), w.norm(), 1e-12);
    }
}

TEST(Se3, NearestRotationOfARotationIsItself) {
    Random random(6, "itself");
    for (int i = 0; i < kCases; ++i) {
        const Matrix3d R = random.rotation();
        EXPECT_LT(largest(nearestRotation(R) - R), 1e-13);
        EXPECT_LT(largest(nearestRotation(R * random.uniform(0.1, 10)) - R), 1e-13);
    }
}

TEST(Se3, NearestRotationIsNearerThanAnyOther) {
    Random random(7, "nearest");
    for (int i = 0; i < kCases; ++i) {
        // Any matrix, half of them with a negative determinant.
        Matrix3d M;
        M << random.normal3(), random.normal3(), random.normal3();
        const Matrix3d R = nearestRotation(M);
        ASSERT_TRUE(isRigid(makeIsometry(R, Vector3d::Zero()), 1e-12));
        const double distance = (R - M).norm();
        for (int k = 0; k < 10; ++k) {
            EXPECT_LE(distance, (random.rotation() - M).norm() + 1e-12);
            EXPECT_LE(distance, (R * so3Exp(random.normal3() * 0.01) - M).norm() + 1e-12);
        }
    }
}

TEST(Se3, NearestRotationTurnsWithItsArgument) {
    Random random(8, "equivariant");
    for (int i = 0; i < kCases; ++i) {
        // Kept near a rotation: where the nearest one is all but ambiguous, rounding decides.
        Matrix3d noise;
        noise << random.normal3(), random.normal3(), random.normal3();
        const Matrix3d M = random.rotation() + 0.1 * noise;
        const Matrix3d S = random.rotation();
        EXPECT_LT(largest(nearestRotation(S * M) - S * nearestRotation(M)), 1e-11);
    }
}

TEST(Se3, NearestRotationOfDegenerateMatricesIsARotation) {
    Matrix3d rankOne = Matrix3d::Zero();
    rankOne(0, 1) = 1;
    const Matrix3d reflection = Vector3d(1, 1, -1).asDiagonal();
    for (const Matrix3d& M : {Matrix3d(Matrix3d::Zero()), rankOne, reflection, Matrix3d(-Matrix3d::Identity())})
        EXPECT_TRUE(isRigid(makeIsometry(nearestRotation(M), Vector3d::Zero()), 1e-12)) << M;
    EXPECT_NEAR((nearestRotation(rankOne) - rankOne).norm(), std::sqrt(2.0), 1e-12);
}

TEST(Se3, TransformsChain) {
    Random random(9, "chain");
    for (int i = 0; i < kCases; ++i) {
        const Isometry3d T_a_b = makeIsometry(random.rotation(), random.normal3());
        const Isometry3d T_b_c = makeIsometry(random.rotation(), random.normal3());
        const Vector3d p_c = random.normal3();
        EXPECT_LT(((T_a_b * T_b_c) * p_c - T_a_b * (T_b_c * p_c)).norm(), 1e-13);
        EXPECT_LT((T_a_b * p_c - (T_a_b.linear() * p_c + T_a_b.translation())).norm(), 1e-13);
    }
}

TEST(Se3, PoseDifferenceTellsAngleAndDistance) {
    Random random(10, "difference");
    for (int i = 0; i < kCases; ++i) {
        const Isometry3d a = makeIsometry(random.rotation(), random.normal3());
        const double angle = random.uniform(0, kPi);
        const double distance = random.uniform(0, 2);
        const Isometry3d b = makeIsometry(a.linear() * so3Exp(random.direction() * angle),
                                          a.translation() + random.direction() * distance);
        for (const PoseDifference& found : {poseDifference(a, b), poseDifference(b, a)}) {
            EXPECT_NEAR(found.angle, angle, 1e-12);
            EXPECT_NEAR(found.distance, distance, 1e-12);
        }
        EXPECT_NEAR(poseDifference(a, a).angle, 0, 1e-15);
        EXPECT_EQ(poseDifference(a, a).distance, 0);
    }
}

TEST(Se3, RigidMeansFiniteOrthogonalAndRightHanded) {
    Random random(11, "rigid");
    for (int i = 0; i < kCases; ++i) {
        const Isometry3d good = makeIsometry(random.rotation(), random.normal3());
        EXPECT_TRUE(isRigid(good));

        Isometry3d scaled = good;
        scaled.linear() *= 1.001;
        EXPECT_FALSE(isRigid(scaled));
        EXPECT_TRUE(isRigid(scaled, 0.01));

        Isometry3d mirrored = good;
        mirrored.linear().col(static_cast<Eigen::Index>(random.index(3))) *= -1;
        EXPECT_FALSE(isRigid(mirrored));

        Isometry3d sheared = good;
        sheared.linear().col(0) += 0.01 * sheared.linear().col(1);
        EXPECT_FALSE(isRigid(sheared));

        for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
            Isometry3d broken = good;
            broken.matrix()(static_cast<Eigen::Index>(random.index(3)), static_cast<Eigen::Index>(random.index(4))) =
                bad;
            EXPECT_FALSE(isRigid(broken));
        }
    }
}

}  // namespace
}  // namespace skincal
