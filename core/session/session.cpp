#include "core/session/session.h"

#include <QPointer>
#include <QTimer>
#include <QUndoCommand>
#include <QtConcurrent/QtConcurrentRun>
#include <algorithm>

#include "core/session/session_storage.h"

namespace skincal {

/// Swaps two sets of decisions, back and forth.
class DecideCommand : public QUndoCommand {
  public:
    DecideCommand(Session& session, Decisions other, const QString& text)
        : QUndoCommand(text), session_(session), other_(std::move(other)) {}

    void undo() override { session_.swapDecisions(other_); }
    void redo() override { session_.swapDecisions(other_); }

  private:
    Session& session_;
    Decisions other_;
};

Session::Session(QObject* parent) : QObject(parent), undoStack_(this), solver_(this) {
    files_.setMaxThreadCount(1);  // one after the other
    connect(&solver_, &Solver::solved, this, [this](std::shared_ptr<const Solution> solution) {
        failure_.clear();
        solution_ = std::move(solution);
        emit solutionChanged();
    });
    connect(&solver_, &Solver::failed, this, [this](const QString& why, std::uint64_t revision) {
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
    return pose;
}

std::string Session::addView(ScannedView view) {
    for (std::size_t number = measured_.views.size();; ++number) {
        view.name = "view" + std::to_string(number);
        if (findView(view.name) == nullptr)
            break;
    }
    view.decoded.name = view.name;
    measured_.views.push_back(std::move(view));
    emit viewsChanged();
    changed(true);
    return measured_.views.back().name;
}

void Session::replaceView(ScannedView view) {
    const auto existing = std::find_if(measured_.views.begin(), measured_.views.end(),
                                       [&](const ScannedView& other) { return other.name == view.name; });
    if (existing == measured_.views.end())
        return;
    view.decoded.name = view.name;
    *existing = std::move(view);
    emit viewsChanged();
    changed(false);
}

void Session::decide(const QString& text, const std::function<void(Decisions&)>& change) {
    Decisions other = decisions_;
    change(other);
    if (other == decisions_)
        return;
    undoStack_.push(new DecideCommand(*this, std::move(other), text));
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
                readSession(directory.toStdString(), context));
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

void Session::swapDecisions(Decisions& other) {
    std::swap(decisions_, other);
    emit decisionsChanged();
    changed(false);
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
        if (solution_ || !failure_.isEmpty() || isSolving())
            forgetSolution();
        return;
    }
    const bool onlyGrew = std::exchange(onlyGrew_, true);
    solver_.request(std::make_shared<const Measurements>(measurementsOf(measured_, decisions_)), revision_, onlyGrew);
}

}  // namespace skincal
