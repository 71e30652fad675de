#include "core/procedure/connection.h"

namespace skincal {
namespace {

using namespace connection;
using Phase = Connection::Phase;
using Fault = Connection::Fault;
using Result = Stepped<Connection, Effect>;

/// Devices give up sooner, with a reason of their own.
constexpr std::chrono::milliseconds kOpens{20000};
/// Between two signs of life of a network that is explored. Longer than the protocol's client takes to give up (three
/// times ten seconds until cells are counted, and some more until one describes itself): it knows better what is wrong
/// than that nothing came, and its sentence would never be heard.
constexpr std::chrono::milliseconds kAnswers{35000};

/// Closed in any case: a report may be of an earlier time, and closing what is closed does nothing.
Result lost(Fault fault, std::size_t found = 0) {
    return {{Phase::Lost, found, fault}, {CloseDevice{}, StopTimer{}}};
}

struct Stepper {
    const Connection& state;

    [[nodiscard]] bool in(Phase phase) const { return state.phase == phase; }
    [[nodiscard]] bool isOpen() const { return in(Phase::Exploring) || in(Phase::Connected); }
    [[nodiscard]] Result explore() const {
        return {{Phase::Exploring, 0, Fault::None}, {Explore{}, StartTimer{kAnswers}}};
    }

    Result operator()(const Connect&) const {
        if (in(Phase::Connected))
            return explore();
        if (in(Phase::Opening) || in(Phase::Exploring))
            return {state};
        return {{Phase::Opening, 0, Fault::None}, {OpenDevice{}, StartTimer{kOpens}}};
    }
    Result operator()(const Disconnect&) const {
        if (in(Phase::Disconnected) || in(Phase::Lost))
            return {{Phase::Disconnected}};
        return {{Phase::Disconnected, 0, Fault::None}, {CloseDevice{}, StopTimer{}}};
    }
    Result operator()(const Opened&) const {
        if (!in(Phase::Opening))
            return {state};
        return explore();
    }
    Result operator()(const Closed&) const {
        // In Opening it is the late echo of an earlier CloseDevice: what is to open has not been open.
        return isOpen() ? lost(Fault::Closed) : Result{state};
    }
    Result operator()(const Failed&) const {
        if (in(Phase::Opening) || isOpen())
            return lost(Fault::Failed);
        return {state};
    }
    Result operator()(const ModuleFound&) const {
        if (!in(Phase::Exploring))
            return {state};
        return {{Phase::Exploring, state.found + 1, Fault::None}, {StartTimer{kAnswers}}};
    }
    Result operator()(const Explored&) const {
        if (!in(Phase::Exploring))
            return {state};
        return {{Phase::Connected, state.found, Fault::None}, {StopTimer{}}};
    }
    Result operator()(const TimedOut&) const {
        if (in(Phase::Opening))
            return lost(Fault::NoAnswer);
        if (in(Phase::Exploring))
            return lost(state.found == 0 ? Fault::NoModules : Fault::Silent, state.found);
        return {state};
    }
};

}  // namespace

Stepped<Connection, connection::Effect> step(const Connection& state, const connection::Event& event) {
    return std::visit(Stepper{state}, event);
}

}  // namespace skincal
