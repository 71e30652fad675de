#pragma once

#include <QFutureWatcher>
#include <QObject>
#include <QThreadPool>
#include <atomic>
#include <filesystem>

#include "core/mesh/mesh_comparison.h"
#include "ui/presenters/workbench.h"

namespace skincal {

/// Compares the newest body with a mesh of the body it is mounted on. A mesh stays until it is removed; it is compared
/// anew whenever the body, the unit or the offset changes, on a thread of its own, and only while somebody looks.
class MeshPresenter : public QObject {
    Q_OBJECT
  public:
    explicit MeshPresenter(Workbench& workbench, QObject* parent = nullptr);
    /// Cancels, and waits until the thread has let go.
    ~MeshPresenter() override;

    /// Reads an STL file, and compares. What was there before is forgotten.
    void open(const QString& file);
    /// The simulated body's own surface; nothing without hands.
    void useSimulatedBody();
    [[nodiscard]] bool hasSimulatedBody() const;
    void remove();
    /// The unit of the file's numbers; nothing chooses what fits the size of the body.
    void setUnit(std::optional<MeshUnit> unit);
    [[nodiscard]] std::optional<MeshUnit> unit() const { return unit_; }
    /// Whether modules may all lie above the surface by the same.
    void setOffsetFitted(bool fitted);
    [[nodiscard]] bool isOffsetFitted() const { return isOffsetFitted_; }
    /// Not being looked at, nothing is compared for a first time: what runs is cancelled, and done once it is looked at
    /// again. A comparison that is there, which the 3D view shows, follows the body whatever is looked at. A file is
    /// read to its end, once.
    void setActive(bool active);

    [[nodiscard]] bool hasMesh() const { return !name_.isEmpty(); }
    /// The file without its folders.
    [[nodiscard]] const QString& name() const { return name_; }
    [[nodiscard]] bool isBusy() const { return watcher_.isRunning(); }
    /// Whether a newer body is being compared than that of comparison().
    [[nodiscard]] bool isStale() const { return comparison_ && (isDue_ || isBusy()); }
    /// Null before the first is there, without a body, and where there is a complaint.
    [[nodiscard]] const std::shared_ptr<const MeshComparison>& comparison() const { return comparison_; }
    /// In metres; null before it was read.
    [[nodiscard]] const std::shared_ptr<const TriangleMesh>& mesh() const { return mesh_; }
    /// The unit that it was taken to be in.
    [[nodiscard]] MeshUnit usedUnit() const { return usedUnit_; }
    /// A sentence: why there is no comparison. Empty where there is, or none was asked for.
    [[nodiscard]] const QString& complaint() const { return complaint_; }

    /// A sentence on what to doubt, with its numbers.
    [[nodiscard]] static QString sentenceOf(const AlignmentDoubt& doubt);
    /// A sentence on why there is no comparison; none where it was cancelled.
    [[nodiscard]] static QString sentenceOf(const CalibrationError& error);

  signals:
    void changed();

  private:
    using Flag = std::shared_ptr<std::atomic<bool>>;
    struct Request {
        std::uint64_t run = 0;
        std::filesystem::path file;
        std::shared_ptr<const TriangleMesh> raw;
        std::vector<PlacedModule> modules;
        std::optional<MeshUnit> unit;
        bool isOffsetFitted = true;
        Flag cancelled;
        Flag forgotten;
    };
    struct Outcome {
        std::uint64_t run = 0;
        Flag forgotten;
        std::shared_ptr<const TriangleMesh> raw;
        std::shared_ptr<const TriangleMesh> mesh;
        MeshUnit unit = MeshUnit::Metre;
        std::shared_ptr<const MeshComparison> comparison;
        QString complaint;
    };

    void begin(const QString& name);
    /// @param meanwhile  what is shown until the new one is there
    void compareSoon(std::shared_ptr<const MeshComparison> meanwhile = nullptr);
    /// Somebody looks at it: on its page, or in 3D, where a comparison is shown whatever the page.
    [[nodiscard]] bool isWanted() const { return isActive_ || comparison_; }
    void start();
    void finish();
    /// On the thread.
    [[nodiscard]] static Outcome compare(const Request& request);
    [[nodiscard]] std::vector<PlacedModule> placedModules() const;

    Workbench& workbench_;
    QThreadPool pool_;
    QFutureWatcher<Outcome> watcher_;
    Flag cancelled_;         ///< what is being compared
    Flag forgotten_;         ///< this mesh, which is not even to be read any more
    std::uint64_t run_ = 0;  ///< what comes of an older one is dropped
    QString name_;
    std::filesystem::path file_;
    std::shared_ptr<const TriangleMesh> raw_;  ///< in the file's unit; null while it has to be read
    std::shared_ptr<const TriangleMesh> mesh_;
    std::shared_ptr<const MeshComparison> comparison_;
    std::optional<MeshUnit> unit_;
    MeshUnit usedUnit_ = MeshUnit::Metre;
    QString complaint_;
    bool isOffsetFitted_ = true;
    bool isActive_ = false;
    bool isDue_ = false;
};

}  // namespace skincal
