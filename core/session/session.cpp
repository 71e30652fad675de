#include "core/session/session.h"

#include <QPointer>
#include <QTimer>
#include <QUndoCommand>
#include <QtConcurrent/QtConcurrentRun>
#include <algorithm>

#include "core/session/session_storage.h"

namespace skincal {

/// Changes decisions, back and forth.
class Session::DecideCommand : public QUndoCommand {
  public:
    DecideCommand(Session& session, DecisionChange change, const QString& text)
        : QUndoCommand(text), session_(session), change_(std::move(change)) {}

    void undo() override { session_.swap(change_); }
    void redo() override { session_.swap(change_); }

  private:
    Session& session_;
    DecisionChange change_;
};

/// Something was measured, and is there already: undone, it does not count.
class Session::MeasureCommand : public QUndoCommand {
  public:
    /// @param change  what makes it count no longer
    MeasureCommand(Session& session, DecisionChange change, const QString& text)
        : QUndoCommand(text), session_(session), change_(std::move(change)) {}

    void undo() override { session_.swap(change_); }
    void redo() override {
        if (!std::exchange(isNew_, false))
            session_.swap(change_);
    }

  private:
    Session& session_;
    DecisionChange change_;
    bool isNew_ = true;
};

/// One scan of a view in the place of another, and what was decided about each.
class Session::ReplaceCommand : public QUndoCommand {
  public:
    ReplaceCommand(Session& session, ScannedView other, DecisionChange change, const QString& text)
        : QUndoCommand(text), session_(session), other_(std::move(other)), change_(std::move(change)) {}

    void undo() override { redo(); }
    void redo() override {
        session_.swap(other_);
        session_.swap(change_);
    }

  private:
    Session& session_;
    ScannedView other_;
    DecisionChange change_;
};

namespace {

/// What no check has foreseen must not be lost on a thread that nobody listens to.
tl::expected<OpenedRecording, std::string> readOrExplain(const std::string& directory, const RunContext& context) {
    try {
        return readSession(directory, context);
    } catch (const std::exception& error) {
        return tl::unexpected(directory + ": it can't be read: " + error.what());
    }
}

}  // namespace

Session::Session(QObject* parent) : QObject(parent), undoStack_(this), solver_(this) {
    files_.setMaxThreadCount(1);  // one after the other
    connect(&solver_, &Solver::solved, this, [this](std::shared_ptr<const Solution> solution) {
        failure_.clear();
        solution_ = std::move(solution);
        emit solutionChanged();
    });
    connect(&solver_, &Solver::failed, this, [this](const Sentence& why, std::uint64_t revision) {
        if (revision != revision_)
            return;  // nobody can tell yet what the newest data give
        failure_ = why;
        emit solutionChanged();
    });
    connect(&solver_, &Solver::guided, this, [this](std::shared_ptr<const Guidance> guidance) {
        // It may have been on its way when the data changed.
        if (guidance->revision != revision_)
            return;
        guidance_ = std::move(guidance);
        emit guidanceChanged();
    });
    connect(&solver_, &Solver::busyChanged, this, &Session::solvingChanged);
    connect(&solver_, &Solver::progressed, this, &Session::solvingProgressed);
}

Session::~Session() {
    if (readingCancelled_)
        *readingCancelled_ = true;
    files_.waitForDone();
}

const ScannedView* Session::findView(const std::string& name) const {
    const auto found = std::find_if(measured_.views.begin(), measured_.views.end(),
                                    [&](const ScannedView& view) { return view.name == name; });
    return found == measured_.views.end() ? nullptr : &*found;
}

void Session::adoptSkin(Skin skin) {
    auto same = sameSkin(measured_.skin, skin);
    const bool isOther = !same;
    measured_.skin = same ? std::move(*same) : std::move(skin);
    if (isOther) {
        measured_.gravity.clear();
        measured_.views.clear();
        decisions_.links.clear();
        decisions_.detections.clear();
        decisions_.droppedPoses.clear();
        decisions_.droppedViews.clear();
        measured_.unknown.clear();
        measured_.unknownOfTypes.clear();
        undoStack_.clear();
        forgetSolution();
        emit posesChanged();
        emit viewsChanged();
        emit decisionsChanged();
    }
    emit skinChanged();
    changed(false);
}

int Session::addPose(std::vector<GravityReading> readings) {
    int pose = 0;
    for (const GravityReading& reading : measured_.gravity)
        pose = std::max(pose, reading.pose + 1);
    for (GravityReading& reading : readings) {
        reading.pose = pose;
        measured_.gravity.push_back(reading);
    }
    emit posesChanged();
    changed(true);
    Decisions without = decisions_;
    without.droppedPoses.insert(pose);
    undoStack_.push(
        new MeasureCommand(*this, DecisionChange(decisions_, without), tr("Capture pose %1").arg(pose + 1)));
    return pose;
}

std::string Session::addView(ScannedView view) {
    for (std::size_t number = measured_.views.size();; ++number) {
        view.name = "view" + std::to_string(number);
        if (findView(view.name) == nullptr)
            break;
    }
    view.decoded.name = view.name;
    const std::string name = view.name;
    measured_.views.push_back(std::move(view));
    emit viewsChanged();
    changed(true);
    Decisions without = decisions_;
    without.droppedViews.insert(name);
    undoStack_.push(new MeasureCommand(*this, DecisionChange(decisions_, without),
                                       tr("Scan %1").arg(QString::fromStdString(name))));
    return name;
}

void Session::replaceView(ScannedView view) {
    if (findView(view.name) == nullptr)
        return;
    view.decoded.name = view.name;
    Decisions after = decisions_;
    after.droppedViews.erase(view.name);
    std::erase_if(after.detections, [&](const auto& decision) { return decision.first.view == view.name; });
    const QString text = tr("Scan %1 again").arg(QString::fromStdString(view.name));
    undoStack_.push(new ReplaceCommand(*this, std::move(view), DecisionChange(decisions_, after), text));
}

void Session::decide(const QString& text, const std::function<void(Decisions&)>& change) {
    Decisions after = decisions_;
    change(after);
    if (after == decisions_)
        return;
    undoStack_.push(new DecideCommand(*this, DecisionChange(decisions_, after), text));
}

void Session::load(OpenedRecording recording) {
    measured_ = std::move(recording.measured);
    decisions_ = std::move(recording.decisions);
    undoStack_.clear();
    forgetSolution();
    emit skinChanged();
    emit posesChanged();
    emit viewsChanged();
    emit decisionsChanged();
    changed(false);
    setSaved(revision_);
}

void Session::open(const QString& directory) {
    if (readingCancelled_)
        *readingCancelled_ = true;
    readingCancelled_ = std::make_shared<std::atomic<bool>>(false);
    [[maybe_unused]] const auto future =
        QtConcurrent::run(&files_, [self = QPointer<Session>(this), directory, cancelled = readingCancelled_] {
            RunContext context;
            context.isCancelled = [cancelled] { return cancelled->load(); };
            auto recording = std::make_shared<tl::expected<OpenedRecording, std::string>>(
                readOrExplain(directory.toStdString(), context));
            const auto deliver = [self, directory, recording, cancelled] {
                if (!self || cancelled->load())
                    return;
                if (!*recording) {
                    emit self->fileFailed(QString::fromStdString(recording->error()));
                    return;
                }
                self->load(**std::move(recording));
                emit self->opened(directory);
            };
            QMetaObject::invokeMethod(self, deliver, Qt::QueuedConnection);
        });
}

void Session::setUnsaved() {
    savedRevision_ = revision_ - 1;
    emit modifiedChanged(true);
}

void Session::save(const QString& directory) {
    write(directory, false);
}

void Session::saveCopy(const QString& directory) {
    write(directory, true);
}

void Session::write(const QString& directory, bool isCopy) {
    if (!isCopy && !decisions_.camera) {
        const QString why = tr("The camera's intrinsics are not known yet, and a recording can't be without.");
        QMetaObject::invokeMethod(
            this, [this, why] { emit fileFailed(why); }, Qt::QueuedConnection);
        return;
    }
    [[maybe_unused]] const auto future =
        QtConcurrent::run(&files_, [self = QPointer<Session>(this), directory, measured = measured_,
                                    decisions = decisions_, revision = revision_, isCopy] {
            const auto written = writeSession(measured, decisions, directory.toStdString());
            const QString why = written ? QString() : QString::fromStdString(written.error());
            const auto deliver = [self, directory, why, revision, isCopy] {
                if (!self)
                    return;
                if (!why.isEmpty()) {
                    emit self->fileFailed(why);
                    return;
                }
                if (isCopy) {
                    emit self->copied(directory);
                    return;
                }
                self->setSaved(revision);
                emit self->saved(directory);
            };
            QMetaObject::invokeMethod(self, deliver, Qt::QueuedConnection);
        });
}

void Session::setSaved(std::uint64_t revision) {
    savedRevision_ = revision;
    emit modifiedChanged(isModified());
}

void Session::swap(DecisionChange& change) {
    change.swap(decisions_);
    emit decisionsChanged();
    changed(false);
}

void Session::swap(ScannedView& view) {
    const auto place = std::find_if(measured_.views.begin(), measured_.views.end(),
                                    [&](const ScannedView& other) { return other.name == view.name; });
    std::swap(*place, view);
    emit viewsChanged();
}

void Session::changed(bool onlyGrew) {
    ++revision_;
    onlyGrew_ = onlyGrew_ && onlyGrew;
    guidance_.reset();
    emit modifiedChanged(true);
    emit guidanceChanged();
    // Several changes in one turn of the event loop are solved once.
    if (!std::exchange(isSolveDue_, true))
        QTimer::singleShot(0, this, &Session::solveSoon);
}

void Session::forgetSolution() {
    solver_.reset();
    solution_.reset();
    guidance_.reset();
    failure_.clear();
    emit solutionChanged();
}

void Session::solveSoon() {
    isSolveDue_ = false;
    if (measured_.skin.modules.empty() || posesOf(measured_, decisions_).empty()) {
        // A body of what was taken away would be made up.
        if (solution_ || !failure_.empty() || isSolving())
            forgetSolution();
        return;
    }
    const bool onlyGrew = std::exchange(onlyGrew_, true);
    solver_.request(std::make_shared<const Measurements>(measurementsOf(measured_, decisions_)), revision_, onlyGrew);
}

}  // namespace skincal
