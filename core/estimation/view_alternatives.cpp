#include "core/estimation/view_alternatives.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace skincal {
namespace {

/// Costs nearer than this (in log likelihood) leave the choice open: odds of 400, as weights come from few residuals.
constexpr double kDecisive = 6.0;

}  // namespace

tl::expected<SettledViews, CalibrationError> settleViews(const AdjustmentInput& input, BodyState start,
                                                         const std::vector<ViewAlternative>& alternatives,
                                                         const AdjustmentOptions& options, const RunContext& context) {
    SettledViews settled{std::move(start), {}, {}};
    std::set<std::size_t> undecided;
    const auto& modules = settled.state.T_r_u;
    const auto first = std::find_if(modules.begin(), modules.end(), [](const auto& T) { return T.has_value(); });
    if (first == modules.end())
        return settled;
    const auto fixedModule = static_cast<std::size_t>(first - modules.begin());
    const auto adjusted = [&](const BodyState& state) {
        return adjustBody(input, state, Gauge{{}, {fixedModule}}, options, context);
    };
    auto best = adjusted(settled.state);
    if (!best && best.error().code == ErrorCode::Cancelled)
        return tl::unexpected(best.error());
    for (const ViewAlternative& alternative : alternatives) {
        const auto& standing = settled.state.T_r_v[alternative.view];
        if (!standing)
            continue;
        BodyState other = settled.state;
        other.T_r_v[alternative.view] = alternative.T_r_v;
        auto result = adjusted(other);
        if (!result && result.error().code == ErrorCode::Cancelled)
            return tl::unexpected(result.error());
        if (!result) {
            settled.alternatives.push_back(alternative);
            continue;
        }
        const double more = best ? result->summary.finalCost - best->summary.finalCost : 0;
        if (best && std::abs(more) < kDecisive)
            undecided.insert(alternative.view);
        const bool better = !best || more < 0;
        settled.alternatives.push_back(alternative);
        if (better) {
            settled.alternatives.back().T_r_v = *standing;
            settled.state = std::move(other);
            best = std::move(result);
        }
    }
    settled.undecided.assign(undecided.begin(), undecided.end());
    return settled;
}

}  // namespace skincal
