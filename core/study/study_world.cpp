#include "core/study/study_world.h"

#include <ceres/ceres.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/adjustment/pose_covariance.h"
#include "core/estimation/patch_shape.h"
#include "core/geometry/random.h"

namespace skincal {
namespace {

/// The skin sorted out by what really is, where an estimate has to judge.
SkinLayout layoutOf(const World& world) {
    SkinLayout layout;
    layout.graph = buildSkinGraph(world.skin);
    for (const GraphLink& link : layout.graph.links()) {
        LinkVerdict verdict;
        verdict.kind = world.isCable[link.reported.front()] ? LinkKind::Cable : LinkKind::Adjacent;
        layout.verdicts.push_back(verdict);
    }
    return layout;
}

AdjustmentInput inputOf(const World& world, const Measurements& measurements, const GravityTable& gravity) {
    AdjustmentInput input;
    input.skin = &measurements.skin;
    input.camera = &measurements.camera;
    input.gravity = &gravity;
    input.pixels = flattenDetections(measurements);
    input.gravityGroup.assign(measurements.skin.modules.size(), 0);
    input.links = adjacentPorts(world.skin, layoutOf(world));
    return input;
}

Isometry3d moved(const Isometry3d& T, Eigen::Index axis, double step) {
    Vector6d d = Vector6d::Zero();
    d[axis] = step;
    return makeIsometry(so3Exp(d.head<3>()) * T.linear(), T.translation() + d.tail<3>());
}

/// Distance of a point from a cylinder: axis through a + u e1 + v e2 with direction n + p e1 + q e2.
struct CylinderResidual {
    Vector3d point, n, e1, e2;
    template <class T>
    bool operator()(const T* p, T* residual) const {
        using Vector3 = Eigen::Matrix<T, 3, 1>;
        const Vector3 direction = (n.cast<T>() + p[2] * e1.cast<T>() + p[3] * e2.cast<T>()).normalized();
        const Vector3 base = p[0] * e1.cast<T>() + p[1] * e2.cast<T>();
        const Vector3 d = point.cast<T>() - base;
        residual[0] = (d - d.dot(direction) * direction).norm() - p[4];
        return true;
    }
};

}  // namespace

World bareWorld(const std::vector<PatchPlan>& patches, std::uint64_t seed, double pixelNoise) {
    Scenario scenario;
    scenario.name = "study";
    scenario.camera = simulatedWebcam();
    scenario.patches = patches;
    scenario.views.count = 0;
    scenario.views.pixelNoise = pixelNoise;
    return buildWorld(scenario, seed);
}

PatchPlan flatPatch(std::size_t modules) {
    PatchPlan plan;
    plan.modules = modules;
    plan.raggedness = 0;
    return plan;
}

PatchPlan bentPatch(std::size_t modules, double radius) {
    PatchPlan plan = flatPatch(modules);
    plan.surface = SurfaceKind::Cylinder;
    plan.radius = radius;
    return plan;
}

PatchPlan ringOfEight() {
    PatchPlan plan = bentPatch(8, 0.5 * 27.785e-3 / std::tan(180 * kDegree / 8));
    plan.strip = plan.ring = true;
    return plan;
}

Isometry3d cameraBefore(const World& world, double distance, double tilt) {
    // Facing: the camera looks against the patch's normal, its x along the patch's.
    const Matrix3d R_v_o = Eigen::AngleAxisd(180 * kDegree + tilt, Vector3d::UnitX()).toRotationMatrix();
    const Isometry3d T_v_o = makeIsometry(R_v_o, {0, 0, distance});
    return world.T_r_u.front() * T_v_o.inverse();
}

Measurements measurementsOf(const World& world) {
    return {world.skin, simulateGravity(world), world.scenario.camera, simulateDetections(world)};
}

std::optional<Eigen::MatrixXd> boundOf(const World& world, const Measurements& measurements, BoundOn which,
                                       const PoseFunction& function) {
    const GravityTable gravity(measurements.skin, measurements.gravity);
    const AdjustmentInput input = inputOf(world, measurements, gravity);
    BodyState truth;
    truth.T_r_u.assign(world.T_r_u.begin(), world.T_r_u.end());
    truth.T_r_v.assign(world.T_r_v.begin(), world.T_r_v.end());
    truth.accelerometers.resize(world.T_r_u.size());
    truth.up_r.emplace_back();
    for (const Vector3d& g : world.gravity_r)
        truth.up_r[0].emplace_back(g.normalized());

    AdjustmentOptions options;
    options.accelerometerSigma = world.scenario.sensors.noise;
    options.biasSigma = world.scenario.sensors.bias;
    options.scaleSigma = world.scenario.sensors.scale;
    options.linkSigma = std::sqrt(2.0) * world.scenario.play.position;
    options.pixelSigmaFloor_px = 1e-3;
    const bool views = which == BoundOn::Views;
    std::vector<std::size_t> moving;
    for (std::size_t i = views ? 0 : 1; i < (views ? world.T_r_v.size() : world.T_r_u.size()); ++i)
        moving.push_back(i);
    options.pixelLoss = options.gravityLoss = options.linkLoss = 0;
    const auto covariance =
        poseCovariance(input, truth, views ? PosesOf::Views : PosesOf::Modules, moving, Gauge{{}, {0}}, options);
    if (!covariance)
        return std::nullopt;
    Eigen::MatrixXd J(function(world.T_r_v, world.T_r_u).size(), covariance->cols());
    for (std::size_t i = 0; i < moving.size(); ++i) {
        for (Eigen::Index axis = 0; axis < 6; ++axis) {
            constexpr double kStep = 1e-6;
            std::array<Eigen::VectorXd, 2> value;
            for (const int sign : {0, 1}) {
                auto T_r_v = world.T_r_v;
                auto T_r_u = world.T_r_u;
                Isometry3d& T = views ? T_r_v[moving[i]] : T_r_u[moving[i]];
                T = moved(T, axis, sign == 0 ? -kStep : kStep);
                value.at(static_cast<std::size_t>(sign)) = function(T_r_v, T_r_u);
            }
            J.col(static_cast<Eigen::Index>(6 * i) + axis) = (value[1] - value[0]) / (2 * kStep);
        }
    }
    return J * *covariance * J.transpose();
}

double meanSquareOfLength(const Eigen::VectorXd& v, const Eigen::MatrixXd& covariance) {
    if (v.norm() == 0)
        return std::max(0.0, covariance.trace());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
    const Eigen::MatrixXd root = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
    constexpr int kDraws = 4096;
    Random random(1, "length of a vector");
    double squares = 0;
    for (int draw = 0; draw < kDraws; ++draw) {
        Eigen::VectorXd e(v.size());
        for (double& x : e)
            x = random.normal();
        const double error = (v + root * e).norm() - v.norm();
        squares += error * error;
    }
    return squares / kDraws;
}

std::optional<BodyPoses> posesOf(const BodyModel& body, bool needViews) {
    BodyPoses poses;
    for (const BodyModule& module : body.modules) {
        const auto& T = needViews ? module.T_body_module : module.T_patch_module;
        if (!T)
            return std::nullopt;
        poses.T_r_u.push_back(*T);
    }
    for (const BodyView& view : body.views) {
        if (!view.T_body_camera)
            return std::nullopt;
        poses.T_r_v.push_back(*view.T_body_camera);
    }
    return poses;
}

CylinderFit fitCylinder(const std::vector<Vector3d>& points, const Vector3d& axis, double radius) {
    const Vector3d n = axis.normalized();
    const Vector3d e1 = n.unitOrthogonal();
    const Vector3d e2 = n.cross(e1);
    Vector3d centre = Vector3d::Zero();
    for (const Vector3d& p : points)
        centre += p / static_cast<double>(points.size());
    double best = 1e300;
    CylinderFit fit;
    // The points cover an arc: which side of them the axis is on is tried all round.
    for (int side = 0; side < 8; ++side) {
        const double angle = side * 45 * kDegree;
        std::array<double, 5> p{radius * std::cos(angle), radius * std::sin(angle), 0, 0, radius};
        ceres::Problem problem;
        for (const Vector3d& point : points)
            problem.AddResidualBlock(new ceres::AutoDiffCostFunction<CylinderResidual, 1, 5>(
                                         new CylinderResidual{point - centre, n, e1, e2}),
                                     nullptr, p.data());
        ceres::Solver::Options options;
        options.linear_solver_type = ceres::DENSE_QR;
        options.logging_type = ceres::SILENT;
        options.function_tolerance = 1e-12;
        ceres::Solver::Summary summary;
        ceres::Solve(options, &problem, &summary);
        if (summary.IsSolutionUsable() && summary.final_cost < best) {
            best = summary.final_cost;
            fit = {std::abs(p[4]), std::sqrt(2 * summary.final_cost / static_cast<double>(points.size()))};
        }
    }
    return fit;
}

}  // namespace skincal
