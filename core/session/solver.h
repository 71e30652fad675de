#pragma once

#include <QObject>
#include <QThreadPool>
#include <atomic>
#include <memory>

#include "core/geometry/sentence.h"
#include "core/session/solution.h"

namespace skincal {

/// Solves on a thread of its own, newest request first: one that comes while another is computed cancels that. What
/// comes out is a snapshot, handed over by a signal on the thread that the solver lives on.
class Solver : public QObject {
    Q_OBJECT
  public:
    explicit Solver(QObject* parent = nullptr);
    /// Cancels, and waits until the thread has let go: some tenths of a second.
    ~Solver() override;

    /// @param mayUpdate  whether the measurements only grew since the last solution was asked for.
    void request(std::shared_ptr<const Measurements> measurements, std::uint64_t revision, bool mayUpdate);
    /// A body that took longer than this is updated rather than solved anew, where it may be: in a solution from the
    /// data alone, what was taken out before gets its chance again. 1.5 s at first.
    void setQuick(double seconds) { quick_s_ = seconds; }
    /// Nothing is computed any more, and what was is forgotten.
    void reset();
    [[nodiscard]] bool isBusy() const { return isBusy_; }

  signals:
    void busyChanged(bool busy);
    void progressed(const Sentence& stage, double done);
    void solved(std::shared_ptr<const skincal::Solution> solution);
    void guided(std::shared_ptr<const skincal::Guidance> guidance);
    void failed(const Sentence& why, std::uint64_t revision);

  private:
    struct Request {
        std::shared_ptr<const Measurements> measurements;
        std::uint64_t revision = 0;
        bool mayUpdate = false;
    };

    void startNext();
    void finish();

    QThreadPool pool_;
    std::shared_ptr<std::atomic<bool>> cancelled_;
    std::optional<Request> next_;
    std::shared_ptr<const Solution> last_;
    bool grewSinceLast_ = true;
    double quick_s_ = 1.5;
    std::uint64_t run_ = 0;
    bool isBusy_ = false;
};

}  // namespace skincal
