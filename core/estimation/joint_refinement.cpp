#include "core/estimation/joint_refinement.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/estimation/second_place.h"
#include "core/estimation/stage_clock.h"
#include "core/geometry/statistics.h"

namespace skincal {
namespace {

/// True where the weights changed no more.
bool reweight(const NoiseComponents& noise, const RefinementOptions& options, AdjustmentOptions& weights) {
    const AdjustmentOptions known;
    const double n = options.priorMeasurements;
    bool stands = true;
    const auto apply = [&](const VarianceComponent& component, double before, double& sigma) {
        const double factor = component.factor(n, before / sigma);
        stands = stands && std::abs(factor - 1) < options.weightTolerance;
        sigma *= factor;
        return factor;
    };
    apply(noise.pixel, known.pixelSigmaFactor, weights.pixelSigmaFactor);
    weights.accelerometerSigmaFactor *= apply(noise.gravity, known.accelerometerSigma, weights.accelerometerSigma);
    apply(noise.link, known.linkSigma, weights.linkSigma);
    apply(noise.bias, known.biasSigma, weights.biasSigma);
    apply(noise.scale, known.scaleSigma, weights.scaleSigma);
    return stands;
}

struct Sum {
    double squares = 0;
    double redundancy = 0;

    void add(const std::optional<MeasurementReview>& review) {
        squares += review ? review->squares : 0;
        redundancy += review ? review->redundancy : 0;
    }
};

/// Less than this is checked by too little to say anything of its noise.
constexpr double kLeastRedundancy = 6;

/// Noise of each group of measurements against that of the typical one; those within `limit` count as typical.
/// True where nothing changed much.
bool judgeGroups(const std::vector<Sum>& sums, double limit, std::vector<double>& noise) {
    std::vector<double> factors;
    for (const Sum& sum : sums) {
        if (sum.redundancy > kLeastRedundancy)
            factors.push_back(std::sqrt(sum.squares / sum.redundancy));
    }
    noise.resize(sums.size(), 1);
    constexpr std::size_t kEnoughToCompare = 4;
    if (factors.size() < kEnoughToCompare)
        return true;
    // Residuals that are nothing against their standard deviation are rounding: which group has more of it says
    // nothing.
    constexpr double kRounding = 1e-2;
    const double typical = std::max(kRounding, median(std::move(factors)));
    bool stands = true;
    for (std::size_t k = 0; k < sums.size(); ++k) {
        if (sums[k].redundancy <= kLeastRedundancy)
            continue;
        const double found = noise[k] * std::sqrt(sums[k].squares / sums[k].redundancy) / typical;
        const double now = found > limit ? found : 1;
        constexpr double kSame = 1.1;
        stands = stands && now < kSame * noise[k] && noise[k] < kSame * now;
        noise[k] = now;
    }
    return stands;
}

bool judgeGravity(const SolutionReview& review, const RefinementOptions& options, AdjustmentInput& input) {
    std::vector<Sum> ofPose(input.gravity->poseCount());
    std::vector<Sum> ofModule(review.gravity.size());
    for (std::size_t u = 0; u < review.gravity.size(); ++u) {
        for (std::size_t e = 0; e < review.gravity[u].size(); ++e) {
            ofPose[input.gravity->of(u)[e].pose].add(review.gravity[u][e]);
            ofModule[u].add(review.gravity[u][e]);
        }
    }
    const bool poses = judgeGroups(ofPose, options.noisyPose, input.poseNoise);
    // A shaken pose spoils all modules alike: modules are judged once the poses stand.
    return poses && judgeGroups(ofModule, options.noisyAccelerometer, input.moduleNoise);
}

bool judgeViews(const AdjustmentInput& used, const SolutionReview& review, const RefinementOptions& options,
                BodySolution& solution) {
    std::vector<Sum> ofView(solution.solved.T_r_v.size());
    for (std::size_t i = 0; i < used.pixels.size(); ++i)
        ofView[used.pixels[i].view].add(review.pixels[i]);
    const std::vector<double> before = solution.input.viewNoise;
    bool stands = judgeGroups(ofView, options.noisyView, solution.input.viewNoise);
    const std::vector<bool> doubtful = viewsWithManyRejected(solution);
    for (std::size_t v = 0; v < ofView.size(); ++v) {
        if (solution.input.viewNoise[v] > 1 || doubtful[v])
            stands = !setSecondPlaceAside(solution, v) && stands;
    }
    return stands;
}

}  // namespace

bool RefinementOptions::validate() const {
    return priorMeasurements >= 0 && rejectionSigmas > 1 && maxReweightings > 0 && weightTolerance > 0 &&
           lossBegins >= 0 && noisyPose > 1 && noisyAccelerometer > 1 && noisyView > 1;
}

tl::expected<std::optional<SolutionReview>, CalibrationError> refineJointly(BodySolution& solution,
                                                                            const RefinementOptions& options,
                                                                            const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("RefinementOptions out of range");
    StageClock clock("joint adjustment");
    int iterations = 0;
    std::optional<SolutionReview> review;
    rejectFarDetections(solution, options.rejectionSigmas);
    for (int i = 0; i < options.maxReweightings; ++i) {
        context.report(Sentence::saying("weighing the measurements"), static_cast<double>(i) / options.maxReweightings);
        AdjustmentInput used = usedMeasurements(solution);
        const auto took = adjustSolution(solution, used, context);
        if (!took && took.error().code == ErrorCode::TooFewPoints)
            break;  // nothing is left that the gauge could hold
        if (!took)
            return tl::unexpected(took.error());
        iterations += *took;
        auto found = reviewSolution(used, solution.solved, solution.gauge, solution.weights, context);
        if (!found && found.error().code == ErrorCode::Cancelled)
            return tl::unexpected(found.error());
        if (!found)
            break;
        review = std::move(*found);
        const bool weightsStand = reweight(review->noise, options, solution.weights);
        const bool gravityStands = judgeGravity(*review, options, solution.input);
        const bool viewsStand = judgeViews(used, *review, options, solution);
        const std::vector<bool> before = solution.estimate.rejected;
        rejectFarDetections(solution, options.rejectionSigmas);
        if (weightsStand && gravityStands && viewsStand && before == solution.estimate.rejected)
            break;
    }
    solution.estimate.stages.push_back(clock.stop(iterations));
    return review;
}

}  // namespace skincal
