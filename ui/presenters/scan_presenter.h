#pragma once

#include <QFutureWatcher>
#include <QObject>
#include <atomic>

#include "core/vision/further_looks.h"
#include "core/vision/scan_code.h"
#include "ui/presenters/detection_model.h"
#include "ui/presenters/picture_series.h"
#include "ui/presenters/scan_job.h"
#include "ui/presenters/spot_watcher.h"

namespace skincal {

/// A scan keeps all of its pictures.
[[nodiscard]] bool fitIntoMemory(std::size_t pictures, const cv::Mat& picture);

/// Scans views, and shows what was found in each.
class ScanPresenter : public QObject {
    Q_OBJECT
  public:
    explicit ScanPresenter(Workbench& workbench, QObject* parent = nullptr);
    ~ScanPresenter() override;

    [[nodiscard]] DetectionModel& detections() { return detections_; }
    [[nodiscard]] const ScanRun& state() const { return series_.state(); }
    /// Why the last scan was broken off, to stand behind a colon; empty where it was not.
    [[nodiscard]] QString why() const { return series_.why(); }
    /// Why a scan can't begin, in a sentence; empty where it can.
    [[nodiscard]] QString obstacle() const;

    /// A new view, or in the place of one that is there; as soon as the camera, just started, gives pictures.
    void start(const std::optional<std::string>& replaced = std::nullopt);
    void pause() { series_.pause(); }
    void resume() { series_.resume(); }
    /// In a further look it ends the scan with what the looks before it found.
    void cancel() { series_.cancel(); }

    /// Modules that are being looked for once more, since light was left that blinks like none that was found; empty in
    /// the first look at all of them.
    [[nodiscard]] const std::vector<ModuleId>& wanted() const;
    /// A scan that was broken off in a further look left the view that is shown.
    [[nodiscard]] bool isKept() const { return isKept_; }
    /// How modules are told apart, from the next scan on.
    [[nodiscard]] ScanCode code() const { return code_; }
    void setCode(ScanCode code);
    /// Whether to look again, where the first look leaves modules undecided.
    [[nodiscard]] bool looksAgain() const { return looksAgain_; }
    void setLooksAgain(bool again) { looksAgain_ = again; }

    /// From the first light to the new view.
    [[nodiscard]] bool isBusy() const { return series_.isBusy(); }
    /// As PictureSeries says.
    [[nodiscard]] double done() const { return series_.done(); }
    [[nodiscard]] std::optional<std::chrono::milliseconds> timeLeft() const { return series_.timeLeft(); }
    /// What the running scan has found so far; the last one's while no other runs.
    [[nodiscard]] const std::vector<LiveSpot>& spots() const { return watcher_.spots(); }

    /// By how much the camera has moved in the running scan; empty while it stands.
    [[nodiscard]] std::optional<double> movedSoFar_px() const { return watcher_.moved_px(); }

    /// How many pictures a scan by code() takes.
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
    void spotsChanged();
    void shownViewChanged();
    void cameraFailed(const QString& why);
    /// A scan has become a view.
    /// @param shone  spots that shone with the first light: many more of them than modules found say that it went wrong
    void scanned(const std::string& view, double moved_px, std::size_t shone);

  private:
    [[nodiscard]] bool isWaitingForPicture() const { return newest_.image.empty() || !isPictureNew_; }
    [[nodiscard]] std::vector<ModuleId> modules() const;
    void countPictures();
    void attachCamera();
    void seriesChanged();
    void decode();
    void discard();
    void decodingFinished();
    void deliver(ScanResult result);

    using Outcome = tl::expected<ScanResult, Sentence>;

    Workbench& workbench_;
    DetectionModel detections_;
    PictureSeries series_;
    SpotWatcher watcher_;
    std::optional<std::string> replaced_;
    std::size_t firstLook_ = 0;  ///< pictures of it
    std::optional<FurtherLooks> further_;
    std::optional<ScanResult> result_;  ///< of all looks so far, should the next one be broken off
    ScanCode code_ = ScanCode::Words;
    bool looksAgain_ = true;
    std::uint64_t scans_ = 0;  ///< that were begun
    bool isKept_ = false;
    CameraFrame newest_;
    std::shared_ptr<std::atomic<bool>> cancelled_;
    QFutureWatcher<std::shared_ptr<Outcome>> decoding_;
    std::size_t picturesOfAScan_ = 0;
    bool isActive_ = false;
    bool isCameraRunning_ = false;
    bool isStartDue_ = false;    ///< once the first picture comes
    bool isPictureNew_ = false;  ///< taken since the camera was started last
    bool neededCamera_ = false;  ///< the series, when it last changed
};

}  // namespace skincal
