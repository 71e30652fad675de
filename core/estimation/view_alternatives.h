#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "core/adjustment/body_adjustment.h"

namespace skincal {

/// Another place where a view could stand, in the body frame of the state that it belongs to.
struct ViewAlternative {
    std::size_t view = 0;
    Isometry3d T_r_v = Isometry3d::Identity();
    std::size_t patch = 0;  ///< which is alone in its picture
};

struct SettledViews {
    BodyState state;
    std::vector<std::size_t> undecided;         ///< views whose alternative costs nearly as little, rising
    std::vector<ViewAlternative> alternatives;  ///< places not taken
};

/// Settles by cost what no other evidence could: tries each alternative in turn, adjusts, and keeps the one that the
/// measurements like better. With the shape free to follow, the wrong pose of a flat patch explains its pixels worse.
/// Likelihoods are those of the weights in `options`: see settleViewsByLikelihood for when the weights are known.
/// Fails with Cancelled.
[[nodiscard]] tl::expected<SettledViews, CalibrationError> settleViews(const AdjustmentInput& input, BodyState start,
                                                                       const std::vector<ViewAlternative>& alternatives,
                                                                       const AdjustmentOptions& options = {},
                                                                       const RunContext& context = {});

}  // namespace skincal
