#include "core/adjustment/body_adjustment.h"

#include <ceres/ceres.h>

#include <cmath>
#include <stdexcept>

#include "core/adjustment/adjustment_problem.h"
#include "core/geometry/stop_when_cancelled.h"

namespace skincal {
bool AdjustmentOptions::validate() const {
    return accelerometerSigma > 0 && linkSigma > 0 && biasSigma > 0 && scaleSigma > 0 && misalignmentSigma >= 0 &&
           gravity > 0 && pixelSigmaFloor_px > 0 && pixelSigmaFactor > 0 && accelerometerSigmaFactor > 0 &&
           pixelLoss >= 0 && gravityLoss >= 0 && linkLoss >= 0 && lossBegins >= 0 && maxIterations > 0 && tolerance > 0;
}

double AdjustmentInput::sigmaOf(const PixelObservation& o, const AdjustmentOptions& options) const {
    const double own = options.pixelSigmaFactor * std::max(o.sigma_px, options.pixelSigmaFloor_px);
    return own * (viewNoise.empty() ? 1 : viewNoise[o.view]);
}

double AdjustmentInput::sigmaOf(std::size_t u, const GravityTable::Entry& reading,
                                const AdjustmentOptions& options) const {
    const double own = reading.sigma ? *reading.sigma * options.accelerometerSigmaFactor : options.accelerometerSigma;
    return own * (poseNoise.empty() ? 1 : poseNoise[reading.pose]) * (moduleNoise.empty() ? 1 : moduleNoise[u]);
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
        residuals.emplace_back(entry.acceleration - c.reading(gravity * (T_r_u->linear().transpose() * *up)));
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
            const double weight = input.moduleNoise.empty() ? 1 : 1 / (input.moduleNoise[u] * input.moduleNoise[u]);
            sum[input.gravityGroup[u]][entry.pose] +=
                weight * (state.T_r_u[u]->linear() * calibration.specificForce(entry.acceleration));
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
    AdjustmentProblem::requireConsistent(input, start, options);
    if (context.isCancelled())
        return tl::unexpected(CalibrationError{ErrorCode::Cancelled, {}});
    BodyState state = AdjustmentProblem::withUpDirections(input, std::move(start));
    AdjustmentProblem problem(input, state, options);
    if (!problem.fix(gauge))
        return tl::unexpected(CalibrationError{ErrorCode::TooFewPoints, {}});

    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    // Fronts are small (a module has twelve unknowns), which suits a simplicial factorisation. Four iterations over
    // 1,000 modules take it 0.21 s, CHOLMOD 0.59 s, Schur complements 0.54 s (Eigen) and 0.61 s (CHOLMOD); over 10,000
    // with 60 views 4.0 s, CHOLMOD 4.5 s, Schur complements twice that, sparse and iterative alike; over 100,000 with
    // 600 views ten times what 10,000 take. One thread: sums over threads would differ from run to run.
    // From 350,000 unknowns on Eigen's ordering may overflow (see WideOrdering).
    constexpr int kMostForEigen = 300'000;
    const bool isHuge = problem.ceres().NumParameters() > kMostForEigen;
    solver.sparse_linear_algebra_library_type = isHuge ? ceres::SUITE_SPARSE : ceres::EIGEN_SPARSE;
    // Ceres' own 1e4 holds back the softest modes of a large body, which then take a step per factor of three: with 1e8
    // half as many steps reach the same minimum. Where steps fail it shrinks fast enough.
    solver.initial_trust_region_radius = 1e8;
    solver.max_num_iterations = options.maxIterations;
    solver.function_tolerance = options.tolerance;
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

}  // namespace skincal
