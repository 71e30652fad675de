#include "app/window.h"

#include <QApplication>
#include <QDir>
#include <QStandardPaths>
#include <QStyleFactory>

#include "app/command_line.h"
#include "core/rig/simulated_rig.h"
#include "core/session/session_keeper.h"
#include "ui/texts/plural_forms.h"
#include "ui/window/camera_offers.h"
#include "ui/window/file_actions.h"
#include "ui/window/main_window.h"
#include "ui/window/rig_offers.h"
#include "ui/window/skin_offers.h"

namespace skincal {
int runWindow(int argc, char** argv, const WindowOptions& options) {
    if (qEnvironmentVariableIsEmpty("DISPLAY"))
        return badInput(
            "there is no display to open the window on; \"skincal --help\" lists the commands that need none");
    // The 3D view needs X, which Wayland's desktops offer, too.
    if (qEnvironmentVariableIsEmpty("QT_QPA_PLATFORM"))
        qputenv("QT_QPA_PLATFORM", "xcb");
    QApplication application(argc, argv);
    installPluralForms(application);
    QApplication::setApplicationName(QStringLiteral("SkinCal"));
    QApplication::setApplicationVersion(QStringLiteral(SKINCAL_VERSION));
    QApplication::setStyle(QStyleFactory::create(QStringLiteral("Fusion")));
    constexpr std::uint64_t kSeed = 1;
    SimulatedRig rig(*findScenario(options.scenario), kSeed);
    Workbench workbench;
    const RigOffers demo = offerRig(workbench, rig);
    MainWindow window(workbench);
    window.setDark(!options.light);
    window.show();
    // After the window is there: asking all cameras what they can do takes its time.
    const SkinOffers skins(workbench);
    const CameraOffers cameras(workbench, std::make_shared<CameraList>());
    const QString config = QStandardPaths::writableLocation(QStandardPaths::AppConfigLocation);
    window.files().keepRecentIn(QDir(config).filePath(QStringLiteral("window.ini")));
    const QString kept =
        QDir(QStandardPaths::writableLocation(QStandardPaths::AppDataLocation)).filePath(QStringLiteral("sessions"));
    SessionKeeper keeper(workbench.session(), kept);
    window.offerKept(keeper);
    if (options.demo)
        window.begin(demo);
    if (options.recording)
        window.openRecording(QString::fromStdString(options.recording->string()));
    return QApplication::exec();
}

}  // namespace skincal
