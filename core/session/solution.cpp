#include "core/session/solution.h"

#include <algorithm>

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

bool isSameBody(const BodyModel& a, const BodyModel& b) {
    // Far below what any skin is known to: threads add up in another order, and no more.
    constexpr double kSame_m = 1e-6;
    constexpr double kSame_rad = 1e-5;
    const auto sameModule = [](const BodyModule& one, const BodyModule& other) {
        if (one.id != other.id || one.type != other.type || one.patch != other.patch || one.status != other.status ||
            one.seen != other.seen || one.T_body_module.has_value() != other.T_body_module.has_value())
            return false;
        if (!one.T_body_module)
            return true;
        const Isometry3d between = one.T_body_module->inverse() * *other.T_body_module;
        return between.translation().norm() < kSame_m && so3Log(between.linear()).norm() < kSame_rad;
    };
    const auto sameLink = [](const BodyLink& one, const BodyLink& other) {
        return one.link.a == other.link.a && one.link.b == other.link.b && one.link.a_port == other.link.a_port &&
               one.link.b_port == other.link.b_port && one.kind == other.kind;
    };
    const auto sameView = [](const BodyView& one, const BodyView& other) {
        return one.name == other.name && one.status == other.status;
    };
    return std::equal(a.modules.begin(), a.modules.end(), b.modules.begin(), b.modules.end(), sameModule) &&
           std::equal(a.links.begin(), a.links.end(), b.links.begin(), b.links.end(), sameLink) &&
           std::equal(a.views.begin(), a.views.end(), b.views.begin(), b.views.end(), sameView) &&
           a.quality.trust == b.quality.trust && a.quality.missing.size() == b.quality.missing.size() &&
           a.quality.findings.size() == b.quality.findings.size();
}

bool needsViews(const Solution& solution) {
    return std::any_of(solution.shortfalls.begin(), solution.shortfalls.end(), [](const Shortfall& shortfall) {
        return shortfall.kind == Shortfall::Kind::FewViews || shortfall.kind == Shortfall::Kind::ModulesUnseen;
    });
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
