#pragma once

#include <memory>

#include "core/estimation/joint_method.h"
#include "core/simulation/world.h"
#include "core/study/study_world.h"

namespace skincal {

/// A simulated world, what was measured of it, and the joint solution. Stays where it is: the solution refers to it.
struct SolvedWorld {
    World world;
    Measurements measurements;
    GravityTable gravity;
    BodySolution solution;

    SolvedWorld(World w, Measurements m)
        : world(std::move(w)),
          measurements(std::move(m)),
          gravity(measurements.skin, measurements.gravity),
          solution(solveJointly(measurements, gravity).value()) {}
    explicit SolvedWorld(const World& w) : SolvedWorld(w, measurementsOf(w)) {}
    SolvedWorld(const SolvedWorld&) = delete;
    SolvedWorld& operator=(const SolvedWorld&) = delete;

    /// From the solution's body frame, that of the first placed view, into the world's.
    [[nodiscard]] Isometry3d T_w_r() const { return world.T_r_v[solution.gauge.views.front()]; }
};

/// A scenario that comes with the program.
[[nodiscard]] inline World scenarioWorld(std::string_view name, std::uint64_t seed) {
    return buildWorld(*findScenario(name), seed);
}

/// Detections of the modules (and in the views) for which `drop` is true are taken out.
template <class Drop>
void dropDetections(Measurements& measurements, const Drop& drop) {
    const auto index = measurements.skin.indexById();
    for (std::size_t v = 0; v < measurements.views.size(); ++v)
        std::erase_if(measurements.views[v].found, [&](const LedDetection& d) { return drop(v, index.at(d.module)); });
}

}  // namespace skincal
