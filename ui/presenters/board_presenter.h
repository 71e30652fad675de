#pragma once

#include <QFutureWatcher>
#include <QObject>
#include <QThreadPool>
#include <atomic>
#include <memory>

#include "core/camera_calibration/board_collector.h"
#include "core/camera_calibration/board_finder.h"
#include "core/camera_calibration/calibrate_camera.h"
#include "ui/presenters/scan_presenter.h"

namespace skincal {

/// What became of the newest picture that was searched.
struct BoardSight {
    enum class Kind { None, Refused, Kept };
    Kind kind = Kind::None;
    cv::Mat picture;                ///< that was searched; empty before the first
    std::optional<BoardView> view;  ///< the board, where one was found
    QString sentence;               ///< that it was taken, or why not
};

/// Calibrates the camera from a board that is held before it. Boards are looked for in the newest picture, one picture
/// at a time, on another thread; those worth it are kept by themselves, and from kLeastBoards on a calibration of all
/// that are kept follows each change, on another thread again.
class BoardPresenter : public QObject {
    Q_OBJECT
  public:
    static constexpr std::size_t kLeastBoards = 5;

    /// Looks at the pictures that `scan` shows.
    BoardPresenter(Workbench& workbench, ScanPresenter& scan, QObject* parent = nullptr);
    /// Cancels what is under way and waits for it: a tenth of a second as a rule.
    ~BoardPresenter() override;

    [[nodiscard]] const BoardPlan& plan() const { return collector_.plan(); }
    /// Forgets the boards of another plan for good. Throws std::logic_error where it isn't valid (see planFault).
    void setPlan(const BoardPlan& plan);
    [[nodiscard]] DistortionModel lens() const { return lens_; }
    void setLens(DistortionModel lens);

    [[nodiscard]] bool isLooking() const { return isLooking_; }
    /// Starts the camera, too, where it stands still: it may have been unplugged.
    void start();
    /// Boards stay.
    void stop();
    /// Removes all boards.
    void clear();

    [[nodiscard]] const BoardSight& sight() const { return sight_; }
    [[nodiscard]] const BoardCollector& boards() const { return collector_; }
    /// What to do next, in a sentence; empty where there is enough.
    [[nodiscard]] QString wish() const;
    void remove(std::size_t board);
    [[nodiscard]] bool canTakeBack() const { return !removed_.empty(); }
    /// What was removed last counts again, one board or all of them; until there is another plan or camera.
    void takeBack();

    [[nodiscard]] bool isCalibrating() const { return calibrating_ != nullptr; }
    /// Of the boards there are, or of the first of them while a newer one is computed; null where there is none.
    [[nodiscard]] const std::shared_ptr<const CameraCalibration>& calibration() const { return calibration_; }
    /// Why there is none, in a sentence; empty where there is, or nobody has tried.
    [[nodiscard]] const QString& failure() const { return failure_; }
    /// Whether it is of all boards, and not to be distrusted.
    [[nodiscard]] bool canAccept() const;
    /// Its intrinsics become the session's; undoable. Nothing where canAccept() is false.
    void accept();

  signals:
    void stateChanged();  ///< of looking, or another plan
    void sightChanged();
    void boardsChanged();
    void calibrationChanged();
    /// Looking ended by itself.
    void interrupted(const QString& why);

  private:
    using Found = tl::expected<BoardView, BoardFault>;
    using Outcome = tl::expected<CameraCalibration, CalibrationError>;
    struct Search {
        cv::Mat picture;
        Found found;
        std::uint64_t run = 0;
    };
    struct Task {
        std::atomic<bool> isCancelled = false;
        std::size_t boards = 0;
    };

    void look();
    void search();
    void searched();
    void offer(const Found& found);
    void calibrateSoon();
    void calibrated();
    void interrupt(const QString& why);
    void changeBoards();
    void begin();
    void forget();

    Workbench& workbench_;
    ScanPresenter& scan_;
    BoardCollector collector_{BoardPlan{}};
    std::vector<std::vector<BoardView>> removed_;  ///< the last ones last
    DistortionModel lens_ = DistortionModel::PlumbBob;
    BoardSight sight_;
    std::shared_ptr<const CameraCalibration> calibration_;
    QString failure_;
    bool isLooking_ = false;
    std::uint64_t run_ = 0;  ///< results of earlier ones are late
    cv::Mat next_;           ///< to be searched once the one before is; empty where it was
    bool isSearching_ = false;
    std::shared_ptr<Task> calibrating_;
    bool isCalibrationDue_ = false;
    QFutureWatcher<std::shared_ptr<Search>> search_;
    QFutureWatcher<std::shared_ptr<Outcome>> calibrationWatcher_;
    QThreadPool workers_;  // last: ends before what it works on
};

}  // namespace skincal
