#pragma once

#include <vector>

#include "core/estimation/advice_basis.h"

namespace skincal {

/// A place where a camera could stand.
struct ViewCandidate {
    Isometry3d T_r_v = Isometry3d::Identity();
    std::vector<PatchId> patches;  ///< one that it looks at, or two between which it looks
    Sentence words;                ///< "60 cm in front of patch 3, then 35° around it towards patch 1"
};

struct ViewCandidateOptions {
    double distance = 0.6;           ///< m, where there are no views to take it from
    double tilt = 35 * kDegree;      ///< off the normal
    double maxTurn = 100 * kDegree;  ///< patches whose normals differ by more are not looked at together

    [[nodiscard]] bool validate() const { return distance > 0 && tilt > 0 && tilt < 90 * kDegree && maxTurn > 0; }
};

/// Cameras round the body: straight in front of each placed patch and of the middle between neighbouring ones, and
/// tilted from there to four sides; at the distance of the views there are, or farther where the picture would not hold
/// what is looked at. A patch that faces all ways, as a ring does, is looked at from up to six sides.
/// The wide side of the picture lies along the line to the nearest patch.
/// Single modules of interest (those that no picture shows, say) are looked at straight, each by itself.
[[nodiscard]] std::vector<ViewCandidate> viewCandidates(const BodySolution& solution, const AdviceBasis& basis,
                                                        const std::vector<std::size_t>& modules,
                                                        const ViewCandidateOptions& options);

}  // namespace skincal
