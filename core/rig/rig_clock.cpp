#include "core/rig/rig_clock.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace skincal {
namespace {

using Steady = std::chrono::steady_clock;
using Microseconds = std::chrono::duration<double, std::micro>;

}  // namespace

RigClock::RigClock(QObject* parent)
    : QObject(parent),
      base_(std::chrono::duration_cast<Time>(Steady::now().time_since_epoch())),
      wallBase_(Steady::now()) {
    timer_.setSingleShot(true);
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this, &RigClock::callNext);
}

RigClock::Time RigClock::now() const {
    if (speed_ == 0)
        return base_;
    const Microseconds passed = Steady::now() - wallBase_;
    return base_ + Time(std::llround(speed_ * passed.count()));
}

void RigClock::setSpeed(double speed) {
    if (!std::isfinite(speed) || speed < 0)
        throw std::logic_error("RigClock: speed is negative or not a number");
    base_ = now();
    wallBase_ = Steady::now();
    speed_ = speed;
    wake();
}

void RigClock::at(Time when, const QObject* context, std::function<void()> what) {
    calls_.emplace(std::pair(when, asked_++), Call{context, std::move(what)});
    wake();
}

void RigClock::hold() {
    ++holds_;
    wake();
}

void RigClock::release() {
    if (holds_ == 0)
        throw std::logic_error("RigClock: released more often than held");
    --holds_;
    wake();
}

void RigClock::wake() {
    timer_.stop();
    if (calls_.empty() || (speed_ == 0 && holds_ > 0))
        return;
    if (speed_ == 0) {
        timer_.start(0);
        return;
    }
    const auto wait = static_cast<double>((calls_.begin()->first.first - now()).count()) / 1000 / speed_;
    constexpr double kDay_ms = 86.4e6;
    timer_.start(static_cast<int>(std::clamp(std::ceil(wait), 0.0, kDay_ms)));
}

void RigClock::callNext() {
    if (calls_.empty() || (speed_ != 0 && calls_.begin()->first.first > now())) {
        wake();
        return;
    }
    const auto next = calls_.begin();
    if (speed_ == 0)
        base_ = std::max(base_, next->first.first);
    const Call call = std::move(next->second);
    calls_.erase(next);
    // First, as the call may run an event loop of its own, or destroy this.
    wake();
    if (call.context)
        call.what();
}

}  // namespace skincal
