#include "ui/presenters/board_presenter.h"

#include <QtConcurrent/QtConcurrentRun>

#include "ui/presenters/board_words.h"
#include "ui/presenters/lens_words.h"

namespace skincal {

BoardPresenter::BoardPresenter(Workbench& workbench, ScanPresenter& scan, QObject* parent)
    : QObject(parent), workbench_(workbench), scan_(scan) {
    // One that looks for boards, one that calibrates; neither waits for what else the program computes.
    workers_.setMaxThreadCount(2);
    connect(&scan, &ScanPresenter::pictureChanged, this, &BoardPresenter::look);
    connect(&scan, &ScanPresenter::cameraFailed, this, &BoardPresenter::interrupt);
    connect(&workbench, &Workbench::cameraChosen, this, [this] {
        forget();
        interrupt(tr("Another camera was chosen."));
    });
    connect(&search_, &QFutureWatcherBase::finished, this, &BoardPresenter::searched);
    connect(&calibrationWatcher_, &QFutureWatcherBase::finished, this, &BoardPresenter::calibrated);
}

BoardPresenter::~BoardPresenter() {
    // Who listens may be gone already.
    blockSignals(true);
    stop();
    if (calibrating_)
        calibrating_->isCancelled = true;
    workers_.waitForDone();
}

void BoardPresenter::setPlan(const BoardPlan& plan) {
    if (isSameBoard(plan, this->plan()))
        return;
    collector_ = BoardCollector(plan);
    forget();
    if (isLooking_ && workbench_.hands && workbench_.hands->holdBoard)
        workbench_.hands->holdBoard(plan);
    emit stateChanged();
}

void BoardPresenter::setLens(DistortionModel lens) {
    if (std::exchange(lens_, lens) == lens)
        return;
    calibration_.reset();
    if (calibrating_)
        calibrating_->isCancelled = true;
    calibrateSoon();
    emit calibrationChanged();
}

void BoardPresenter::start() {
    if (isLooking_)
        return;
    isLooking_ = true;
    sight_ = {};
    scan_.setActive(true);
    if (workbench_.hands && workbench_.hands->holdBoard)
        workbench_.hands->holdBoard(plan());
    emit stateChanged();
    emit sightChanged();
}

void BoardPresenter::stop() {
    if (!isLooking_)
        return;
    isLooking_ = false;
    ++run_;
    next_.release();
    sight_ = {};
    if (workbench_.hands && workbench_.hands->putBoardAway)
        workbench_.hands->putBoardAway();
    emit stateChanged();
    emit sightChanged();
}

void BoardPresenter::interrupt(const QString& why) {
    if (!isLooking_)
        return;
    stop();
    emit interrupted(why);
}

void BoardPresenter::clear() {
    if (!collector_.views().empty())
        removed_.push_back(collector_.views());
    begin();
}

void BoardPresenter::forget() {
    removed_.clear();
    begin();
}

void BoardPresenter::begin() {
    ++run_;
    collector_ = BoardCollector(plan());
    sight_ = {};
    changeBoards();
    emit sightChanged();
}

QString BoardPresenter::wish() const {
    const auto missing = collector_.missing();
    return missing.empty() ? QString() : sentenceOf(missing.front());
}

void BoardPresenter::remove(std::size_t board) {
    std::vector<BoardView> removed{collector_.views().at(board)};
    collector_.remove(board);
    removed_.push_back(std::move(removed));
    changeBoards();
}

void BoardPresenter::takeBack() {
    if (!canTakeBack())
        return;
    const std::vector<BoardView> views = std::move(removed_.back());
    removed_.pop_back();
    for (const BoardView& view : views)
        collector_.takeBack(view);
    changeBoards();
}

/// Others than were added by themselves: numbers of a calibration no longer fit.
void BoardPresenter::changeBoards() {
    calibration_.reset();
    failure_.clear();
    if (calibrating_)
        calibrating_->isCancelled = true;
    emit boardsChanged();
    calibrateSoon();
}

void BoardPresenter::look() {
    if (!isLooking_ || scan_.picture().empty())
        return;
    next_ = scan_.picture();
    if (!isSearching_)
        search();
}

void BoardPresenter::search() {
    isSearching_ = true;
    search_.setFuture(QtConcurrent::run(&workers_, [picture = std::exchange(next_, {}), plan = plan(), run = run_] {
        return std::make_shared<Search>(Search{picture, findBoard(picture, plan), run});
    }));
}

void BoardPresenter::searched() {
    isSearching_ = false;
    const std::shared_ptr<Search> result = search_.result();
    if (isLooking_ && !next_.empty())
        search();
    if (isLooking_ && result->run == run_) {
        sight_.picture = result->picture;
        offer(result->found);
    }
}

void BoardPresenter::offer(const Found& found) {
    if (!found) {
        sight_ = {BoardSight::Kind::Refused, sight_.picture, std::nullopt, sentenceOf(found.error(), plan())};
        emit sightChanged();
        return;
    }
    const OfferOutcome outcome = collector_.offer(*found);
    sight_.view = *found;
    if (outcome == OfferOutcome::Kept) {
        sight_.kind = BoardSight::Kind::Kept;
        sight_.sentence = tr("Board %1 taken.").arg(collector_.views().size());
    } else if (outcome != OfferOutcome::Redundant || sight_.kind != BoardSight::Kind::Kept) {
        // One that was just taken is like itself: that it was taken is what to say until it moves.
        sight_.kind = BoardSight::Kind::Refused;
        sight_.sentence = sentenceOf(outcome);
    }
    emit sightChanged();
    if (outcome == OfferOutcome::Kept) {
        emit boardsChanged();
        calibrateSoon();
    }
}

void BoardPresenter::calibrateSoon() {
    isCalibrationDue_ = true;
    if (calibrating_)
        return;
    isCalibrationDue_ = false;
    if (collector_.views().size() >= kLeastBoards) {
        calibrating_ = std::make_shared<Task>();
        calibrating_->boards = collector_.views().size();
        RunContext context;
        context.isCancelled = [task = calibrating_] { return task->isCancelled.load(); };
        CameraCalibrationOptions options;
        options.model = lens_;
        calibrationWatcher_.setFuture(
            QtConcurrent::run(&workers_, [views = collector_.views(), plan = plan(), options, context] {
                return std::make_shared<Outcome>(calibrateCamera(views, plan, options, context));
            }));
    }
    emit calibrationChanged();
}

void BoardPresenter::calibrated() {
    const std::shared_ptr<Task> task = std::exchange(calibrating_, nullptr);
    const std::shared_ptr<Outcome> outcome = calibrationWatcher_.result();
    if (!task->isCancelled) {
        failure_ = *outcome ? QString() : sentenceOf(outcome->error());
        calibration_ = *outcome ? std::make_shared<const CameraCalibration>(**std::move(outcome)) : nullptr;
    }
    if (isCalibrationDue_)
        calibrateSoon();
    else
        emit calibrationChanged();
}

bool BoardPresenter::canAccept() const {
    return calibration_ && !calibrating_ && calibration_->boards.size() == collector_.views().size() &&
           calibration_->trust != CalibrationTrust::NotToBeTrusted;
}

void BoardPresenter::accept() {
    if (!canAccept())
        return;
    CameraOrigin origin;
    origin.kind = CameraOrigin::Kind::Calibrated;
    origin.boards = static_cast<int>(calibration_->boards.size() - calibration_->rejected.size());
    origin.rms_px = calibration_->rms_px;
    origin.date = today();
    workbench_.session().decide(tr("Intrinsics %1").arg(sentenceOf(origin)), [&](Decisions& decisions) {
        decisions.camera = calibration_->camera;
        decisions.cameraOrigin = origin;
    });
}

}  // namespace skincal
