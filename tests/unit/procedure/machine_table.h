#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <span>
#include <utility>
#include <variant>
#include <vector>

namespace skincal {

/// What one event does in one phase.
template <class Machine, class Event, class Effect>
struct Row {
    typename Machine::Phase from{};
    Event event;
    std::optional<typename Machine::Phase> to{};  ///< nothing: the event means nothing there
    std::vector<Effect> effects{};
};

/// How many rows a table needs that has each pair of phase and event once.
template <class Event, class Phase>
constexpr std::size_t pairs(Phase last) {
    return (static_cast<std::size_t>(last) + 1) * std::variant_size_v<Event>;
}

/// Every pair once, and each does what its row says. An event that means nothing leaves all of the state alone.
/// @param stateIn  a state in a phase, with its other members as they are in the middle of things.
template <class Machine, class Event, class Effect, class StateIn>
void expectTable(std::span<const Row<Machine, Event, Effect>> table, StateIn stateIn) {
    std::set<std::pair<typename Machine::Phase, std::size_t>> seen;
    for (const auto& row : table) {
        const Machine before = stateIn(row.from);
        ASSERT_EQ(before.phase, row.from);
        EXPECT_TRUE(seen.emplace(row.from, row.event.index()).second) << "twice in the table";
        const auto after = step(before, row.event);
        const auto where = testing::Message()
                           << "phase " << static_cast<int>(row.from) << ", event " << row.event.index();
        EXPECT_EQ(after.state.phase, row.to.value_or(row.from)) << where;
        EXPECT_TRUE(after.effects == row.effects) << where;
        if (!row.to) {
            EXPECT_TRUE(after.state == before) << where;
        }
    }
}

/// Whether a list of effects has one of this kind.
template <class Wanted, class Effect>
bool has(const std::vector<Effect>& effects) {
    for (const Effect& effect : effects) {
        if (std::holds_alternative<Wanted>(effect))
            return true;
    }
    return false;
}

}  // namespace skincal
