#include "tests/ui/window/driven_window.h"

#include <gtest/gtest.h>

#include <QDir>
#include <QListView>
#include <QThreadPool>

#include "tests/ui/watchful_application.h"
#include "tests/wait_for.h"
#include "ui/scene3d/body_view_widget.h"

namespace skincal {
namespace {

Workbench& withRig(Workbench& workbench, SimulatedRig& rig) {
    rig.setSpeed(0);
    offerRig(workbench, rig);
    return workbench;
}

}  // namespace

DrivenWindow::DrivenWindow(const std::string& scenario)
    : rig(*findScenario(scenario), 1), window(withRig(workbench, rig)) {
    WatchfulApplication::instance().forget();
    window.show();
    (void)QTest::qWaitForWindowExposed(&window);
}

DrivenWindow::~DrivenWindow() {
    // A test takes its pictures where it is, which may be within an event.
    if (qEnvironmentVariableIsSet("SKINCAL_SCREENSHOTS"))
        return;
    const WatchfulApplication::Stall& stall = WatchfulApplication::instance().longest();
    EXPECT_LT(stall.seconds, WatchfulApplication::kLongest) << stall.what;
}

void DrivenWindow::finishFiles() {
    QThreadPool::globalInstance()->waitForDone();
    QCoreApplication::processEvents();
}

bool DrivenWindow::waitFor(const std::function<bool()>& isSo) {
    return test::waitFor(isSo);
}

bool DrivenWindow::click(const char* name) {
    auto* button = find<QPushButton>(name);
    if (button == nullptr || !button->isVisible() || !waitFor([&] { return button->isEnabled(); }))
        return false;
    QTest::mouseClick(button, Qt::LeftButton);
    return true;
}

bool DrivenWindow::goTo(Step step) {
    auto* list = find<QListView>("steps");
    const QModelIndex index = list->model()->index(static_cast<int>(step), 0);
    list->scrollTo(index);
    QTest::mouseClick(list->viewport(), Qt::LeftButton, {}, list->visualRect(index).center());
    return window.step() == step;
}

std::size_t DrivenWindow::patchesPlaced() {
    if (!session().solution())
        return 0;
    const auto& patches = session().solution()->body.patches;
    return static_cast<std::size_t>(std::count_if(
        patches.begin(), patches.end(), [](const BodyPatch& patch) { return patch.T_body_patch.has_value(); }));
}

bool DrivenWindow::isSolved() {
    return session().solution() && session().solution()->revision == session().revision() && !session().isSolving();
}

bool DrivenWindow::connectSkin() {
    return goTo(Step::Connect) && click("connect") && waitFor([&] { return workbench.isSkinReady(); });
}

bool DrivenWindow::capturePoses(std::size_t poses) {
    if (!goTo(Step::Pose))
        return false;
    const auto count = [&] { return posesOf(session().measured(), session().decisions()).size(); };
    while (count() < poses) {
        const std::size_t before = count();
        if (before > 0 && !click("turn"))
            return false;
        if (!waitFor([&] { return count() > before; }))
            return false;
    }
    return true;
}

bool DrivenWindow::useMakersIntrinsics() {
    return goTo(Step::Camera) && click("makersIntrinsics") && session().decisions().camera.has_value();
}

bool DrivenWindow::scanHere() {
    const std::size_t before = session().measured().views.size();
    return goTo(Step::Scan) && click("scan") && waitFor([&] { return session().measured().views.size() > before; });
}

bool DrivenWindow::moveCameraOn() {
    if (!goTo(Step::Views))
        return false;
    // Its advice comes after the body; what can be pressed is not in its way.
    if (!waitFor([&] { return session().guidance() != nullptr; }))
        return false;
    return click("moveCamera") && waitFor([&] { return rig.isCameraAtRest(); });
}

void DrivenWindow::takeInBothThemes(const QString& name, const std::function<QImage()>& take) {
    const QString folder = qEnvironmentVariable("SKINCAL_SCREENSHOTS");
    if (folder.isEmpty())
        return;
    QDir().mkpath(folder);
    for (const bool dark : {false, true}) {
        window.setDark(dark);
        for (int turn = 0; turn < 20; ++turn)
            QCoreApplication::processEvents();
        take().save(QDir(folder).filePath(name + (dark ? QStringLiteral("-dark.png") : QStringLiteral(".png"))));
    }
}

void DrivenWindow::takePicture(const QString& name) {
    takeInBothThemes(name, [this] {
        // Smooth, however lately something moved.
        (void)window.bodyView().grabPicture();
        constexpr int kWidth = 1080;  // what a page on the web has room for
        return window.grab().toImage().scaledToWidth(kWidth, Qt::SmoothTransformation);
    });
}

void DrivenWindow::takePictureOf(QWidget& widget, const QString& name) {
    takeInBothThemes(name, [&widget] { return widget.grab().toImage(); });
}

void DrivenWindow::takeBodyPicture(const QString& name) {
    const QString folder = qEnvironmentVariable("SKINCAL_SCREENSHOTS");
    if (folder.isEmpty())
        return;
    for (int turn = 0; turn < 20; ++turn)
        QCoreApplication::processEvents();
    QDir().mkpath(folder);
    window.bodyView().grabPicture().save(QDir(folder).filePath(name + QStringLiteral(".png")));
}

}  // namespace skincal
