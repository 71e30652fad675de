#pragma once

#include <QObject>
#include <QPointer>
#include <QTimer>
#include <chrono>
#include <cstdint>
#include <functional>
#include <map>

namespace skincal {

/// The time of a simulated rig, and what is to happen when. One call per turn of the event loop, in the order of time,
/// calls of the same time in the order in which they were asked for; never from inside at(). For one thread.
///
/// Time starts at std::chrono::steady_clock's and goes on `speed` times as fast. At speed 0 it knows no wall clock: it
/// stands still while nothing is asked for, and jumps to whatever comes next as soon as the event loop is idle. What
/// happens at which simulated time is then the same in every run.
class RigClock : public QObject {
    Q_OBJECT
  public:
    using Time = std::chrono::microseconds;

    explicit RigClock(QObject* parent = nullptr);

    /// Simulated time.
    [[nodiscard]] Time now() const;
    [[nodiscard]] double speed() const { return speed_; }
    /// 1 is real time, 0 as fast as events go. Throws std::logic_error where it is negative or not a number.
    void setSpeed(double speed);

    /// Calls `what` once it is `when`, as soon as possible where that has passed; not where `context` has died by then.
    /// `what` may do anything, even destroy the clock.
    void at(Time when, const QObject* context, std::function<void()> what);

    /// At speed 0, nothing happens between hold() and as many release(): somebody is at work whose result belongs to
    /// the present. At any other speed time doesn't wait.
    void hold();
    void release();

  private:
    struct Call {
        QPointer<const QObject> context;
        std::function<void()> what;
    };

    void wake();
    void callNext();

    double speed_ = 1;
    Time base_;  ///< simulated time at wallBase_
    std::chrono::steady_clock::time_point wallBase_;
    std::map<std::pair<Time, std::uint64_t>, Call> calls_;
    std::uint64_t asked_ = 0;
    int holds_ = 0;
    QTimer timer_;
};

}  // namespace skincal
