#pragma once

#include <QObject>
#include <QUndoStack>
#include <functional>
#include <memory>

#include "core/geometry/sentence.h"
#include "core/session/decision_change.h"
#include "core/session/session_data.h"
#include "core/session/solver.h"

namespace skincal {

/// The open document: what was measured, what the operator decided, and the newest body that follows from both. It
/// lives on the GUI's thread; solving is done on another. What is decided can be undone. What is measured stays, but
/// that a pose was captured or a view scanned can be undone, too: then it does not count, as if it were dropped.
class Session : public QObject {
    Q_OBJECT
  public:
    explicit Session(QObject* parent = nullptr);
    /// Cancels what is being read, waits for what is being written.
    ~Session() override;

    [[nodiscard]] const Measured& measured() const { return measured_; }
    [[nodiscard]] const Decisions& decisions() const { return decisions_; }
    /// Rises with every change of either.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }
    [[nodiscard]] QUndoStack& undoStack() { return undoStack_; }

    /// The newest body, not always of the newest data (see isStale); null before the first, and where no pose counts.
    [[nodiscard]] const std::shared_ptr<const Solution>& solution() const { return solution_; }
    /// What to measure next; null while unknown.
    [[nodiscard]] const std::shared_ptr<const Guidance>& guidance() const { return guidance_; }
    [[nodiscard]] bool isSolving() const { return solver_.isBusy(); }
    /// There is a body, and it is of older data: the newest are being solved, or give none (see failure).
    [[nodiscard]] bool isStale() const { return solution_ && (isSolving() || solution_->revision != revision_); }
    /// See Solver::setQuick.
    void setQuick(double seconds) { solver_.setQuick(seconds); }
    /// Why the newest data gave no body; empty where they did.
    [[nodiscard]] const Sentence& failure() const { return failure_; }

    [[nodiscard]] const ScannedView* findView(const std::string& name) const;

    /// The network as explored. Poses and views stay where it is the same skin (sameSkin); of another they are
    /// forgotten, since nothing tells what became of its modules.
    void adoptSkin(Skin skin);
    /// Undoable; whoever undoes it drops the pose.
    /// @return the new pose's number; `readings` get it.
    int addPose(std::vector<GravityReading> readings);
    /// Undoable; whoever undoes it drops the view.
    /// @return the new view's name.
    std::string addView(ScannedView view);
    /// In the place of one of the same name: scanned again. What was decided about the older scan does not hold for it.
    /// Undoable, which brings both back. Nothing where there is none.
    void replaceView(ScannedView view);

    /// Undoable. `text` is what the menu calls it.
    void decide(const QString& text, const std::function<void(Decisions&)>& change);

    /// An empty document, or one that was read.
    void load(OpenedRecording recording);

    /// Reads a recording on another thread; opened() or fileFailed() follows.
    void open(const QString& directory);
    /// What was opened has no place of its own yet.
    void setUnsaved();
    /// Writes likewise; saved() or fileFailed() follows. What changes meanwhile is not in it.
    void save(const QString& directory);
    /// The same beside what the operator saves: copied() or fileFailed() follows, and the document stays modified.
    void saveCopy(const QString& directory);

    /// Whether there is anything that save() would write anew.
    [[nodiscard]] bool isModified() const { return revision_ != savedRevision_; }

  signals:
    void skinChanged();
    void posesChanged();
    void viewsChanged();
    void decisionsChanged();
    void solutionChanged();
    void guidanceChanged();
    void solvingChanged(bool solving);
    void solvingProgressed(const Sentence& stage, double done);
    void modifiedChanged(bool modified);
    void opened(const QString& directory);
    void saved(const QString& directory);
    void copied(const QString& directory);
    void fileFailed(const QString& why);

  private:
    class DecideCommand;
    class MeasureCommand;
    class ReplaceCommand;

    void write(const QString& directory, bool isCopy);
    void swap(DecisionChange& change);
    void swap(ScannedView& view);
    void setSaved(std::uint64_t revision);
    void changed(bool onlyGrew);
    void forgetSolution();
    void solveSoon();

    Measured measured_;
    Decisions decisions_;
    QUndoStack undoStack_;
    Solver solver_;
    QThreadPool files_;
    std::shared_ptr<std::atomic<bool>> readingCancelled_;
    std::shared_ptr<const Solution> solution_;
    std::shared_ptr<const Guidance> guidance_;
    Sentence failure_;
    std::uint64_t revision_ = 0;
    std::uint64_t savedRevision_ = 0;
    bool isSolveDue_ = false;
    bool onlyGrew_ = true;
};

}  // namespace skincal
