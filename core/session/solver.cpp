#include "core/session/solver.h"

#include <QPointer>
#include <QtConcurrent/QtConcurrentRun>
#include <chrono>

namespace skincal {
namespace {

constexpr std::chrono::milliseconds kBetweenReports{100};

/// Reports of the worker's reach the solver's thread, not more than ten a second.
RunContext contextOf(QPointer<Solver> solver, std::shared_ptr<std::atomic<bool>> cancelled) {
    RunContext context;
    context.isCancelled = [cancelled] { return cancelled->load(); };
    auto last = std::make_shared<std::chrono::steady_clock::time_point>();
    context.report = [solver, last](const Sentence& stage, double done) {
        const auto now = std::chrono::steady_clock::now();
        if (now - *last < kBetweenReports)
            return;
        *last = now;
        QMetaObject::invokeMethod(
            solver,
            [solver, stage, done] {
                if (solver)
                    emit solver->progressed(stage, done);
            },
            Qt::QueuedConnection);
    };
    return context;
}

}  // namespace

Solver::Solver(QObject* parent) : QObject(parent), cancelled_(std::make_shared<std::atomic<bool>>(false)) {
    pool_.setMaxThreadCount(1);
}

Solver::~Solver() {
    *cancelled_ = true;
    pool_.waitForDone();
}

void Solver::request(std::shared_ptr<const Measurements> measurements, std::uint64_t revision, bool mayUpdate) {
    // Of several requests that wait only the newest counts; it may be an update if all since the last solution were.
    grewSinceLast_ = grewSinceLast_ && mayUpdate;
    next_ = Request{std::move(measurements), revision, grewSinceLast_};
    if (isBusy_) {
        *cancelled_ = true;
        return;
    }
    isBusy_ = true;
    emit busyChanged(true);
    startNext();
}

void Solver::reset() {
    next_.reset();
    last_.reset();
    *cancelled_ = true;
    ++run_;  // what still comes is of an older run
}

void Solver::startNext() {
    const Request request = *std::exchange(next_, std::nullopt);
    cancelled_ = std::make_shared<std::atomic<bool>>(false);
    const std::uint64_t run = ++run_;
    const bool isSlow = last_ && last_->seconds > quick_s_;
    auto start = request.mayUpdate && isSlow ? last_ : nullptr;
    auto work = [self = QPointer<Solver>(this), context = contextOf(this, cancelled_), request, run,
                 start = std::move(start)] {
        const auto deliver = [&](auto function) { QMetaObject::invokeMethod(self, function, Qt::QueuedConnection); };
        const auto complain = [&](const Sentence& why) {
            deliver([self, run, why, revision = request.revision] {
                if (self && self->run_ == run)
                    emit self->failed(why, revision);
            });
        };
        // What no check has foreseen must not be lost on a thread that nobody listens to.
        try {
            auto solution = solve(request.measurements, request.revision, start.get(), context);
            if (!solution && solution.error().code != ErrorCode::Cancelled)
                complain(solution.error().sentence());
            if (solution) {
                deliver([self, run, snapshot = *solution] {
                    if (!self || self->run_ != run)
                        return;
                    self->last_ = snapshot;
                    // Unless somebody already asked for more, all of which was counted since the solution before.
                    if (!self->next_)
                        self->grewSinceLast_ = true;
                    emit self->solved(snapshot);
                });
                auto guidance = std::make_shared<const Guidance>(guidanceFor(**solution, context));
                deliver([self, run, guidance, isCancelled = context.isCancelled()] {
                    if (self && self->run_ == run && !isCancelled)
                        emit self->guided(guidance);
                });
            }
        } catch (const std::exception& error) {
            complain(Sentence::saying("internal error: {}", error.what()));
        }
        deliver([self] {
            if (self)
                self->finish();
        });
    };
    [[maybe_unused]] const auto future = QtConcurrent::run(&pool_, std::move(work));
}

void Solver::finish() {
    if (next_) {
        startNext();
        return;
    }
    isBusy_ = false;
    emit busyChanged(false);
}

}  // namespace skincal
