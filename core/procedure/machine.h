#pragma once

#include <chrono>
#include <vector>

namespace skincal {

/// How every machine of the procedure is written: a state that is a value, events that are values, and a pure function
///   step(State, Event) -> {State, Effects}
/// Effects are what the caller has to do: talk to a device, start a timer. Waiting is an event, too (TimedOut), so that
/// a machine is tested as a table, without a clock. An event that means nothing in a state leaves it as it is, without
/// effects: devices answer late.
template <class State, class Effect>
struct Stepped {
    State state;
    std::vector<Effect> effects{};
};

/// Effect: TimedOut is due after this, instead of what an earlier timer of the same machine was to say.
struct StartTimer {
    std::chrono::milliseconds after{};
    friend bool operator==(const StartTimer&, const StartTimer&) = default;
};

/// Effect: no TimedOut is to come any more.
struct StopTimer {
    friend bool operator==(const StopTimer&, const StopTimer&) = default;
};

/// For std::visit with one lambda per alternative.
template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace skincal
