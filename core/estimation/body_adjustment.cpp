#include "core/estimation/body_adjustment.h"

#include <ceres/ceres.h>

#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "core/estimation/residuals.h"

namespace skincal {
namespace {

using Block3 = std::array<double, 3>;
using Block4 = std::array<double, 4>;

struct PoseBlocks {
    Block4 q{};
    Block3 t{};
};

PoseBlocks toBlocks(const Isometry3d& T) {
    const Quaterniond q = Quaterniond(T.linear()).normalized();
    return {{q.x(), q.y(), q.z(), q.w()}, {T.translation().x(), T.translation().y(), T.translation().z()}};
}

Isometry3d toPose(const PoseBlocks& blocks) {
    const Quaterniond q(blocks.q[3], blocks.q[0], blocks.q[1], blocks.q[2]);
    return makeIsometry(q.normalized().toRotationMatrix(), Vector3d(blocks.t.data()));
}

class StopWhenCancelled final : public ceres::IterationCallback {
  public:
    explicit StopWhenCancelled(const RunContext& context) : context_(context) {}
    ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
        return context_.isCancelled() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
    }

  private:
    const RunContext& context_;
};

/// The state as parameter blocks and the residuals on top of them; lives as long as one solve.
class Problem {
  public:
    Problem(const AdjustmentInput& input, const BodyState& start, const AdjustmentOptions& options)
        : input_(input), options_(options), problem_(problemOptions()) {
        copyIn(start);
        addPixels(start);
        addGravity(start);
        addLinks(start);
    }

    /// Holds the gauge; false where nothing of it takes part.
    bool fix(const Gauge& gauge) {
        bool any = false;
        const auto hold = [&](PoseBlocks& pose) {
            for (double* block : {pose.q.data(), pose.t.data()}) {
                if (problem_.HasParameterBlock(block)) {
                    problem_.SetParameterBlockConstant(block);
                    any = true;
                }
            }
        };
        for (const std::size_t v : gauge.views)
            hold(views_[v]);
        for (const std::size_t u : gauge.modules)
            hold(modules_[u]);
        return any;
    }

    ceres::Problem& ceres() { return problem_; }
    PoseBlocks& module(std::size_t i) { return modules_[i]; }
    PoseBlocks& view(std::size_t i) { return views_[i]; }

    void copyOut(BodyState& state) const {
        for (std::size_t u = 0; u < modules_.size(); ++u) {
            if (state.T_r_u[u])
                state.T_r_u[u] = toPose(modules_[u]);
            state.accelerometers[u] = {Vector3d(bias_[u].data()), Vector3d(scale_[u].data())};
        }
        for (std::size_t v = 0; v < views_.size(); ++v) {
            if (state.T_r_v[v])
                state.T_r_v[v] = toPose(views_[v]);
        }
        for (std::size_t g = 0; g < up_.size(); ++g) {
            for (std::size_t p = 0; p < up_[g].size(); ++p) {
                if (state.up_r[g][p])
                    state.up_r[g][p] = Vector3d(up_[g][p].data()).normalized();
            }
        }
    }

  private:
    static ceres::Problem::Options problemOptions() {
        ceres::Problem::Options options;
        options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
        options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
        return options;
    }

    void copyIn(const BodyState& start) {
        modules_.resize(start.T_r_u.size());
        bias_.resize(start.T_r_u.size());
        scale_.resize(start.T_r_u.size());
        for (std::size_t u = 0; u < modules_.size(); ++u) {
            if (start.T_r_u[u])
                modules_[u] = toBlocks(*start.T_r_u[u]);
            Eigen::Map<Vector3d>(bias_[u].data()) = start.accelerometers[u].bias;
            Eigen::Map<Vector3d>(scale_[u].data()) = start.accelerometers[u].scale;
        }
        views_.resize(start.T_r_v.size());
        for (std::size_t v = 0; v < views_.size(); ++v) {
            if (start.T_r_v[v])
                views_[v] = toBlocks(*start.T_r_v[v]);
        }
        up_.resize(start.up_r.size());
        for (std::size_t g = 0; g < up_.size(); ++g) {
            up_[g].resize(start.up_r[g].size());
            for (std::size_t p = 0; p < up_[g].size(); ++p) {
                if (start.up_r[g][p])
                    Eigen::Map<Vector3d>(up_[g][p].data()) = *start.up_r[g][p];
            }
        }
    }

    void addPixels(const BodyState& start) {
        for (const PixelObservation& o : input_.pixels) {
            if (!start.T_r_u[o.module] || !start.T_r_v[o.view] || !pixelResidual(input_, start, o))
                continue;
            const double sigma = std::max(o.sigma_px, options_.pixelSigmaFloor_px);
            auto* cost = new ceres::AutoDiffCostFunction<LedPixelResidual, 2, 4, 3, 4, 3>(
                new LedPixelResidual{input_.camera, o.pixel, input_.skin->templateOf(o.module).led, 1.0 / sigma});
            problem_.AddResidualBlock(cost, pixelLoss_.get(), modules_[o.module].q.data(), modules_[o.module].t.data(),
                                      views_[o.view].q.data(), views_[o.view].t.data());
            problem_.SetManifold(modules_[o.module].q.data(), &quaternion_);
            problem_.SetManifold(views_[o.view].q.data(), &quaternion_);
        }
    }

    void addGravity(const BodyState& start) {
        for (std::size_t u = 0; u < modules_.size(); ++u) {
            if (!start.T_r_u[u] || input_.gravity->of(u).empty())
                continue;
            auto& up = up_[input_.gravityGroup[u]];
            for (const GravityTable::Entry& entry : input_.gravity->of(u)) {
                const double sigma = entry.sigma.value_or(options_.accelerometerSigma);
                auto* cost = new ceres::AutoDiffCostFunction<GravityResidual, 3, 4, 3, 3, 3>(
                    new GravityResidual{entry.acceleration, options_.gravity, 1.0 / sigma});
                problem_.AddResidualBlock(cost, gravityLoss_.get(), modules_[u].q.data(), up[entry.pose].data(),
                                          bias_[u].data(), scale_[u].data());
                problem_.SetManifold(up[entry.pose].data(), &sphere_);
            }
            problem_.SetManifold(modules_[u].q.data(), &quaternion_);
            addPrior(bias_[u], Vector3d::Zero(), options_.biasSigma);
            addPrior(scale_[u], Vector3d::Ones(), options_.scaleSigma);
        }
    }

    void addPrior(Block3& block, const Vector3d& expected, double sigma) {
        problem_.AddResidualBlock(
            new ceres::AutoDiffCostFunction<PriorResidual, 3, 3>(new PriorResidual{expected, 1.0 / sigma}), nullptr,
            block.data());
        if (!options_.calibrateAccelerometers)
            problem_.SetParameterBlockConstant(block.data());
    }

    void addLinks(const BodyState& start) {
        for (const PortPair& link : input_.links) {
            if (!start.T_r_u[link.a] || !start.T_r_u[link.b])
                continue;
            auto* cost = new ceres::AutoDiffCostFunction<LinkResidual, 3, 4, 3, 4, 3>(
                new LinkResidual{link.port_a, link.port_b, 1.0 / options_.linkSigma});
            problem_.AddResidualBlock(cost, linkLoss_.get(), modules_[link.a].q.data(), modules_[link.a].t.data(),
                                      modules_[link.b].q.data(), modules_[link.b].t.data());
            problem_.SetManifold(modules_[link.a].q.data(), &quaternion_);
            problem_.SetManifold(modules_[link.b].q.data(), &quaternion_);
        }
    }

    static std::unique_ptr<ceres::LossFunction> cauchy(double scale) {
        return scale > 0 ? std::make_unique<ceres::CauchyLoss>(scale) : nullptr;
    }

    const AdjustmentInput& input_;
    const AdjustmentOptions& options_;
    std::vector<PoseBlocks> modules_;
    std::vector<PoseBlocks> views_;
    std::vector<Block3> bias_;
    std::vector<Block3> scale_;
    std::vector<std::vector<Block3>> up_;
    ceres::EigenQuaternionManifold quaternion_;
    ceres::SphereManifold<3> sphere_;
    std::unique_ptr<ceres::LossFunction> pixelLoss_ = cauchy(options_.pixelLoss);
    std::unique_ptr<ceres::LossFunction> gravityLoss_ = cauchy(options_.gravityLoss);
    std::unique_ptr<ceres::LossFunction> linkLoss_ = cauchy(options_.linkLoss);
    ceres::Problem problem_;
};

void requireConsistent(const AdjustmentInput& input, const BodyState& state, const AdjustmentOptions& options) {
    if (!options.validate())
        throw std::logic_error("AdjustmentOptions out of range");
    if (input.skin == nullptr || input.gravity == nullptr || (input.camera == nullptr && !input.pixels.empty()) ||
        state.T_r_u.size() != input.skin->modules.size() || state.accelerometers.size() != state.T_r_u.size() ||
        input.gravityGroup.size() != state.T_r_u.size())
        throw std::logic_error("adjustBody: state and input do not belong together");
}

/// Up directions that no accelerometer of the state's own gives are estimated from the rest.
BodyState withUpDirections(const AdjustmentInput& input, BodyState state) {
    BodyState filled = state;
    estimateUpDirections(input, filled);
    if (state.up_r.size() != filled.up_r.size())
        return filled;
    for (std::size_t g = 0; g < filled.up_r.size(); ++g) {
        for (std::size_t p = 0; p < filled.up_r[g].size(); ++p) {
            if (state.up_r[g][p])
                filled.up_r[g][p] = state.up_r[g][p];
        }
    }
    return filled;
}

tl::expected<Eigen::MatrixXd, CalibrationError> poseBound(const AdjustmentInput& input, const BodyState& truth,
                                                          const std::vector<std::size_t>& which, bool ofViews,
                                                          const Gauge& gauge, AdjustmentOptions options) {
    options.pixelLoss = options.gravityLoss = options.linkLoss = 0;
    requireConsistent(input, truth, options);
    const BodyState state = withUpDirections(input, truth);
    Problem problem(input, state, options);
    const tl::unexpected<CalibrationError> degenerate(CalibrationError{ErrorCode::DegeneratePoints, {}});
    if (!problem.fix(gauge))
        return degenerate;

    std::vector<const double*> blocks;
    for (const std::size_t i : which) {
        PoseBlocks& pose = ofViews ? problem.view(i) : problem.module(i);
        if (!problem.ceres().HasParameterBlock(pose.q.data()) || !problem.ceres().HasParameterBlock(pose.t.data()))
            return degenerate;  // nothing was measured of it
        blocks.push_back(pose.q.data());
        blocks.push_back(pose.t.data());
    }
    ceres::Covariance::Options covarianceOptions;
    covarianceOptions.algorithm_type = ceres::SPARSE_QR;
    ceres::Covariance covariance(covarianceOptions);
    if (!covariance.Compute(blocks, &problem.ceres()))
        return degenerate;
    const auto size = static_cast<Eigen::Index>(3 * blocks.size());
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> bound(size, size);
    if (!covariance.GetCovarianceMatrixInTangentSpace(blocks, bound.data()))
        return degenerate;
    // The quaternion manifold's tangent is half the rotation vector, applied from the left: q' = exp(delta) q.
    for (std::size_t i = 0; i < which.size(); ++i) {
        bound.middleRows<3>(static_cast<Eigen::Index>(6 * i)) *= 2;
        bound.middleCols<3>(static_cast<Eigen::Index>(6 * i)) *= 2;
    }
    return Eigen::MatrixXd(bound);
}

}  // namespace

bool AdjustmentOptions::validate() const {
    return accelerometerSigma > 0 && linkSigma > 0 && biasSigma > 0 && scaleSigma > 0 && gravity > 0 &&
           pixelSigmaFloor_px > 0 && pixelLoss >= 0 && gravityLoss >= 0 && linkLoss >= 0 && maxIterations > 0;
}

std::vector<PixelObservation> flattenDetections(const Measurements& measurements) {
    const auto index = measurements.skin.indexById();
    std::vector<PixelObservation> pixels;
    for (std::size_t v = 0; v < measurements.views.size(); ++v) {
        for (const LedDetection& detection : measurements.views[v].found) {
            const auto found = index.find(detection.module);
            if (found != index.end())
                pixels.push_back({v, found->second, detection.pixel, detection.sigma_px});
        }
    }
    return pixels;
}

std::optional<Vector2d> pixelResidual(const AdjustmentInput& input, const BodyState& state,
                                      const PixelObservation& observation) {
    const auto& T_r_u = state.T_r_u[observation.module];
    const auto& T_r_v = state.T_r_v[observation.view];
    if (!T_r_u || !T_r_v)
        return std::nullopt;
    const auto predicted =
        input.camera->project(T_r_v->inverse() * (*T_r_u * input.skin->templateOf(observation.module).led));
    if (!predicted || !predicted->allFinite())
        return std::nullopt;
    return observation.pixel - *predicted;
}

std::vector<Vector3d> gravityResiduals(const AdjustmentInput& input, const BodyState& state, std::size_t module,
                                       double gravity) {
    std::vector<Vector3d> residuals;
    const auto& T_r_u = state.T_r_u[module];
    if (!T_r_u)
        return residuals;
    const AccelerometerCalibration& c = state.accelerometers[module];
    for (const GravityTable::Entry& entry : input.gravity->of(module)) {
        const auto& up = state.up_r[input.gravityGroup[module]][entry.pose];
        if (!up)
            continue;
        const Vector3d a = gravity * (T_r_u->linear().transpose() * *up);
        residuals.emplace_back(entry.acceleration - c.bias - c.scale.cwiseProduct(a));
    }
    return residuals;
}

void estimateUpDirections(const AdjustmentInput& input, BodyState& state) {
    std::size_t groups = 0;
    for (const std::size_t g : input.gravityGroup)
        groups = std::max(groups, g + 1);
    const std::size_t poses = input.gravity->poseCount();
    std::vector<std::vector<Vector3d>> sum(groups, std::vector<Vector3d>(poses, Vector3d::Zero()));
    std::vector<std::vector<bool>> told(groups, std::vector<bool>(poses, false));
    for (std::size_t u = 0; u < state.T_r_u.size(); ++u) {
        if (!state.T_r_u[u])
            continue;
        const AccelerometerCalibration& calibration = state.accelerometers[u];
        for (const GravityTable::Entry& entry : input.gravity->of(u)) {
            const Vector3d a = (entry.acceleration - calibration.bias).cwiseQuotient(calibration.scale);
            sum[input.gravityGroup[u]][entry.pose] += state.T_r_u[u]->linear() * a;
            told[input.gravityGroup[u]][entry.pose] = true;
        }
    }
    state.up_r.assign(groups, std::vector<std::optional<Vector3d>>(poses));
    for (std::size_t g = 0; g < groups; ++g) {
        for (std::size_t p = 0; p < poses; ++p) {
            if (!told[g][p])
                continue;
            // Readings may sum to nothing along a pose; such a direction is any.
            state.up_r[g][p] = sum[g][p].norm() > 1e-9 ? Vector3d(sum[g][p].normalized()) : Vector3d(0, 0, 1);
        }
    }
}

tl::expected<AdjustmentResult, CalibrationError> adjustBody(const AdjustmentInput& input, BodyState start,
                                                            const Gauge& gauge, const AdjustmentOptions& options,
                                                            const RunContext& context) {
    requireConsistent(input, start, options);
    if (context.isCancelled())
        return tl::unexpected(CalibrationError{ErrorCode::Cancelled, {}});
    BodyState state = withUpDirections(input, std::move(start));
    Problem problem(input, state, options);
    if (!problem.fix(gauge))
        return tl::unexpected(CalibrationError{ErrorCode::TooFewPoints, {}});

    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solver.max_num_iterations = options.maxIterations;
    solver.function_tolerance = 1e-9;
    solver.parameter_tolerance = 1e-10;
    solver.logging_type = ceres::SILENT;
    StopWhenCancelled stop(context);
    solver.callbacks.push_back(&stop);
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem.ceres(), &summary);
    if (context.isCancelled())
        return tl::unexpected(CalibrationError{ErrorCode::Cancelled, {}});
    if (!summary.IsSolutionUsable())
        return tl::unexpected(CalibrationError{ErrorCode::NotConverged, {}});

    AdjustmentResult result;
    problem.copyOut(state);
    result.state = std::move(state);
    result.summary.usable = true;
    result.summary.iterations = static_cast<int>(summary.iterations.size());
    result.summary.initialCost = summary.initial_cost;
    result.summary.finalCost = summary.final_cost;
    result.summary.residuals = static_cast<std::size_t>(summary.num_residuals);
    result.summary.parameters = static_cast<std::size_t>(summary.num_effective_parameters);
    return result;
}

tl::expected<Eigen::MatrixXd, CalibrationError> viewPoseBound(const AdjustmentInput& input, const BodyState& truth,
                                                              const std::vector<std::size_t>& views, const Gauge& gauge,
                                                              AdjustmentOptions options) {
    return poseBound(input, truth, views, true, gauge, options);
}

tl::expected<Eigen::MatrixXd, CalibrationError> modulePoseBound(const AdjustmentInput& input, const BodyState& truth,
                                                                const std::vector<std::size_t>& modules,
                                                                const Gauge& gauge, AdjustmentOptions options) {
    return poseBound(input, truth, modules, false, gauge, options);
}

}  // namespace skincal
