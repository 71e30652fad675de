#include "core/camera_calibration/calibrate_camera.h"

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <stdexcept>

#include "core/camera_calibration/board_projection.h"

namespace skincal {
namespace {

using Pose = std::array<double, 6>;  ///< angle-axis and translation of T_v_b

double rms(const std::vector<Vector2d>& residuals) {
    double sum = 0;
    for (const Vector2d& r : residuals)
        sum += r.squaredNorm();
    return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(1, residuals.size())));
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Pose of a board for a given camera; nothing where none explains it.
std::optional<Pose> poseOf(const BoardView& view, const BoardPlan& plan, const CameraModel& camera) {
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
    const Pose pose{rotation[0], rotation[1], rotation[2], translation[0], translation[1], translation[2]};
    const bool usable = std::all_of(pose.begin(), pose.end(), [](double v) { return std::isfinite(v); });
    return usable && translation[2] > 0 ? std::optional(pose) : std::nullopt;
}

class StopWhenCancelled : public ceres::IterationCallback {
  public:
    explicit StopWhenCancelled(const RunContext& context) : context_(context) {}
    ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
        return context_.isCancelled() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
    }

  private:
    const RunContext& context_;
};

class Calibrator {
  public:
    Calibrator(std::span<const BoardView> views, const BoardPlan& plan, const CameraCalibrationOptions& options,
               const RunContext& context)
        : views_(views), plan_(plan), options_(options), context_(context), poses_(views.size()) {
        used_.assign(views.size(), true);
    }

    /// The focal length, of a few, with which the boards' own poses explain them best; then poses for it.
    void start() {
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
            if (error < best || poses_.empty() || share == kShares.front()) {
                best = error;
                intrinsics_ = intrinsicsOf(camera);
                for (std::size_t i = 0; i < views_.size(); ++i) {
                    used_[i] = poses[i].has_value();
                    poses_[i] = poses[i].value_or(Pose{});
                    hasPose_.resize(views_.size());
                    hasPose_[i] = poses[i].has_value();
                }
            }
        }
    }

    [[nodiscard]] std::size_t usedCount() const {
        return static_cast<std::size_t>(std::count(used_.begin(), used_.end(), true));
    }

    [[nodiscard]] tl::expected<void, CalibrationError> solve(bool robust) {
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

    /// Takes out what stands out; true where anything did.
    bool rejectBoards() {
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

    [[nodiscard]] CameraCalibration result() {
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

  private:
    [[nodiscard]] CameraModel plainCamera(double f) const {
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

    [[nodiscard]] std::vector<Vector2d> residualsOf(const BoardView& view, const Pose& pose,
                                                    const Intrinsics& intrinsics) const {
        std::vector<Vector2d> result;
        for (const BoardCorner& corner : view.corners) {
            Vector2d r;
            const CornerResidual residual(options_.model, plan_.corner(corner.id), corner.pixel);
            residual(intrinsics.data(), pose.data(), r.data());
            result.push_back(-r);
        }
        return result;
    }

    /// Which of the intrinsics aren't estimated.
    [[nodiscard]] std::vector<int> fixedOnes() const {
        std::vector<int> fixed;
        for (int i = 4 + static_cast<int>(coefficientCount(options_.model)); i < kIntrinsics; ++i)
            fixed.push_back(i);
        if (options_.model == DistortionModel::PlumbBob && !options_.thirdRadialTerm)
            fixed.insert(fixed.begin(), 8);
        return fixed;
    }

    void build(ceres::Problem& problem, bool robust) {
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

    [[nodiscard]] std::optional<IntrinsicsSigma> sigmas(double squares, std::size_t observations) {
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

    std::span<const BoardView> views_;
    const BoardPlan& plan_;
    const CameraCalibrationOptions& options_;
    const RunContext& context_;
    Intrinsics intrinsics_{};
    std::vector<Pose> poses_;
    std::vector<bool> used_;
    std::vector<bool> hasPose_;
};

std::optional<CalibrationError> defectOf(std::span<const BoardView> views, const CameraCalibrationOptions& options) {
    constexpr std::size_t kMinCorners = 6;
    if (views.size() < static_cast<std::size_t>(options.minBoards))
        return CalibrationError{ErrorCode::TooFewPoses,
                                {{"found", static_cast<double>(views.size())}, {"needed", options.minBoards}}};
    for (const BoardView& view : views) {
        if (view.size != views.front().size)
            return CalibrationError{ErrorCode::SizeMismatch};
        if (view.corners.size() < kMinCorners)
            return CalibrationError{
                ErrorCode::TooFewPoints,
                {{"found", static_cast<double>(view.corners.size())}, {"needed", static_cast<double>(kMinCorners)}}};
        for (const BoardCorner& corner : view.corners) {
            if (!corner.pixel.allFinite())
                return CalibrationError{ErrorCode::NotFinite};
        }
    }
    return std::nullopt;
}

}  // namespace

bool CameraCalibrationOptions::validate() const {
    return boardRejection > 1 && boardTolerance_px >= 0 && lossScale_px > 0 && minBoards >= 3 && maxIterations > 0;
}

tl::expected<CameraCalibration, CalibrationError> calibrateCamera(std::span<const BoardView> views,
                                                                  const BoardPlan& plan,
                                                                  const CameraCalibrationOptions& options,
                                                                  const RunContext& context) {
    if (!options.validate() || !plan.validate())
        throw std::logic_error("calibrateCamera: options or plan out of range");
    if (auto defect = defectOf(views, options))
        return tl::unexpected(std::move(*defect));
    if (views.front().size.width <= 0 || views.front().size.height <= 0)
        throw std::logic_error("calibrateCamera: pictures without a size");
    Calibrator calibrator(views, plan, options, context);
    context.report("poses of the boards", 0);
    calibrator.start();
    const auto enough = [&] { return calibrator.usedCount() >= static_cast<std::size_t>(options.minBoards); };
    const auto tooFew = [&] {
        return tl::unexpected(
            CalibrationError{ErrorCode::TooFewPoses,
                             {{"found", static_cast<double>(calibrator.usedCount())}, {"needed", options.minBoards}}});
    };
    constexpr int kRounds = 4;
    for (int round = 0; round < kRounds; ++round) {
        if (!enough())
            return tooFew();
        context.report("boards that disagree", 0.2 + 0.15 * round);
        if (context.isCancelled())
            return tl::unexpected(CalibrationError{ErrorCode::Cancelled});
        if (auto solved = calibrator.solve(true); !solved)
            return tl::unexpected(std::move(solved.error()));
        if (!calibrator.rejectBoards())
            break;
    }
    if (!enough())
        return tooFew();
    context.report("final estimate", 0.8);
    if (auto solved = calibrator.solve(false); !solved)
        return tl::unexpected(std::move(solved.error()));
    CameraCalibration result = calibrator.result();
    judgeCalibration(views, result);
    context.report("final estimate", 1);
    return result;
}

}  // namespace skincal
