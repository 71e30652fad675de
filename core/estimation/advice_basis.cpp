#include "core/estimation/advice_basis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/estimation/module_support.h"

namespace skincal {
namespace {

/// Fewer LEDs than this leave a view's pose open, or tell nothing else.
constexpr std::size_t kLedsOfAView = 4;

struct Side {
    const char* first;  ///< with the view's name
    const char* short_;
};

/// Towards the axes of a camera, in pairs +x -x, +y -y, +z -z.
constexpr std::array<Side, 6> kSides{{{"the right of the picture of {}", "the right of the picture"},
                                      {"the left of the picture of {}", "the left of the picture"},
                                      {"the bottom of the picture of {}", "the bottom of the picture"},
                                      {"the top of the picture of {}", "the top of the picture"},
                                      {"the side away from the camera of {}", "the side away from the camera"},
                                      {"the side facing the camera of {}", "the side facing the camera"}}};

const Side& sideOf(const Vector3d& v, Eigen::Index axis) {
    return kSides.at(static_cast<std::size_t>(2 * axis + (v[axis] < 0 ? 1 : 0)));
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

std::string listed(const std::string& one, const std::string& many, const std::vector<std::string>& names) {
    if (names.size() == 1)
        return one + " " + names.front();
    constexpr std::size_t kNamed = 8;
    std::string text = many + " ";
    const std::size_t shown = names.size() <= kNamed ? names.size() - 1 : kNamed;
    for (std::size_t i = 0; i < shown; ++i)
        text += (i == 0 ? "" : ", ") + names[i];
    if (names.size() <= kNamed)
        return text + " and " + names.back();
    return text + fmt::format(" and {} more", names.size() - kNamed);
}

std::string listed(const std::vector<ModuleId>& modules) {
    std::vector<std::string> names;
    for (const ModuleId id : modules)
        names.push_back(std::to_string(id.value));
    return listed("module", "modules", names);
}

std::string listed(const std::vector<PatchId>& patches) {
    std::vector<std::string> names;
    for (const PatchId id : patches)
        names.push_back(std::to_string(id.value));
    return listed("patch", "patches", names);
}

std::string listedViews(const std::vector<std::string>& views) {
    // Many are called "view3" anyhow.
    const bool named =
        std::all_of(views.begin(), views.end(), [](const std::string& view) { return view.rfind("view", 0) == 0; });
    const std::string text = listed("view", "views", views);
    return named ? text.substr(text.find(' ') + 1) : text;
}

std::string wordsForUp(const Vector3d& up_r, const BodySolution& solution) {
    if (solution.gauge.views.empty() || !solution.solved.T_r_v[solution.gauge.views.front()])
        return fmt::format("({:.2f}, {:.2f}, {:.2f}) of the body frame is up", up_r.x(), up_r.y(), up_r.z());
    const std::size_t v = solution.gauge.views.front();
    const Vector3d up_v = solution.solved.T_r_v[v]->linear().transpose() * up_r;
    Eigen::Index main = 0;
    up_v.cwiseAbs().maxCoeff(&main);
    Vector3d rest = up_v;
    rest[main] = 0;
    Eigen::Index second = 0;
    rest.cwiseAbs().maxCoeff(&second);
    const double lean = std::acos(std::clamp(std::abs(up_v[main]), 0.0, 1.0));
    std::string text = fmt::format(fmt::runtime(sideOf(up_v, main).first), solution.measurements->views[v].name);
    text += " is up";
    constexpr double kUpright = 10 * kDegree;
    if (lean > kUpright)
        text += fmt::format(", leaned {:.0f}° towards {}", lean / kDegree, sideOf(rest, second).short_);
    return text;
}

}  // namespace skincal
