#include "core/camera_calibration/board_solver.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

#include "core/geometry/statistics.h"
#include "core/geometry/stop_when_cancelled.h"

namespace skincal {
namespace {

using BoardPose = std::array<double, 6>;

double rms(const std::vector<Vector2d>& residuals) {
    double sum = 0;
    for (const Vector2d& r : residuals)
        sum += r.squaredNorm();
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, residuals.size())));
}

/// Pose of a board for a given camera; nothing where none explains it.
std::optional<BoardPose> poseOf(const BoardView& view, const BoardPlan& plan, const CameraModel& camera) {
    std::vector<cv::Point3d> places;
    std::vector<cv::Point2d> rays;
    for (const BoardCorner& corner : view.corners) {
        const Vector3d p = plan.corner(corner.id);
        const Vector2d ray = camera.unproject(corner.pixel);
        places.emplace_back(p.x(), p.y(), p.z());
        rays.emplace_back(ray.x(), ray.y());
    }
    cv::Vec3d rotation;
    cv::Vec3d translation;
    try {
        if (!cv::solvePnP(places, rays, cv::Matx33d::eye(), cv::noArray(), rotation, translation, false,
                          cv::SOLVEPNP_IPPE))
            return std::nullopt;
    } catch (const cv::Exception&) {
        return std::nullopt;
    }
    const BoardPose pose{rotation[0], rotation[1], rotation[2], translation[0], translation[1], translation[2]};
    const bool usable = std::all_of(pose.begin(), pose.end(), [](double v) { return std::isfinite(v); });
    return usable && translation[2] > 0 ? std::optional(pose) : std::nullopt;
}

}  // namespace

BoardSolver::BoardSolver(std::span<const BoardView> views, const BoardPlan& plan,
                         const CameraCalibrationOptions& options, const RunContext& context)
    : views_(views),
      plan_(plan),
      options_(options),
      context_(context),
      poses_(views.size()),
      used_(views.size(), false),
      hasPose_(views.size(), false) {}

void BoardSolver::start() {
    constexpr std::array kShares{0.4, 0.55, 0.75, 1.0, 1.4, 2.0, 3.0};
    double best = std::numeric_limits<double>::infinity();
    for (const double share : kShares) {
        const CameraModel camera = plainCamera(share * views_.front().size.width);
        std::vector<std::optional<Pose>> poses;
        std::vector<double> errors;
        for (const BoardView& view : views_) {
            poses.push_back(poseOf(view, plan_, camera));
            errors.push_back(poses.back() ? rms(residualsOf(view, *poses.back(), intrinsicsOf(camera)))
                                          : std::numeric_limits<double>::infinity());
        }
        const double error = median(errors);
        if (error < best || share == kShares.front()) {
            best = error;
            intrinsics_ = intrinsicsOf(camera);
            for (std::size_t i = 0; i < views_.size(); ++i) {
                hasPose_[i] = poses[i] && std::isfinite(errors[i]);
                used_[i] = hasPose_[i];
                poses_[i] = poses[i].value_or(Pose{});
            }
        }
    }
}

std::size_t BoardSolver::usedCount() const {
    return static_cast<std::size_t>(std::count(used_.begin(), used_.end(), true));
}

tl::expected<void, CalibrationError> BoardSolver::solve(bool robust) {
    ceres::Problem problem;
    build(problem, robust);
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_SCHUR;
    solver.max_num_iterations = options_.maxIterations;
    solver.function_tolerance = 1e-12;
    solver.parameter_tolerance = 1e-12;
    solver.logging_type = ceres::SILENT;
    solver.num_threads = 1;
    StopWhenCancelled callback(context_);
    solver.callbacks.push_back(&callback);
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem, &summary);
    if (summary.termination_type == ceres::USER_FAILURE)
        return tl::unexpected(CalibrationError{ErrorCode::Cancelled});
    if (!summary.IsSolutionUsable() || (!robust && summary.termination_type == ceres::NO_CONVERGENCE))
        return tl::unexpected(CalibrationError{ErrorCode::NotConverged,
                                               {{"iterations", static_cast<double>(summary.iterations.size())}}});
    return {};
}

bool BoardSolver::rejectBoards() {
    std::vector<double> all;
    std::vector<double> errors(views_.size(), 0);
    for (std::size_t i = 0; i < views_.size(); ++i) {
        if (!used_[i])
            continue;
        errors[i] = rms(residualsOf(views_[i], poses_[i], intrinsics_));
        all.push_back(errors[i]);
    }
    const double limit = std::max(options_.boardRejection * median(all), options_.boardTolerance_px);
    bool any = false;
    for (std::size_t i = 0; i < views_.size(); ++i) {
        if (used_[i] && errors[i] > limit) {
            used_[i] = false;
            any = true;
        }
    }
    return any;
}

CameraCalibration BoardSolver::result() {
    CameraCalibration result;
    result.camera = modelOf(intrinsics_, options_.model, views_.front().size);
    double sum = 0;
    std::size_t corners = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
        CalibratedBoard board;
        board.used = used_[i];
        if (!used_[i]) {
            result.rejected.push_back(i);
            // Its pose for the camera that the others gave, so that people see what is wrong with it.
            if (const auto pose = poseOf(views_[i], plan_, result.camera))
                poses_[i] = *pose;
            else
                hasPose_[i] = false;
        }
        if (hasPose_[i]) {
            board.residuals = residualsOf(views_[i], poses_[i], intrinsics_);
            board.rms_px = rms(board.residuals);
            const Pose& p = poses_[i];
            board.T_v_b = makeIsometry(so3Exp({p[0], p[1], p[2]}), {p[3], p[4], p[5]});
        } else {
            board.rms_px = std::numeric_limits<double>::infinity();
        }
        if (board.used) {
            sum += board.rms_px * board.rms_px * static_cast<double>(board.residuals.size());
            corners += board.residuals.size();
        }
        result.boards.push_back(std::move(board));
    }
    result.rms_px = std::sqrt(sum / static_cast<double>(corners));
    result.sigma = sigmas(sum, 2 * corners);
    return result;
}

CameraModel BoardSolver::plainCamera(double f) const {
    CameraModel camera;
    const cv::Size size = views_.front().size;
    camera.width = size.width;
    camera.height = size.height;
    camera.fx = camera.fy = f;
    camera.cx = (size.width - 1) / 2.0;
    camera.cy = (size.height - 1) / 2.0;
    camera.distortionModel = options_.model;
    camera.distortion.assign(coefficientCount(options_.model), 0.0);
    return camera;
}

std::vector<Vector2d> BoardSolver::residualsOf(const BoardView& view, const Pose& pose,
                                               const Intrinsics& intrinsics) const {
    std::vector<Vector2d> result;
    for (const BoardCorner& corner : view.corners) {
        // Stays so where the pose puts the corner behind the camera.
        Vector2d r = Vector2d::Constant(std::numeric_limits<double>::infinity());
        const CornerResidual residual(options_.model, plan_.corner(corner.id), corner.pixel);
        residual(intrinsics.data(), pose.data(), r.data());
        result.push_back(-r);
    }
    return result;
}

std::vector<int> BoardSolver::fixedOnes() const {
    std::vector<int> fixed;
    for (int i = 4 + static_cast<int>(coefficientCount(options_.model)); i < kIntrinsics; ++i)
        fixed.push_back(i);
    if (options_.model == DistortionModel::PlumbBob && !options_.thirdRadialTerm)
        fixed.insert(fixed.begin(), 8);
    return fixed;
}

void BoardSolver::build(ceres::Problem& problem, bool robust) {
    for (std::size_t i = 0; i < views_.size(); ++i) {
        if (!used_[i])
            continue;
        for (const BoardCorner& corner : views_[i].corners) {
            auto* cost = new ceres::AutoDiffCostFunction<CornerResidual, 2, kIntrinsics, 6>(
                new CornerResidual(options_.model, plan_.corner(corner.id), corner.pixel));
            problem.AddResidualBlock(cost, robust ? new ceres::CauchyLoss(options_.lossScale_px) : nullptr,
                                     intrinsics_.data(), poses_[i].data());
        }
    }
    const std::vector<int> fixed = fixedOnes();
    if (!fixed.empty())
        problem.SetManifold(intrinsics_.data(), new ceres::SubsetManifold(kIntrinsics, fixed));
}

std::optional<IntrinsicsSigma> BoardSolver::sigmas(double squares, std::size_t observations) {
    const std::size_t unknowns = kIntrinsics - fixedOnes().size() + 6 * usedCount();
    if (observations <= unknowns)
        return std::nullopt;
    ceres::Problem problem;
    build(problem, false);
    ceres::Covariance::Options options;
    options.algorithm_type = ceres::SPARSE_QR;
    options.num_threads = 1;
    ceres::Covariance covariance(options);
    Eigen::Matrix<double, kIntrinsics, kIntrinsics, Eigen::RowMajor> C;
    const std::vector<const double*> blocks{intrinsics_.data()};
    if (!covariance.Compute(blocks, &problem) ||
        !covariance.GetCovarianceBlock(intrinsics_.data(), intrinsics_.data(), C.data()) || !C.allFinite())
        return std::nullopt;
    const double variance = squares / static_cast<double>(observations - unknowns);
    const auto sigma = [&](Eigen::Index i) { return std::sqrt(std::max(0.0, C(i, i) * variance)); };
    IntrinsicsSigma result{sigma(0), sigma(1), sigma(2), sigma(3), {}};
    for (std::size_t i = 0; i < coefficientCount(options_.model); ++i)
        result.distortion.push_back(sigma(static_cast<Eigen::Index>(4 + i)));
    return result;
}

}  // namespace skincal
