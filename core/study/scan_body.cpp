#include "core/study/scan_body.h"

#include "core/estimation/joint_method.h"

namespace skincal {

std::vector<LedDetection> spotsTakenByBody(const World& world, const ViewDetections& view, const RunContext& context) {
    const Measurements measurements{world.skin, simulateGravity(world), world.scenario.camera, {view}};
    const GravityTable gravity(measurements.skin, measurements.gravity);
    const auto body = solveJointly(measurements, gravity, {}, context);
    std::vector<LedDetection> taken;
    if (!body)
        return taken;
    for (const SpotVerdict& verdict : body->estimate.spots) {
        if (!verdict.pixel || body->estimate.rejected[*verdict.pixel])
            continue;
        const PixelObservation& o = body->input.pixels[*verdict.pixel];
        taken.push_back({world.skin.modules[o.module].id, o.pixel, o.sigma_px});
    }
    return taken;
}

}  // namespace skincal
