#include "core/procedure/connection.h"

#include <gtest/gtest.h>

#include <deque>

#include "core/device/protocol/skin.pb.h"
#include "core/device/protocol/skin_client.h"
#include "core/geometry/random.h"
#include "tests/unit/procedure/machine_table.h"

namespace skincal {
namespace {

using namespace connection;
using enum Connection::Phase;
using ConnectionRow = Row<Connection, Event, Effect>;

using Fault = Connection::Fault;

constexpr StartTimer kOpens{std::chrono::milliseconds(20000)};
constexpr StartTimer kWait{std::chrono::milliseconds(35000)};
constexpr std::nullopt_t kNothing = std::nullopt;

Connection stateIn(Connection::Phase phase) {
    switch (phase) {
        case Exploring:
            return {phase, 2};
        case Connected:
            return {phase, 5};
        case Lost:
            return {phase, 0, Fault::Closed};
        default:
            return {phase, 0};
    }
}

TEST(Connection, DoesWhatTheTableSays) {
    const ConnectionRow table[] = {
        {Disconnected, Connect{}, Opening, {OpenDevice{}, kOpens}},
        {Disconnected, Disconnect{}, kNothing, {}},
        {Disconnected, Opened{}, kNothing, {}},
        {Disconnected, Closed{}, kNothing, {}},
        {Disconnected, Failed{}, kNothing, {}},
        {Disconnected, ModuleFound{}, kNothing, {}},
        {Disconnected, Explored{}, kNothing, {}},
        {Disconnected, TimedOut{}, kNothing, {}},

        {Opening, Connect{}, kNothing, {}},
        {Opening, Disconnect{}, Disconnected, {CloseDevice{}, StopTimer{}}},
        {Opening, Opened{}, Exploring, {Explore{}, kWait}},
        {Opening, Closed{}, kNothing, {}},
        {Opening, Failed{}, Lost, {CloseDevice{}, StopTimer{}}},
        {Opening, ModuleFound{}, kNothing, {}},
        {Opening, Explored{}, kNothing, {}},
        {Opening, TimedOut{}, Lost, {CloseDevice{}, StopTimer{}}},

        {Exploring, Connect{}, kNothing, {}},
        {Exploring, Disconnect{}, Disconnected, {CloseDevice{}, StopTimer{}}},
        {Exploring, Opened{}, kNothing, {}},
        {Exploring, Closed{}, Lost, {CloseDevice{}, StopTimer{}}},
        {Exploring, Failed{}, Lost, {CloseDevice{}, StopTimer{}}},
        {Exploring, ModuleFound{}, Exploring, {kWait}},
        {Exploring, Explored{}, Connected, {StopTimer{}}},
        {Exploring, TimedOut{}, Lost, {CloseDevice{}, StopTimer{}}},

        {Connected, Connect{}, Exploring, {Explore{}, kWait}},
        {Connected, Disconnect{}, Disconnected, {CloseDevice{}, StopTimer{}}},
        {Connected, Opened{}, kNothing, {}},
        {Connected, Closed{}, Lost, {CloseDevice{}, StopTimer{}}},
        {Connected, Failed{}, Lost, {CloseDevice{}, StopTimer{}}},
        {Connected, ModuleFound{}, kNothing, {}},
        {Connected, Explored{}, kNothing, {}},
        {Connected, TimedOut{}, kNothing, {}},

        {Lost, Connect{}, Opening, {OpenDevice{}, kOpens}},
        {Lost, Disconnect{}, Disconnected, {}},
        {Lost, Opened{}, kNothing, {}},
        {Lost, Closed{}, kNothing, {}},
        {Lost, Failed{}, kNothing, {}},
        {Lost, ModuleFound{}, kNothing, {}},
        {Lost, Explored{}, kNothing, {}},
        {Lost, TimedOut{}, kNothing, {}},
    };
    static_assert(std::size(table) == pairs<Event>(Lost));
    expectTable<Connection, Event, Effect>(table, stateIn);
}

TEST(Connection, SaysWhyItWasLost) {
    EXPECT_EQ(step(stateIn(Opening), Failed{}).state.fault, Fault::Failed);
    EXPECT_EQ(step(stateIn(Connected), Failed{}).state.fault, Fault::Failed);
    EXPECT_EQ(step(stateIn(Connected), Closed{}).state.fault, Fault::Closed);
    EXPECT_EQ(step(stateIn(Opening), TimedOut{}).state.fault, Fault::NoAnswer);
    EXPECT_EQ(step(Connection{Exploring, 0}, TimedOut{}).state.fault, Fault::NoModules);
    EXPECT_TRUE((step(Connection{Exploring, 3}, TimedOut{}).state == Connection{Lost, 3, Fault::Silent}));
    EXPECT_EQ(step(stateIn(Lost), Connect{}).state.fault, Fault::None);
}

TEST(Connection, ALateClosedDoesNotSpoilTheNextConnection) {
    Connection state = step(stateIn(Connected), Disconnect{}).state;
    for (const Event& event : std::vector<Event>{Connect{}, Closed{}, Opened{}, ModuleFound{}, Explored{}})
        state = step(state, event).state;
    EXPECT_TRUE((state == Connection{Connected, 1}));
}

class FaultListener : public SkinListener {
  public:
    void onOpened(const std::string&) override { isOpen = true; }
    void onFault(SkinFault what) override { fault = what; }
    void onCounted(std::size_t) override {}
    void onCell(const NetworkCell&) override {}
    void onExplored(const SkinNetwork&) override {}
    void onRestarted() override {}
    void onShown(std::uint64_t) override {}
    void onNotShown(std::uint64_t /*token*/, std::span<const CellNumber> /*dark*/) override {}
    void onAcceleration(const RestReading&, Time) override {}
    void onRest(std::span<const RestReading>, std::span<const CellNumber>) override {}
    void onTouch(std::span<const CellTouch>, Time) override {}

    bool isOpen = false;
    std::optional<SkinFault> fault;
};

TEST(Connection, LeavesItToTheDeviceToSayThatItsCellsAreSilent) {
    using namespace std::chrono_literals;
    // A gateway that says hello, and acknowledges whatever else it is asked.
    FaultListener listener;
    SkinClient client(listener, {}, 1);
    ReliableLink gateway({}, 7);
    SkinClient::Time now = 1s;
    std::optional<SkinClient::Time> began;
    client.open(now);
    for (; !listener.fault && now < 120s; now += 1ms) {
        std::vector<std::uint8_t> bytes;
        client.poll(now, bytes);
        gateway.receive(bytes, now, [&](const FrameHeader& header, std::string_view) {
            if (header.type != FrameType::Hello)
                return;
            wire::Hello hello;
            hello.set_oldest_version(FrameHeader::kVersion);
            hello.set_newest_version(FrameHeader::kVersion);
            FrameHeader answer;
            answer.type = FrameType::Hello;
            gateway.send(answer, hello.SerializeAsString());
        });
        bytes.clear();
        gateway.poll(now, bytes);
        client.receive(bytes, now);
        if (listener.isOpen && !began) {
            began = now;
            client.explore(now);
        }
    }
    ASSERT_TRUE(began);
    ASSERT_EQ(listener.fault, SkinFault::Stalled);
    const auto effects = step(stateIn(Opening), Opened{}).effects;
    const auto patience = std::get<StartTimer>(effects.back()).after;
    EXPECT_LT(now - *began, patience) << "nobody would hear what it says";
}

Event randomEvent(Random& random) {
    switch (random.index(10)) {
        case 0:
            return Disconnect{};
        case 1:
            return Closed{};
        case 2:
            return Failed{};
        case 3:
            return Explored{};
        case 4:
            return TimedOut{};
        case 5:
        case 6:
            return Opened{};
        case 7:
            return ModuleFound{};
        default:
            return Connect{};
    }
}

TEST(Connection, HoldsItsPromisesWhateverComes) {
    Random random(1, "connection");
    std::size_t explorations = 0;
    for (int run = 0; run < 2000; ++run) {
        Connection state;
        bool isToldToOpen = false;
        bool isOpen = false;
        bool isTimed = false;
        std::size_t found = 0;
        for (int i = 0; i < 40; ++i) {
            const Event event = randomEvent(random);
            isOpen = (isOpen || (isToldToOpen && std::holds_alternative<Opened>(event))) &&
                     !std::holds_alternative<Closed>(event);
            found += std::holds_alternative<ModuleFound>(event) ? 1 : 0;
            const auto next = step(state, event);
            state = next.state;
            for (const Effect& effect : next.effects) {
                if (std::holds_alternative<OpenDevice>(effect)) {
                    EXPECT_FALSE(isToldToOpen) << "opened twice";
                    isToldToOpen = true;
                } else if (std::holds_alternative<CloseDevice>(effect)) {
                    EXPECT_TRUE(isToldToOpen) << "closed twice";
                    isToldToOpen = isOpen = false;
                } else if (std::holds_alternative<Explore>(effect)) {
                    EXPECT_TRUE(isOpen) << "explores a closed device";
                    found = 0;
                    ++explorations;
                } else {
                    isTimed = std::holds_alternative<StartTimer>(effect);
                }
            }
            const bool waits = state.phase == Opening || state.phase == Exploring;
            EXPECT_EQ(isTimed, waits);
            EXPECT_EQ(isToldToOpen, waits || state.phase == Connected) << "left open, or closed in use";
            EXPECT_EQ(state.fault == Fault::None, state.phase != Lost);
            if (state.phase == Exploring) {
                EXPECT_EQ(state.found, found);
            }
            if (waits) {
                EXPECT_EQ(step(state, TimedOut{}).state.phase, Lost) << "waits for ever";
            }
        }
    }
    EXPECT_GT(explorations, 1000U);
}

/// A device whose reports come late, after the operator has changed their mind several times.
struct LateDevice {
    Random& random;
    bool isOpen = false;
    std::deque<Event> reports{};

    void open() {
        isOpen = random.uniform() < 0.8;
        if (isOpen)
            reports.emplace_back(Opened{});
        else if (random.uniform() < 0.5)
            reports.emplace_back(Failed{});
    }
    void close() {
        if (isOpen)
            reports.emplace_back(Closed{});
        isOpen = false;
    }
    void explore() {
        if (!isOpen)
            return;
        for (std::size_t n = random.index(4); n > 0; --n)
            reports.emplace_back(ModuleFound{});
        if (random.uniform() < 0.8)
            reports.emplace_back(Explored{});
    }
};

TEST(Connection, AgreesWithADeviceThatReportsLate) {
    Random random(2, "late");
    std::array<int, 5> ends{};
    for (int run = 0; run < 5000; ++run) {
        LateDevice device{random};
        Connection state;
        bool isTimed = false;
        const auto send = [&](const Event& event) {
            const auto next = step(state, event);
            state = next.state;
            for (const Effect& effect : next.effects) {
                if (std::holds_alternative<OpenDevice>(effect))
                    device.open();
                else if (std::holds_alternative<CloseDevice>(effect))
                    device.close();
                else if (std::holds_alternative<Explore>(effect))
                    device.explore();
                else
                    isTimed = std::holds_alternative<StartTimer>(effect);
            }
        };
        const auto deliver = [&] {
            const Event event = device.reports.front();
            device.reports.pop_front();
            send(event);
        };
        for (int i = 0; i < 30; ++i) {
            const double what = random.uniform();
            if (what < 0.2)
                send(Connect{});
            else if (what < 0.3)
                send(Disconnect{});
            else if (what < 0.35)
                device.close();  // the cable was pulled
            else if (!device.reports.empty())
                deliver();
        }
        // Left alone, it comes to an end that is the truth.
        for (int i = 0; i < 100 && (isTimed || !device.reports.empty()); ++i) {
            if (!device.reports.empty()) {
                deliver();
            } else {
                isTimed = false;
                send(TimedOut{});
            }
        }
        EXPECT_FALSE(isTimed);
        EXPECT_TRUE(device.reports.empty());
        EXPECT_EQ(device.isOpen, state.phase == Connected);
        EXPECT_TRUE(state.phase == Connected || state.phase == Disconnected || state.phase == Lost);
        ++ends.at(static_cast<std::size_t>(state.phase));
    }
    for (const auto end : {Connected, Disconnected, Lost})
        EXPECT_GT(ends.at(static_cast<std::size_t>(end)), 200);
}

}  // namespace
}  // namespace skincal
