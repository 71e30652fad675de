#pragma once

#include <QFutureWatcher>
#include <QObject>
#include <QTimer>
#include <atomic>
#include <chrono>

#include "core/procedure/scan_run.h"
#include "core/vision/coded_scan.h"
#include "ui/presenters/detection_model.h"
#include "ui/presenters/scan_job.h"
#include "ui/presenters/workbench.h"

namespace skincal {

/// Scans views, and shows what was found in each.
class ScanPresenter : public QObject {
    Q_OBJECT
  public:
    explicit ScanPresenter(Workbench& workbench, QObject* parent = nullptr);
    ~ScanPresenter() override;

    [[nodiscard]] DetectionModel& detections() { return detections_; }
    [[nodiscard]] const ScanRun& state() const { return state_; }
    /// Why a scan can't begin, in a sentence; empty where it can.
    [[nodiscard]] QString obstacle() const;

    /// A new view, or in the place of one that is there.
    void start(const std::optional<std::string>& replaced = std::nullopt);
    void pause();
    void resume();
    void cancel();

    /// Share of the pictures that are taken, and how long the rest takes at the pace so far; nothing at the beginning.
    [[nodiscard]] double done() const;
    [[nodiscard]] std::optional<std::chrono::milliseconds> timeLeft() const;

    /// How many pictures a scan takes.
    [[nodiscard]] std::size_t picturesOfAScan() const { return picturesOfAScan_; }

    /// The view whose detections are shown.
    [[nodiscard]] const std::string& shownView() const { return detections_.view(); }
    void showView(const std::string& view);
    /// Undoable; a dropped view does not count.
    void setDropped(const std::string& view, bool dropped);

    /// Newest picture of the camera; empty before the first.
    [[nodiscard]] const cv::Mat& picture() const { return newest_.image; }
    /// The camera runs while a page shows it.
    void setActive(bool active);

  signals:
    void stateChanged();
    void pictureChanged();
    void shownViewChanged();
    void cameraFailed(const QString& why);
    /// A scan has become a view.
    void scanned(const std::string& view, double moved_px);

  private:
    [[nodiscard]] std::vector<ModuleId> modules() const;
    void attachCamera();
    void attachSkin();
    void handle(const scan_run::Event& event);
    void act(const scan_run::Effect& effect);
    void decode();
    void decodingFinished();

    using Clock = std::chrono::steady_clock;
    using Outcome = tl::expected<ScanResult, std::string>;

    Workbench& workbench_;
    DetectionModel detections_;
    ScanRun state_;
    QTimer timer_;
    LitSets lit_;
    std::shared_ptr<Pictures> pictures_;
    std::vector<FrameInfo> frames_;
    std::optional<std::string> replaced_;
    CameraFrame newest_;
    Clock::time_point began_;
    std::shared_ptr<std::atomic<bool>> cancelled_;
    QFutureWatcher<std::shared_ptr<Outcome>> watcher_;
    std::size_t picturesOfAScan_ = 0;
    bool isActive_ = false;
    bool isCameraRunning_ = false;
    bool isPictureNew_ = false;  ///< taken since the camera was started last
};

}  // namespace skincal
