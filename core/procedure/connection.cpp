#include "core/procedure/connection.h"

namespace skincal {
namespace {

using namespace connection;
using Phase = Connection::Phase;
using Result = Stepped<Connection, Effect>;

constexpr std::chrono::milliseconds kOpens{3000};
/// Between two signs of life of a network that is explored.
constexpr std::chrono::milliseconds kAnswers{3000};

/// Closed in any case: a report may be of an earlier time, and closing what is closed does nothing.
Result lost(std::string why) {
    return {{Phase::Lost, 0, std::move(why)}, {CloseDevice{}, StopTimer{}}};
}

struct Stepper {
    const Connection& state;

    [[nodiscard]] bool in(Phase phase) const { return state.phase == phase; }
    [[nodiscard]] bool isOpen() const { return in(Phase::Exploring) || in(Phase::Connected); }
    [[nodiscard]] Result explore() const { return {{Phase::Exploring, 0, {}}, {Explore{}, StartTimer{kAnswers}}}; }

    Result operator()(const Connect&) const {
        if (in(Phase::Connected))
            return explore();
        if (in(Phase::Opening) || in(Phase::Exploring))
            return {state};
        return {{Phase::Opening, 0, {}}, {OpenDevice{}, StartTimer{kOpens}}};
    }
    Result operator()(const Disconnect&) const {
        if (in(Phase::Disconnected) || in(Phase::Lost))
            return {{Phase::Disconnected, 0, {}}};
        return {{Phase::Disconnected, 0, {}}, {CloseDevice{}, StopTimer{}}};
    }
    Result operator()(const Opened&) const {
        if (!in(Phase::Opening))
            return {state};
        return explore();
    }
    Result operator()(const Closed&) const {
        // In Opening it is the late echo of an earlier CloseDevice: what is to open has not been open.
        return isOpen() ? lost("the skin was disconnected") : Result{state};
    }
    Result operator()(const Failed& failed) const {
        if (in(Phase::Opening) || isOpen())
            return lost(failed.why);
        return {state};
    }
    Result operator()(const ModuleFound&) const {
        if (!in(Phase::Exploring))
            return {state};
        return {{Phase::Exploring, state.found + 1, {}}, {StartTimer{kAnswers}}};
    }
    Result operator()(const Explored&) const {
        if (!in(Phase::Exploring))
            return {state};
        return {{Phase::Connected, state.found, {}}, {StopTimer{}}};
    }
    Result operator()(const TimedOut&) const {
        if (in(Phase::Opening))
            return lost("the skin does not answer: is it powered, and is this its port?");
        if (in(Phase::Exploring))
            return lost(state.found == 0 ? "the skin is open, but no module reports"
                                         : "the network went silent while it was explored");
        return {state};
    }
};

}  // namespace

Stepped<Connection, connection::Effect> step(const Connection& state, const connection::Event& event) {
    return std::visit(Stepper{state}, event);
}

}  // namespace skincal
