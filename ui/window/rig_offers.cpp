#include "ui/window/rig_offers.h"

#include <QCoreApplication>

#include "core/rig/simulated_camera.h"
#include "core/rig/simulated_skin.h"
#include "core/simulation/body_surface.h"

namespace skincal {
namespace {

struct RigWords {
    Q_DECLARE_TR_FUNCTIONS(RigWords)
};

}  // namespace

RigOffers offerRig(Workbench& workbench, SimulatedRig& rig) {
    const RigOffers offers{workbench.skinOffers.size(), workbench.cameraOffers.size()};
    workbench.skinOffers.push_back({RigWords::tr("Simulated arm"), RigWords::tr("A skin on a simulated desk"),
                                    [&rig] { return std::make_unique<SimulatedSkin>(rig); }});
    workbench.cameraOffers.push_back({RigWords::tr("Simulated webcam"), RigWords::tr("It looks at the simulated desk"),
                                      [&rig] { return std::make_unique<SimulatedCamera>(rig); }});
    const auto poseOf = [&rig](ModuleId module) {
        return rig.world().T_r_u.at(rig.world().skin.indexById().at(module));
    };
    RigHands hands;
    hands.holds = [modules = rig.world().skin.indexById()](ModuleId module) { return modules.contains(module); };
    hands.turnBody = [&rig, poseOf](ModuleId module, const Vector3d& up_u) {
        rig.turnBody(poseOf(module).linear() * up_u);
    };
    hands.moveCamera = [&rig, poseOf](ModuleId module, const Isometry3d& T_u_v) {
        rig.moveCamera(poseOf(module) * T_u_v);
    };
    hands.moveCameraOn = [&rig, place = std::size_t{0}]() mutable {
        place = (place + 1) % rig.suggestedViews().size();
        rig.moveCamera(rig.suggestedViews()[place]);
    };
    hands.touch = [&rig, poseOf](ModuleId module, const Vector3d& point_u, double force) {
        rig.touch(poseOf(module) * point_u, force);
    };
    hands.release = [&rig] { rig.release(); };
    hands.holdBoard = [&rig](const BoardPlan& plan) { rig.holdBoard(plan); };
    hands.putBoardAway = [&rig] { rig.putBoardAway(); };
    hands.bodySurface = [&rig] { return bodySurface(rig.world()); };
    hands.intrinsics = rig.world().scenario.camera;
    workbench.hands = std::move(hands);
    return offers;
}

}  // namespace skincal
