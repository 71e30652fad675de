#pragma once

#include <QPushButton>
#include <QtTest/QTest>
#include <functional>

#include "ui/window/main_window.h"
#include "ui/window/rig_offers.h"

namespace skincal {

/// The real window on a simulated rig whose clock goes as fast as events do, driven by clicks and keys. The test fails
/// where any event from its first picture to its end kept the window from the others for too long.
class DrivenWindow {
  public:
    explicit DrivenWindow(const std::string& scenario = "demo");
    ~DrivenWindow();
    DrivenWindow(const DrivenWindow&) = delete;
    DrivenWindow& operator=(const DrivenWindow&) = delete;

    /// Runs the event loop until something is so; fails the test where it never is.
    /// Until files that are being read or written are, and the window knows.
    static void finishFiles();
    [[nodiscard]] bool waitFor(const std::function<bool()>& isSo);
    /// Clicks a button that is visible and enabled. False where there is none.
    [[nodiscard]] bool click(const char* button);
    /// Clicks a step in the list.
    [[nodiscard]] bool goTo(Step step);
    template <class Widget>
    [[nodiscard]] Widget* find(const char* name) {
        return window.findChild<Widget*>(QString::fromLatin1(name));
    }

    [[nodiscard]] Session& session() { return workbench.session(); }
    [[nodiscard]] StepModel& steps() { return window.steps(); }
    [[nodiscard]] std::size_t patchesPlaced();
    /// Of the newest data.
    [[nodiscard]] bool isSolved();

    /// Steps of the procedure, done as an operator would.
    [[nodiscard]] bool connectSkin();
    [[nodiscard]] bool capturePoses(std::size_t poses);
    [[nodiscard]] bool useMakersIntrinsics();
    [[nodiscard]] bool scanHere();
    [[nodiscard]] bool moveCameraOn();

    /// A picture of the window, where SKINCAL_SCREENSHOTS names a folder.
    void takePicture(const QString& name);
    /// Of another window of the program, likewise.
    void takePictureOf(QWidget& widget, const QString& name);
    /// Of the body alone, likewise.
    void takeBodyPicture(const QString& name);

    SimulatedRig rig;
    Workbench workbench;
    MainWindow window;

  private:
    void takeInBothThemes(const QString& name, const std::function<QImage()>& take);
};

}  // namespace skincal
