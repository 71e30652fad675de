#include "core/procedure/connection.h"

namespace skincal {
namespace {

using namespace connection;
using Phase = Connection::Phase;
using Result = Stepped<Connection, Effect>;

constexpr std::chrono::milliseconds kOpens{3000};
/// Between two signs of life of a network that is explored.
constexpr std::chrono::milliseconds kAnswers{3000};

Result lost(std::string why, bool isOpen) {
    Result result{{Phase::Lost, 0, std::move(why)}, {StopTimer{}}};
    if (isOpen)
        result.effects.emplace_back(CloseDevice{});
    return result;
}

struct Stepper {
    const Connection& state;

    [[nodiscard]] bool in(Phase phase) const { return state.phase == phase; }
    [[nodiscard]] bool isOpen() const { return in(Phase::Exploring) || in(Phase::Connected); }

    Result operator()(const Connect&) const {
        if (in(Phase::Connected))
            return {{Phase::Exploring, 0, {}}, {Explore{}, StartTimer{kAnswers}}};
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
        return {{Phase::Exploring, 0, {}}, {Explore{}, StartTimer{kAnswers}}};
    }
    Result operator()(const Closed&) const {
        if (in(Phase::Opening) || isOpen())
            return lost("the skin was disconnected", false);
        return {state};
    }
    Result operator()(const Failed& failed) const {
        if (in(Phase::Opening) || isOpen())
            return lost(failed.why, isOpen());
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
            return lost("the skin does not answer: is it powered, and is this its port?", true);
        if (in(Phase::Exploring))
            return lost(state.found == 0 ? "the skin is open, but no module reports"
                                         : "the network went silent while it was explored",
                        true);
        return {state};
    }
};

}  // namespace

Stepped<Connection, connection::Effect> step(const Connection& state, const connection::Event& event) {
    return std::visit(Stepper{state}, event);
}

}  // namespace skincal
