#include "app/window.h"

#include <QApplication>
#include <QStyleFactory>

#include "app/command_line.h"
#include "core/rig/simulated_camera.h"
#include "core/rig/simulated_rig.h"
#include "core/rig/simulated_skin.h"
#include "ui/scene3d/scene_widget.h"
#include "ui/window/main_window.h"

namespace skincal {
namespace {

/// The simulated rig's devices among the offers, and its hands.
void offerRig(Workbench& workbench, SimulatedRig& rig) {
    workbench.skinOffers.push_back({QCoreApplication::translate("Window", "Simulated arm"),
                                    QCoreApplication::translate("Window", "A skin on a simulated desk"),
                                    [&rig] { return std::make_unique<SimulatedSkin>(rig); }});
    workbench.cameraOffers.push_back({QCoreApplication::translate("Window", "Simulated webcam"),
                                      QCoreApplication::translate("Window", "It looks at the simulated desk"),
                                      [&rig] { return std::make_unique<SimulatedCamera>(rig); }});
    RigHands hands;
    const auto poseOf = [&rig](ModuleId module) {
        return rig.world().T_r_u.at(rig.world().skin.indexById().at(module));
    };
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
    hands.intrinsics = rig.world().scenario.camera;
    workbench.hands = std::move(hands);
}

}  // namespace

int runWindow(int argc, char** argv, const WindowOptions& options) {
    if (qEnvironmentVariableIsEmpty("DISPLAY") && qEnvironmentVariableIsEmpty("WAYLAND_DISPLAY"))
        return badInput("there is no display to open the window on; \"skincal --help\" lists the commands that need none");
    QSurfaceFormat::setDefaultFormat(SceneWidget::sceneFormat());
    QApplication application(argc, argv);
    QApplication::setApplicationName(QStringLiteral("SkinCal"));
    QApplication::setApplicationVersion(QStringLiteral(SKINCAL_VERSION));
    QApplication::setStyle(QStyleFactory::create(QStringLiteral("Fusion")));
    constexpr std::uint64_t kSeed = 1;
    SimulatedRig rig(*findScenario(options.scenario), kSeed);
    Workbench workbench;
    offerRig(workbench, rig);
    MainWindow window(workbench);
    window.setDark(!options.light);
    window.show();
    if (options.recording)
        window.openRecording(QString::fromStdString(options.recording->string()));
    return QApplication::exec();
}

}  // namespace skincal
