#include "core/mesh/mesh_alignment.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/geometry/statistics.h"

namespace skincal {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;

constexpr double kPull = 1e-5;           // of the offset towards 0, see the header
constexpr double kLeastSigma = 0.05e-3;  // m: nobody builds more exactly

struct Row {
    Vector7d jacobian;  ///< turn about the centre times its scale, shift, offset
    double residual = 0;
};

struct Linear {
    std::vector<Row> rows;
    Vector3d centre = Vector3d::Zero();
    double scale = 1;  ///< m: a turn by 1 / scale moves the modules as far as a shift by 1 m
};

Linear linearise(std::span<const OrientedPoint> modules, const MeshSurface& surface, const Isometry3d& T, double offset,
                 double reach) {
    Linear linear;
    for (const OrientedPoint& module : modules)
        linear.centre += T * module.position / static_cast<double>(modules.size());
    double spread = 0;
    for (const OrientedPoint& module : modules)
        spread += (T * module.position - linear.centre).squaredNorm();
    linear.scale = std::max(1e-6, std::sqrt(spread / static_cast<double>(modules.size())));
    for (const OrientedPoint& module : modules) {
        const Vector3d p = T * module.position;
        const auto found = surface.nearest(p, T.linear() * module.normal, reach);
        if (!found)
            continue;
        Row row;
        row.residual = found->distance - offset;
        row.jacobian << (p - linear.centre).cross(found->gradient) / linear.scale, found->gradient, -1.0;
        linear.rows.push_back(row);
    }
    return linear;
}

double sigmaOf(const std::vector<Row>& rows) {
    std::vector<double> sizes;
    for (const Row& row : rows)
        sizes.push_back(std::abs(row.residual));
    return sizes.empty() ? 0 : 1.4826 * median(std::move(sizes));
}

double tukeyWeight(double residual, double width) {
    const double u = residual / width;
    return std::abs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
}

Isometry3d moved(const Isometry3d& T, const Linear& linear, const Vector7d& step) {
    const Matrix3d R = so3Exp(step.head<3>() / linear.scale);
    return makeIsometry(nearestRotation(R * T.linear()),
                        linear.centre + R * (T.translation() - linear.centre) + step.segment<3>(3));
}

}  // namespace

MeshAlignment alignToMesh(std::span<const OrientedPoint> modules, const MeshSurface& surface, const Isometry3d& start,
                          const MeshAlignmentOptions& options, const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("alignToMesh: options out of range");
    MeshAlignment result{start, options.offset, 0, 0};
    for (int iteration = 0; iteration < options.iterations && !context.isCancelled(); ++iteration) {
        const Linear linear = linearise(modules, surface, result.T_mesh_body, result.offset, options.reach);
        result.sigma = sigmaOf(linear.rows);
        result.matched = linear.rows.size();
        if (linear.rows.size() < 3)
            return result;
        // In the first half whatever is within reach pulls, ever less from far away.
        const double wide = options.reach * std::pow(0.5, 8.0 * iteration / std::max(1, options.iterations / 2));
        const double width = std::max(wide, 4.685 * std::max(kLeastSigma, result.sigma));
        Matrix7d A = Matrix7d::Zero();
        Vector7d b = Vector7d::Zero();
        for (const Row& row : linear.rows) {
            const double weight = tukeyWeight(row.residual, width);
            A += weight * row.jacobian * row.jacobian.transpose();
            b -= weight * row.residual * row.jacobian;
        }
        const double count = std::max(1.0, A(6, 6));
        A(6, 6) += kPull * count;
        b(6) -= kPull * count * result.offset;
        if (!options.fitOffset) {
            A.row(6).setZero();
            A.col(6).setZero();
            A(6, 6) = 1;
            b(6) = 0;
        }
        A.diagonal().head<6>().array() += 1e-4 * count;
        const Vector7d step = A.ldlt().solve(b);
        if (!step.allFinite())
            return result;
        result.T_mesh_body = moved(result.T_mesh_body, linear, step);
        result.offset += step(6);
        const bool isSettled = wide < width && step.norm() < 1e-7;
        if (isSettled)
            break;
    }
    const Linear last = linearise(modules, surface, result.T_mesh_body, result.offset, options.reach);
    result.sigma = sigmaOf(last.rows);
    result.matched = last.rows.size();
    return result;
}

AlignmentStrength strengthOf(std::span<const OrientedPoint> modules, const MeshSurface& surface,
                             const MeshAlignment& alignment, double reach) {
    AlignmentStrength result;
    const Linear linear = linearise(modules, surface, alignment.T_mesh_body, alignment.offset, reach);
    const double width = 4.685 * std::max(kLeastSigma, alignment.sigma);
    Matrix7d A = Matrix7d::Zero();
    Matrix6d ways = Matrix6d::Zero();  // squared way of the modules for a motion
    double count = 0;
    for (const Row& row : linear.rows) {
        const double weight = tukeyWeight(row.residual, width);
        A += weight * row.jacobian * row.jacobian.transpose();
        count += weight;
    }
    if (!(count > 0))
        return result;
    for (const OrientedPoint& module : modules) {
        Eigen::Matrix<double, 3, 6> way;
        way << -skew(alignment.T_mesh_body * module.position - linear.centre) / linear.scale, Matrix3d::Identity();
        ways += way.transpose() * way / static_cast<double>(modules.size());
    }
    // A turn about the line that all modules lie on moves none of them: that is free as well.
    ways.diagonal().array() += 1e-9;
    const Matrix6d pose = A.topLeftCorner<6, 6>() / count;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6d> motions(pose, ways, Eigen::EigenvaluesOnly);
    result.sensitivity = motions.eigenvalues().cwiseMax(0).cwiseSqrt();
    const Vector6d shared = A.block<6, 1>(0, 6) / count;
    // What is left of the offset's own column once the pose has taken over what it can.
    const Matrix6d damped = pose + 1e-9 * Matrix6d::Identity();
    result.offset = std::sqrt(std::max(0.0, 1 - shared.dot(damped.ldlt().solve(shared))));
    return result;
}

}  // namespace skincal
