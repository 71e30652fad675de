#pragma once

#include <QObject>
#include <QTimer>
#include <chrono>
#include <memory>
#include <optional>

#include "core/procedure/scan_run.h"
#include "core/session/session_data.h"
#include "core/vision/coded_scan.h"
#include "ui/presenters/workbench.h"

namespace skincal {

/// Why a scan was broken off, to stand behind a colon; empty where it was not.
/// @param words  of whoever failed, in place of ours
[[nodiscard]] QString sentenceOf(const ScanRun& run, const QString& words);

/// Takes a picture of each of a list of lit sets, with the skin and the camera that are on the workbench; the camera
/// must run meanwhile. What either of them does wrong ends it. Where the first set is dark and the second has all LEDs
/// of the list, as codedScan() has them, light is timed and pictures come at the camera's rate (ScanRun).
class PictureSeries : public QObject {
    Q_OBJECT
  public:
    explicit PictureSeries(Workbench& workbench, QObject* parent = nullptr);

    void start(LitSets lit);
    /// After complete(): these are taken, too, and complete() comes again.
    void extend(const LitSets& more);
    void pause();
    void resume();
    void cancel();
    /// @param words  of whoever failed, where it has any
    void fail(ScanRun::Fault fault, const QString& words = {});
    /// What was to be done with the pictures is done.
    void finish();

    [[nodiscard]] const ScanRun& state() const { return state_; }
    /// Why it was broken off, to stand behind a colon; empty where it was not.
    [[nodiscard]] QString why() const { return sentenceOf(state_, words_); }
    /// Until finish(), cancel() or a failure.
    [[nodiscard]] bool isBusy() const { return needsCamera() || state_.phase == ScanRun::Phase::Decoding; }
    [[nodiscard]] bool needsCamera() const { return state_.isRunning() || state_.phase == ScanRun::Phase::Paused; }
    [[nodiscard]] const LitSets& lit() const { return lit_; }
    /// The one that was taken of a lit set, see kept().
    [[nodiscard]] const cv::Mat& pictureOf(std::size_t frame) const { return pictures_[frame]; }
    /// All that were taken, in the order in which they were: what moves meanwhile, moves on. After complete().
    struct Taken {
        std::vector<FrameInfo> frames;
        std::shared_ptr<const Pictures> pictures;
    };
    [[nodiscard]] Taken taken() const;

    /// Of this look: share of the pictures that are taken, and how long the rest takes at the pace so far, by the
    /// camera's clock and without pauses; nothing at the beginning.
    [[nodiscard]] double done() const;
    [[nodiscard]] std::optional<std::chrono::milliseconds> timeLeft() const;

  signals:
    /// Before the first light and after the last.
    void runningChanged(bool running);
    void stateChanged();
    /// There is a picture of this lit set and of all before it: each once, in the order of the list.
    void kept(std::size_t frame);
    /// All pictures are there: finish() or fail() is to follow.
    void complete();
    /// They are of no use any more.
    void discarded();

  private:
    void attachCamera();
    void attachSkin();
    void take(const CameraFrame& frame);
    void keep(std::size_t frame);
    [[nodiscard]] scan_run::Toggles toggles() const;
    void handle(const scan_run::Event& event);
    void act(const scan_run::Effect& effect);

    [[nodiscard]] ScanRun::Time now() const;

    Workbench& workbench_;
    ScanRun state_;
    QTimer timer_;
    LitSets lit_;
    Pictures pictures_;              ///< one per lit set
    std::vector<FrameInfo> frames_;  ///< likewise
    std::size_t told_ = 0;           ///< by kept()
    std::size_t before_ = 0;         ///< frames of earlier looks
    std::size_t unpaced_ = 0;        ///< frames that were taken before began_
    CameraFrame newest_;
    cv::Mat reference_;
    ScanRun::Time began_{0};               ///< once light was timed, and later by as long as it paused
    std::optional<ScanRun::Time> paused_;  ///< since then
    QString words_;                        ///< of who failed last
};

}  // namespace skincal
