#include "core/geometry/se3.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace skincal {

Matrix3d skew(const Vector3d& v) {
    Matrix3d S;
    S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return S;
}

Matrix3d so3Exp(const Vector3d& w) {
    const double angle = w.norm();
    if (angle < 1e-12)
        return Matrix3d::Identity() + skew(w);
    return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

Vector3d so3Log(const Matrix3d& R) {
    // By way of the quaternion, which stays accurate near 0 and near pi.
    Quaterniond q(R);
    if (q.w() < 0)
        q.coeffs() = -q.coeffs();
    const double s = q.vec().norm();
    if (s < 1e-12)
        return 2.0 * q.vec();
    return 2.0 * std::atan2(s, q.w()) / s * q.vec();
}

Matrix3d nearestRotation(const Matrix3d& M) {
    const Eigen::JacobiSVD<Matrix3d> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Matrix3d U = svd.matrixU();
    if ((U * svd.matrixV().transpose()).determinant() < 0)
        U.col(2) = -U.col(2);
    return U * svd.matrixV().transpose();
}

double rotationAngle(const Matrix3d& R) {
    return so3Log(R).norm();
}

Isometry3d makeIsometry(const Matrix3d& R, const Vector3d& t) {
    Isometry3d T = Isometry3d::Identity();
    T.linear() = R;
    T.translation() = t;
    return T;
}

PoseDifference poseDifference(const Isometry3d& a, const Isometry3d& b) {
    return {rotationAngle(a.linear().transpose() * b.linear()), (a.translation() - b.translation()).norm()};
}

bool isRigid(const Isometry3d& T, double tolerance) {
    return T.matrix().allFinite() &&
           (T.linear() * T.linear().transpose() - Matrix3d::Identity()).cwiseAbs().maxCoeff() < tolerance &&
           T.linear().determinant() > 0;
}

}  // namespace skincal
