#include "core/adjustment/pixel_prediction.h"

#include <stdexcept>

#include "core/adjustment/linearisation.h"

namespace skincal {
namespace {

bool takesPart(AdjustmentProblem& problem, const PoseBlocks& pose) {
    return problem.ceres().HasParameterBlock(pose.q.data()) && problem.ceres().HasParameterBlock(pose.t.data());
}

}  // namespace

tl::expected<std::vector<std::optional<PixelPrediction>>, CalibrationError> predictPixels(
    const AdjustmentInput& input, const BodyState& state, const Gauge& gauge, const AdjustmentOptions& options,
    const std::vector<LedInView>& leds, const RunContext& context) {
    // Their inverse is known only between unknowns that a measurement ties together: what is asked for becomes one that
    // is too vague to tell anything. A picture's width is a few thousand pixels.
    constexpr double kVague_px = 1e7;
    AdjustmentProblem::requireConsistent(input, state, options);
    const BodyState complete = AdjustmentProblem::withUpDirections(input, state);
    std::vector<std::optional<PixelPrediction>> predictions(leds.size());
    AdjustmentInput asked = input;
    std::vector<std::size_t> askedFor;  // per entry that was added
    {
        // A vague measurement must not bring in what nothing else was measured of.
        AdjustmentProblem measured(input, complete, options);
        for (std::size_t i = 0; i < leds.size(); ++i) {
            if (leds[i].view >= state.T_r_v.size() || leds[i].module >= state.T_r_u.size())
                throw std::logic_error("predictPixels: no such view or module");
            PixelObservation o{leds[i].view, leds[i].module, Vector2d::Zero(), kVague_px};
            const auto residual = pixelResidual(input, complete, o);
            if (!residual || !takesPart(measured, measured.view(o.view)) ||
                !takesPart(measured, measured.module(o.module)))
                continue;
            o.pixel = -*residual;
            predictions[i] = PixelPrediction{o.pixel, Eigen::Matrix2d::Zero()};
            asked.pixels.push_back(o);
            askedFor.push_back(i);
        }
    }
    if (askedFor.empty())
        return predictions;
    AdjustmentProblem problem(asked, complete, options);
    Linearisation linear;
    const bool isFixed = problem.fix(gauge) && linearise(problem, options, linear, context);
    if (context.isCancelled())
        return tl::unexpected(CalibrationError{ErrorCode::Cancelled, {}});
    if (!isFixed)
        return tl::unexpected(CalibrationError{ErrorCode::DegeneratePoints, {}});
    const SelectedInverse inverse(linear.factor, context);
    if (context.isCancelled())
        return tl::unexpected(CalibrationError{ErrorCode::Cancelled, {}});
    for (const LinearisedBlock& block : linear.blocks) {
        if (block.kind != MeasurementKind::Pixel || block.source.index < input.pixels.size())
            continue;
        const double sigma = asked.sigmaOf(asked.pixels[block.source.index], options);
        predictions[askedFor[block.source.index - input.pixels.size()]]->covariance =
            sigma * sigma * forecastCovariance(linear, block, inverse);
    }
    return predictions;
}

}  // namespace skincal
