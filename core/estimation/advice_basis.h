#pragma once

#include <string>
#include <vector>

#include "core/adjustment/body_precision.h"
#include "core/estimation/body_solution.h"
#include "core/geometry/sentence.h"

namespace skincal {

/// The part of a solution that its measurements hold: what advice can be computed on. It refers to the solution's
/// measurements and gravity table.
struct AdviceBasis {
    AdjustmentInput used;  ///< the detections that count, and those of known views only
    BodyState state;       ///< without modules that nothing holds, and views whose few LEDs tell but their own pose

    [[nodiscard]] bool isPlaced(std::size_t module) const { return state.T_r_u[module].has_value(); }
    [[nodiscard]] std::size_t placedModules() const;
};

[[nodiscard]] AdviceBasis adviceBasis(const BodySolution& solution);

/// "module 3", "modules 3, 7 and 9", "modules 3, 7, … and 12 more".
[[nodiscard]] Sentence listed(const std::vector<ModuleId>& modules);
[[nodiscard]] Sentence listed(const std::vector<PatchId>& patches);
/// Of views, by name.
[[nodiscard]] Sentence listedViews(const std::vector<std::string>& views);

/// How to hold the body so that `up_r` points up, seen from the view that the body frame stands in: "the left of the
/// picture of view0 is up, leaned 25° towards the side facing the camera". In axes of the body frame where there is no
/// such view.
/// @param up_r  unit vector against gravity, body frame.
[[nodiscard]] Sentence wordsForUp(const Vector3d& up_r, const BodySolution& solution);

}  // namespace skincal
