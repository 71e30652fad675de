#include "core/estimation/advice_basis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/estimation/module_support.h"

namespace skincal {
namespace {

/// Fewer LEDs than this leave a view's pose open, or tell nothing else.
constexpr std::size_t kLedsOfAView = 4;

/// The side of the picture, or of the camera, that v points to along an axis: numbers of +x -x, +y -y, +z -z.
std::size_t sideOf(const Vector3d& v, Eigen::Index axis) {
    return static_cast<std::size_t>(2 * axis + (v[axis] < 0 ? 1 : 0));
}

Sentence isUp(std::size_t side, const std::string& view) {
    switch (side) {
        case 0:
            return Sentence::saying("the right of the picture of {} is up", view);
        case 1:
            return Sentence::saying("the left of the picture of {} is up", view);
        case 2:
            return Sentence::saying("the bottom of the picture of {} is up", view);
        case 3:
            return Sentence::saying("the top of the picture of {} is up", view);
        case 4:
            return Sentence::saying("the side away from the camera of {} is up", view);
        default:
            return Sentence::saying("the side facing the camera of {} is up", view);
    }
}

Sentence towards(std::size_t side) {
    switch (side) {
        case 0:
            return Sentence::saying("the right of the picture");
        case 1:
            return Sentence::saying("the left of the picture");
        case 2:
            return Sentence::saying("the bottom of the picture");
        case 3:
            return Sentence::saying("the top of the picture");
        case 4:
            return Sentence::saying("the side away from the camera");
        default:
            return Sentence::saying("the side facing the camera");
    }
}

/// "3, 7 and 9", "3, 7, … and 12 more".
/// @param names  two at least.
Sentence enumerated(const std::vector<std::string>& names) {
    constexpr std::size_t kNamed = 8;
    const std::size_t shown = names.size() <= kNamed ? names.size() - 1 : kNamed;
    const auto end = names.begin() + static_cast<std::ptrdiff_t>(shown);
    const std::string first = fmt::format("{}", fmt::join(names.begin(), end, ", "));
    if (names.size() <= kNamed)
        return Sentence::saying("{} and {}", first, names.back());
    return Sentence::saying("{} and {} more", first, names.size() - kNamed);
}

}  // namespace

std::size_t AdviceBasis::placedModules() const {
    return static_cast<std::size_t>(
        std::count_if(state.T_r_u.begin(), state.T_r_u.end(), [](const auto& T) { return T.has_value(); }));
}

AdviceBasis adviceBasis(const BodySolution& solution) {
    AdviceBasis basis{usedMeasurements(solution), solution.solved};
    std::vector<bool> measured = solution.shapes.assumedFlat;
    measured.flip();
    const std::vector<bool> held = heldModules(basis.used, basis.state, std::move(measured));
    for (std::size_t u = 0; u < held.size(); ++u) {
        if (!held[u])
            basis.state.T_r_u[u].reset();
    }
    std::vector<std::size_t> leds(basis.state.T_r_v.size(), 0);
    for (const PixelObservation& o : basis.used.pixels)
        leds[o.view] += basis.isPlaced(o.module) ? 1 : 0;
    for (std::size_t v = 0; v < leds.size(); ++v) {
        if (leds[v] < kLedsOfAView)
            basis.state.T_r_v[v].reset();
    }
    std::erase_if(basis.used.pixels,
                  [&](const PixelObservation& o) { return !basis.state.T_r_v[o.view] || !basis.isPlaced(o.module); });
    return basis;
}

Sentence listed(const std::vector<ModuleId>& modules) {
    if (modules.size() == 1)
        return Sentence::saying("module {}", modules.front().value);
    std::vector<std::string> names;
    for (const ModuleId id : modules)
        names.push_back(std::to_string(id.value));
    return Sentence::saying("modules {}", enumerated(names));
}

Sentence listed(const std::vector<PatchId>& patches) {
    if (patches.size() == 1)
        return Sentence::saying("patch {}", patches.front().value);
    std::vector<std::string> names;
    for (const PatchId id : patches)
        names.push_back(std::to_string(id.value));
    return Sentence::saying("patches {}", enumerated(names));
}

Sentence listedViews(const std::vector<std::string>& views) {
    // Many are called "view3" anyhow.
    const bool areNamed =
        std::all_of(views.begin(), views.end(), [](const std::string& view) { return view.rfind("view", 0) == 0; });
    if (views.size() == 1)
        return areNamed ? Sentence::verbatim(views.front()) : Sentence::saying("view {}", views.front());
    return areNamed ? enumerated(views) : Sentence::saying("views {}", enumerated(views));
}

Sentence wordsForUp(const Vector3d& up_r, const BodySolution& solution) {
    if (solution.gauge.views.empty() || !solution.solved.T_r_v[solution.gauge.views.front()])
        return Sentence::saying("({:.2f}, {:.2f}, {:.2f}) of the body frame is up", up_r.x(), up_r.y(), up_r.z());
    const std::size_t v = solution.gauge.views.front();
    const Vector3d up_v = solution.solved.T_r_v[v]->linear().transpose() * up_r;
    Eigen::Index main = 0;
    up_v.cwiseAbs().maxCoeff(&main);
    Vector3d rest = up_v;
    rest[main] = 0;
    Eigen::Index second = 0;
    rest.cwiseAbs().maxCoeff(&second);
    const double lean = std::acos(std::clamp(std::abs(up_v[main]), 0.0, 1.0));
    const Sentence up = isUp(sideOf(up_v, main), solution.measurements->views[v].name);
    constexpr double kUpright = 10 * kDegree;
    if (lean <= kUpright)
        return up;
    return Sentence::saying("{}, leaned {:.0f}° towards {}", up, lean / kDegree, towards(sideOf(rest, second)));
}

}  // namespace skincal
