#include "core/estimation/joint_method.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/estimation/body_assembly.h"

namespace skincal {
namespace {

/// The detections that lie where the state has them, and in `estimate` why the others do not count.
AdjustmentInput withoutOutliers(const AdjustmentInput& input, const BodyState& state, const AdjustmentOptions& weights,
                                double rejectionSigmas, BodyEstimate& estimate) {
    AdjustmentInput kept = input;
    kept.pixels.clear();
    for (std::size_t i = 0; i < input.pixels.size(); ++i) {
        const PixelObservation& o = input.pixels[i];
        const auto r = pixelResidual(input, state, o);
        if (!r)
            continue;
        const double sigma = weights.pixelSigmaFactor * std::max(o.sigma_px, weights.pixelSigmaFloor_px);
        estimate.rejected[i] = r->norm() > rejectionSigmas * sigma;
        estimate.rejectedReason[i] =
            estimate.rejected[i]
                ? fmt::format("{:.1f} px from where the body has it, {:.0f} sigma", r->norm(), r->norm() / sigma)
                : std::string();
        if (!estimate.rejected[i])
            kept.pixels.push_back(o);
    }
    return kept;
}

/// True where the weights changed no more.
bool reweight(const NoiseFactors& factors, double tolerance, AdjustmentOptions& weights) {
    weights.pixelSigmaFactor *= factors.pixel;
    weights.accelerometerSigma *= factors.accelerometer;
    weights.accelerometerSigmaFactor *= factors.accelerometer;
    weights.linkSigma *= factors.link;
    weights.biasSigma *= factors.bias;
    weights.scaleSigma *= factors.scale;
    const auto stands = [&](double factor) { return std::abs(factor - 1) < tolerance; };
    return stands(factors.pixel) && stands(factors.accelerometer) && stands(factors.link) && stands(factors.bias) &&
           stands(factors.scale);
}

}  // namespace

bool JointMethodOptions::validate() const {
    return start.validate() && review.validate() && rejectionSigmas > 1 && maxReweightings > 0 && weightTolerance > 0 &&
           losses > 0;
}

tl::expected<BodyModel, CalibrationError> calibrateJoint(const Measurements& measurements,
                                                         const JointMethodOptions& options, const RunContext& context) {
    if (!options.validate())
        throw std::logic_error("JointMethodOptions out of range");
    const Refinement refine = [&](const AdjustmentInput& input, BodyState state, const Gauge& gauge,
                                  const AdjustmentOptions& found, BodyEstimate& estimate,
                                  const RunContext& part) -> tl::expected<BodyState, CalibrationError> {
        AdjustmentOptions weights = found;
        // The factor takes the place of the floor: detections may be better than any floor.
        constexpr double kFloor_px = 1e-3;
        weights.pixelSigmaFactor *= std::max(1.0, found.pixelSigmaFloor_px / 0.05);
        weights.pixelSigmaFloor_px = kFloor_px;
        weights.pixelLoss = 0;
        weights.gravityLoss = weights.linkLoss = options.losses;
        estimate.method = "joint";
        for (int i = 0; i < options.maxReweightings; ++i) {
            part.report("weighing the measurements", static_cast<double>(i) / options.maxReweightings);
            const AdjustmentInput kept = withoutOutliers(input, state, weights, options.rejectionSigmas, estimate);
            auto result = adjustBody(kept, state, gauge, weights, part);
            if (!result)
                return tl::unexpected(result.error());
            state = std::move(result->state);
            const auto factors = reviewSolution(kept, state, gauge, weights, options.review);
            if (!factors)
                return state;
            if (reweight(factors->noise, options.weightTolerance, weights))
                break;
        }
        const AdjustmentInput kept = withoutOutliers(input, state, weights, options.rejectionSigmas, estimate);
        auto result = adjustBody(kept, state, gauge, weights, part);
        if (!result)
            return tl::unexpected(result.error());
        if (auto last = reviewSolution(kept, result->state, gauge, weights, options.review))
            estimate.covariances = std::move(last->covariances);
        estimate.condition["pixel noise factor"] = weights.pixelSigmaFactor;
        estimate.condition["accelerometer sigma"] = weights.accelerometerSigma;
        estimate.condition["link sigma"] = weights.linkSigma;
        estimate.condition["bias sigma"] = weights.biasSigma;
        estimate.condition["scale sigma"] = weights.scaleSigma;
        return std::move(result->state);
    };
    auto body = calibrateSturdy(measurements, options.start, context, refine);
    if (body)
        body->generator.method = "joint";
    return body;
}

}  // namespace skincal
