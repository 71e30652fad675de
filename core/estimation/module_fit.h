#pragma once

#include <optional>
#include <vector>

#include "core/estimation/body_solution.h"

namespace skincal {

/// A rigid module laid into the places that others have for its points: the ports of its neighbours and its LED.
struct RigidFit {
    Isometry3d T_r_u = Isometry3d::Identity();
    double rms = 0;  ///< m, over the points
};

/// The pose that fits best a module of the given type (Umeyama, no scale). Links count whatever they were taken for.
/// @param led  where the views see its LED, if they do.
/// Two points fix no pose: there it stays turned as the solution has it. Nothing from fewer.
[[nodiscard]] std::optional<RigidFit> fitModule(const BodySolution& solution, std::size_t module,
                                                const ModuleTemplate& type, const std::optional<Vector3d>& led);

/// Another template of the skin that fits where the module's neighbours and its LED are, as its own does not.
struct OtherTemplate {
    const ModuleTemplate* type = nullptr;
    double ownRms = 0;  ///< m
    double rms = 0;
};
[[nodiscard]] std::optional<OtherTemplate> otherTemplate(const BodySolution& solution, std::size_t module,
                                                         const std::optional<Vector3d>& led, double fits);

}  // namespace skincal
