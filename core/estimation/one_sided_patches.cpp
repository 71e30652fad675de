#include "core/estimation/one_sided_patches.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/estimation/advice_basis.h"

namespace skincal {
namespace {

constexpr std::size_t kLeds = 3;  // fewer say little of where a patch is

double largestAngle(const std::vector<Vector3d>& directions) {
    double angle = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
        for (std::size_t j = i + 1; j < directions.size(); ++j)
            angle = std::max(angle, std::acos(std::clamp(directions[i].dot(directions[j]), -1.0, 1.0)));
    }
    return angle;
}

Sentence sentenceOf(const OneSidedPatches& found) {
    const Sentence how =
        found.widestAngle > 0
            ? Sentence::saying("from one direction only (views at most {:.0f}° apart)", found.widestAngle / kDegree)
            : Sentence::saying("in one view only");
    return found.patches.size() == 1
               ? Sentence::saying(
                     "{} is seen {}, so that its distance from the camera rests on its own size: add a view "
                     "from 30° and more aside",
                     listed(found.patches), how)
               : Sentence::saying(
                     "{} are seen {}, so that their distance from the camera rests on their own size: add a "
                     "view from 30° and more aside",
                     listed(found.patches), how);
}

}  // namespace

OneSidedPatches oneSidedPatches(const SkinLayout& layout, const std::vector<PixelObservation>& used,
                                const BodyState& state, double viewAngle) {
    std::vector<std::map<std::size_t, std::size_t>> leds(layout.patches.size());  // per patch: by view
    for (const PixelObservation& o : used) {
        if (state.T_r_v[o.view])
            ++leds[layout.patchOf[o.module]][o.view];
    }
    OneSidedPatches found;
    for (std::size_t k = 0; k < layout.patches.size(); ++k) {
        const Patch& patch = layout.patches[k];
        if (!state.T_r_u[patch.origin])
            continue;
        const Vector3d middle = state.T_r_u[patch.origin]->translation();
        std::vector<Vector3d> directions;
        for (const auto& [v, count] : leds[k]) {
            if (count >= std::min(kLeds, patch.modules.size()))
                directions.push_back((state.T_r_v[v]->translation() - middle).normalized());
        }
        const double angle = largestAngle(directions);
        if (directions.empty() || angle >= viewAngle)
            continue;
        found.widestAngle = std::max(found.widestAngle, angle);
        found.patches.push_back(patch.id);
    }
    if (!found.patches.empty())
        found.text = sentenceOf(found);
    return found;
}

}  // namespace skincal
