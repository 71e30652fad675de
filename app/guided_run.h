#pragma once

#include <QObject>
#include <QSocketNotifier>
#include <QTimer>
#include <optional>

#include "app/absence.h"
#include "ui/presenters/connect_presenter.h"
#include "ui/presenters/pose_presenter.h"
#include "ui/presenters/scan_presenter.h"

namespace skincal {

struct GuidedRunOptions {
    int poses = 8;
    int views = 4;
    ScanCode code = ScanCode::Words;
    QString directory;                   ///< of the recording
    QString onPose;                      ///< shell command that turns the body; empty: a person does
    QString onView;                      ///< shell command that moves the camera; empty: a person does
    std::chrono::seconds patience{120};  ///< for a step that a command prepares
    std::chrono::seconds absence{120};   ///< of a skin or camera that was lost, until the run ends
};

/// The guided procedure without a window: connect, a picture, poses, views, each written to the recording as soon as it
/// is there.
/// It drives the presenters that the window's pages show; lines on standard error say what is going on and what a
/// person has to do, Enter says that it is done. Poses and views that the session has already are not taken again; it
/// stops where they are of another skin.
///
/// A skin or camera that is lost in the midst is waited for; what it was needed for is done anew then. What fails
/// otherwise is tried three times.
///
/// Commands run before each pose and view but the first, with SKINCAL_POSE or SKINCAL_VIEW set to its number from 0 on,
/// and SKINCAL_UP to where up should point, in the frame of the module SKINCAL_MODULE ("x y z").
class GuidedRun : public QObject {
    Q_OBJECT
  public:
    GuidedRun(Workbench& workbench, GuidedRunOptions options);

    void begin();

  signals:
    /// @param why  empty where all was measured and is in the recording
    void finished(const QString& why);

  private:
    enum class Step { Connecting, Camera, Posing, Scanning, Done };  // Camera comes again after Posing

    void connectionChanged();
    void connected();
    void skinIsBack();
    void cameraFailed(const QString& why);
    void pictureChanged();
    void noteControls();
    void beginWaiting(Absence& absence, const QString& why);
    /// With what waits for skin and camera, once both are there.
    void goOn();
    void startCamera();
    void beginPoses();
    void endPoses();
    void nextPose();
    void awaitPose();
    void poseCaptured(int pose);
    void nextView();
    void startScan();
    void scanFailed();
    void viewScanned(const std::string& view);
    void save();
    void stop(const QString& why);
    void say(const QString& text) const;
    /// `then` once the command has ended well, or a person has pressed Enter.
    void prepare(const QString& command, const QString& request, std::vector<std::pair<QString, QString>> environment,
                 std::function<void()> then);

    Workbench& workbench_;
    GuidedRunOptions options_;
    ConnectPresenter connect_;
    PosePresenter poses_;
    ScanPresenter scan_;
    Skin skin_;  ///< the one that is calibrated; without modules before any is known
    Absence skinGone_;
    Absence cameraGone_;
    Step step_ = Step::Connecting;
    int captured_ = 0;
    int scanned_ = 0;
    int tries_ = 0;             ///< of the scan of this view
    bool isToldKnown_ = false;  ///< that this pose is none
    bool isPoseDue_ = false;    ///< all is done for the body to come to rest
    bool isScanDue_ = false;    ///< it begins as soon as skin and camera are there
    bool isFailed_ = false;     ///< the scan, when it last changed
    bool areControlsTold_ = false;
    std::function<void()> afterEnter_;
    QSocketNotifier input_;
    QTimer patience_;
};

}  // namespace skincal
