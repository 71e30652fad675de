#include "core/session/solution.h"

#include "core/estimation/stage_clock.h"

namespace skincal {

tl::expected<std::shared_ptr<const Solution>, CalibrationError> solve(std::shared_ptr<const Measurements> measurements,
                                                                      std::uint64_t revision, const Solution* last,
                                                                      const RunContext& context) {
    const StageClock clock("solve");
    const JointMethodOptions options;
    auto gravity = std::make_shared<const GravityTable>(measurements->skin, measurements->gravity);
    auto solved = last != nullptr ? updateJointly(last->solved, *measurements, *gravity, options, context)
                                  : solveJointly(*measurements, *gravity, options, context);
    if (!solved)
        return tl::unexpected(solved.error());
    auto result = std::make_shared<Solution>();
    result->revision = revision;
    result->isUpdate = last != nullptr;
    result->body = describeSolution(*solved, options.start.initial.pose);
    result->body.generator.version = SKINCAL_VERSION;
    result->body.generator.options["method"] = "joint";
    result->shortfalls = findShortfalls(*solved);
    result->measurements = std::move(measurements);
    result->gravity = std::move(gravity);
    result->solved = *std::move(solved);
    result->seconds = clock.stop().seconds;
    return result;
}

Guidance guidanceFor(const Solution& solution, const RunContext& context) {
    Guidance guidance;
    guidance.revision = solution.revision;
    if (!solution.solved.anyViewPlaced())
        return guidance;
    if (auto poses = rankNextPoses(solution.solved, {}, context))
        guidance.poses = *std::move(poses);
    if (auto views = rankNextViews(solution.solved, {}, context))
        guidance.views = *std::move(views);
    return guidance;
}

}  // namespace skincal
