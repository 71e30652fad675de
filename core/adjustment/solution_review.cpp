#include "core/adjustment/solution_review.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "core/adjustment/linearisation.h"
#include "core/geometry/parallel.h"

namespace skincal {
namespace {

MeasurementReview reviewOf(const Linearisation& linear, const LinearisedBlock& block, const SelectedInverse& inverse) {
    const Eigen::Vector3d padded = [&] {
        Eigen::Vector3d r = Eigen::Vector3d::Zero();
        r.head(block.size) = linear.residuals.segment(block.row, block.size);
        return r;
    }();
    const auto r = padded.head(block.size);
    const double w = block.weight;
    const SmallMatrix P = forecastCovariance(linear, block, inverse);
    const SmallMatrix I = SmallMatrix::Identity(block.size, block.size);
    MeasurementReview review;
    review.squares = w * r.squaredNorm();
    review.redundancy = std::max(0.0, w * (static_cast<double>(block.size) - w * P.trace()));
    // What nothing else checks can't disagree; the least redundancy keeps the quotient finite.
    constexpr double kUnchecked = 1e-6;
    const SmallMatrix own = I - w * P + kUnchecked * I;
    const SmallMatrix all = I + (1 - w) * P;
    review.disagreement = std::max(0.0, r.dot(all.partialPivLu().solve(own.partialPivLu().solve(Eigen::VectorXd(r)))));
    return review;
}

const tl::unexpected<CalibrationError> kDegenerate(CalibrationError{ErrorCode::DegeneratePoints, {}});
const tl::unexpected<CalibrationError> kCancelled(CalibrationError{ErrorCode::Cancelled, {}});

std::optional<Matrix6d> covarianceOf(AdjustmentProblem& problem, std::size_t u, const Linearisation& linear,
                                     const SelectedInverse& inverse) {
    const PoseBlocks& pose = problem.module(u);
    const auto columns = linear.columnsOf(pose);
    if (!columns) {
        const bool held =
            problem.ceres().HasParameterBlock(pose.q.data()) && problem.ceres().HasParameterBlock(pose.t.data());
        return held ? std::optional<Matrix6d>(Matrix6d::Zero()) : std::nullopt;
    }
    Matrix6d C;
    for (Eigen::Index i = 0; i < 6; ++i) {
        for (Eigen::Index j = 0; j < 6; ++j)
            C(i, j) = tangentFactor(i) * tangentFactor(j) *
                      inverse(columns->at(static_cast<std::size_t>(i)), columns->at(static_cast<std::size_t>(j)));
    }
    return C;
}

}  // namespace

double VarianceComponent::factor(double n, double ratio) const {
    // Without a single check what was assumed stands.
    return redundancy + n > 0 ? std::sqrt((squares + n * ratio * ratio) / (redundancy + n)) : 1;
}

tl::expected<SolutionReview, CalibrationError> reviewSolution(const AdjustmentInput& input, const BodyState& state,
                                                              const Gauge& gauge, const AdjustmentOptions& options,
                                                              const RunContext& context) {
    AdjustmentProblem::requireConsistent(input, state, options);
    const BodyState complete = AdjustmentProblem::withUpDirections(input, state);
    AdjustmentProblem problem(input, complete, options);
    Linearisation linear;
    if (!problem.fix(gauge))
        return kDegenerate;
    if (context.isCancelled())
        return kCancelled;
    const bool isFixed = linearise(problem, options, linear, context);
    if (context.isCancelled())
        return kCancelled;
    if (!isFixed)
        return kDegenerate;
    const SelectedInverse inverse(linear.factor, context);
    const auto goOn = [&](std::size_t) { return !context.isCancelled(); };

    SolutionReview result;
    result.pixels.resize(input.pixels.size());
    result.links.resize(input.links.size());
    result.gravity.resize(state.T_r_u.size());
    for (std::size_t u = 0; u < state.T_r_u.size(); ++u)
        result.gravity[u].resize(input.gravity->of(u).size());
    std::array<VarianceComponent, kMeasurementKinds.size()> sums{};
    constexpr std::size_t kChunk = 256;
    std::vector<MeasurementReview> reviews(linear.blocks.size());
    forEachInParallel(
        reviews.size(), kChunk, [&](std::size_t i) { reviews[i] = reviewOf(linear, linear.blocks[i], inverse); }, goOn);
    if (context.isCancelled())
        return kCancelled;
    for (std::size_t i = 0; i < reviews.size(); ++i) {
        const LinearisedBlock& block = linear.blocks[i];
        const MeasurementReview& own = reviews[i];
        VarianceComponent& sum = sums.at(static_cast<std::size_t>(block.kind));
        sum.squares += own.squares;
        sum.redundancy += own.redundancy;
        if (block.kind == MeasurementKind::Pixel)
            result.pixels[block.source.index] = own;
        else if (block.kind == MeasurementKind::Link)
            result.links[block.source.index] = own;
        else if (block.kind == MeasurementKind::Gravity)
            result.gravity[block.source.index][block.source.entry] = own;
    }
    result.noise = {sums[0], sums[1], sums[2], sums[3], sums[4], sums[5]};
    result.covariances.resize(state.T_r_u.size());
    const auto addCovariance = [&](std::size_t u) {
        if (state.T_r_u[u])
            result.covariances[u] = covarianceOf(problem, u, linear, inverse);
    };
    forEachInParallel(state.T_r_u.size(), kChunk, addCovariance, goOn);
    if (context.isCancelled())
        return kCancelled;
    return result;
}

}  // namespace skincal
