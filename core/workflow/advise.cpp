#include "core/workflow/advise.h"

#include "core/estimation/advice_basis.h"

namespace skincal {
namespace {

void describePrecision(const BodySolution& solution, Advice& advice) {
    const AdviceBasis basis = adviceBasis(solution);
    const auto precision = bodyPrecision(basis.used, basis.state, solution.gauge, solution.weights);
    if (!precision || !precision->worst())
        return;
    advice.worst = precision->worstSigma();
    advice.worstModule = basis.used.skin->modules[*precision->worst()].id;
    advice.worstSize = precision->size[*precision->worst()];
    advice.rms = precision->rmsSigma();
    advice.scale = precision->scale;
}

tl::unexpected<CalibrateError> failure(const CalibrationError& error) {
    return tl::unexpected(CalibrateError{error.message(), false, error.code == ErrorCode::Cancelled});
}

}  // namespace

tl::expected<Advice, CalibrateError> advise(const Recording& recording, const RecordingFrameLoader& load,
                                            AdviseOptions options, const RunContext& context) {
    options.calibrate.method = Method::Joint;
    const auto measurements = measure(recording, load, options.calibrate, context);
    if (!measurements)
        return tl::unexpected(measurements.error());
    const GravityTable gravity(measurements->skin, measurements->gravity);
    const auto solution = solveJointly(*measurements, gravity, options.calibrate.joint, context);
    if (!solution)
        return failure(solution.error());
    Advice advice;
    advice.shortfalls = findShortfalls(*solution, options.shortfalls);
    // Nothing to forecast from is for the shortfalls to explain.
    auto poses = rankNextPoses(*solution, options.next, context);
    if (!poses && poses.error().code == ErrorCode::Cancelled)
        return failure(poses.error());
    auto views = rankNextViews(*solution, options.next, context);
    if (!views && views.error().code == ErrorCode::Cancelled)
        return failure(views.error());
    if (poses)
        advice.poses = std::move(*poses);
    if (views)
        advice.views = std::move(*views);
    describePrecision(*solution, advice);
    advice.body = describeSolution(*solution, options.calibrate.joint.start.initial.pose);
    advice.body.generator.version = SKINCAL_VERSION;
    advice.body.generator.options["method"] = std::string(name(Method::Joint));
    return advice;
}

}  // namespace skincal
