#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "core/simulation/world.h"
#include "tests/unit/protocol/virtual_line.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

/// Links as pairs of (place in Skin::modules, port), lower end first.
using Ends = std::set<std::array<int, 4>>;

Ends linksOf(const Skin& skin) {
    const auto index = skin.indexById();
    Ends ends;
    for (const Link& link : skin.links) {
        std::array<int, 4> end{static_cast<int>(index.at(link.a)), link.a_port, static_cast<int>(index.at(link.b)),
                               link.b_port};
        if (end[0] > end[2])
            end = {end[2], end[3], end[0], end[1]};
        ends.insert(end);
    }
    return ends;
}

/// The same, of what cells said of themselves; fails where they contradict each other or a cell isn't known.
Ends linksOf(const SkinNetwork& network, const VirtualNetwork& truth) {
    std::map<std::string, int> places;
    for (std::size_t i = 0; i < truth.cells(); ++i)
        places[truth.uniqueId(i)] = static_cast<int>(i);
    std::map<CellNumber, int> byNumber;
    for (const NetworkCell& cell : network.cells) {
        EXPECT_TRUE(places.contains(cell.uniqueId)) << cell.uniqueId;
        EXPECT_TRUE(byNumber.emplace(cell.number, places[cell.uniqueId]).second) << "twice: " << cell.number;
    }
    Ends ends;
    for (const NetworkCell& cell : network.cells)
        for (const NetworkCell::Heard& heard : cell.heard) {
            if (heard.cell == 0 || !byNumber.contains(heard.cell))
                continue;
            std::array<int, 4> end{byNumber[cell.number], heard.port, byNumber[heard.cell], heard.port_there};
            if (end[0] > end[2])
                end = {end[2], end[3], end[0], end[1]};
            ends.insert(end);
        }
    return ends;
}

Skin arm() {
    return buildWorld(*findScenario("arm"), 1).skin;
}

TEST(Explore, FindsEveryCellAndLinkOfAnyBody) {
    for (const Scenario& scenario : builtInScenarios()) {
        const Skin skin = buildWorld(scenario, 2).skin;
        if (scenario.patches.size() > 1 && !scenario.cables)
            continue;  // patches that nothing joins can't all hang on one line
        VirtualLine line(skin, placeForComputer(skin).value(), {}, 5);
        ASSERT_TRUE(line.connect()) << scenario.name;
        EXPECT_EQ(line.notes.opened, "virtual cell");
        EXPECT_EQ(line.notes.counted, skin.modules.size()) << scenario.name;
        EXPECT_EQ(line.notes.found, skin.modules.size());
        EXPECT_TRUE(line.notes.network->missing.empty());
        EXPECT_TRUE(contradicted(*line.notes.network).empty());
        EXPECT_EQ(linksOf(*line.notes.network, line.network), linksOf(skin)) << scenario.name;
        std::map<std::string, std::size_t> places;
        for (std::size_t i = 0; i < line.network.cells(); ++i)
            places[line.network.uniqueId(i)] = i;
        for (const NetworkCell& cell : line.notes.network->cells)
            EXPECT_EQ(cell.type, skin.templateOf(places[cell.uniqueId]).name);
    }
}

TEST(Explore, OnBadWiresNothingIsEverWrong) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        WireFaults faults;
        faults.byteErrors = seed % 2 == 0 ? 1e-3 : 5e-3;
        faults.lostFrames = seed % 3 == 0 ? 0.02 : 0;
        const Skin skin = gridSkin(8, 5 + seed % 4);
        VirtualLine line(skin, skin.hostLinks.front(), faults, seed);
        ASSERT_TRUE(line.connect()) << seed;
        const SkinNetwork& network = *line.notes.network;
        EXPECT_EQ(network.cells.size() + network.missing.size(), skin.modules.size()) << seed;
        EXPECT_TRUE(network.missing.empty()) << seed;
        const Ends found = linksOf(network, line.network);
        for (const auto& end : linksOf(skin))
            EXPECT_TRUE(found.contains(end)) << seed << ": " << end[0] << "." << end[1] << " to " << end[2];
        EXPECT_EQ(found.size(), skin.links.size()) << seed;
    }
}

TEST(Explore, GoesAroundDeadCellsAndCutWires) {
    std::mt19937 random(7);
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const Skin skin = gridSkin(7, 7);
        VirtualLine line(skin, skin.hostLinks.front(), {}, seed);
        std::set<int> dead;
        while (dead.size() < 4)
            dead.insert(1 + static_cast<int>(random() % 48));
        for (const int cell : dead)
            line.network.kill(static_cast<std::size_t>(cell));
        ASSERT_TRUE(line.connect());
        // Those that the dead cut off are not reachable; all others are.
        std::set<int> reachable{0};
        const Ends all = linksOf(skin);
        for (std::size_t before = 0; before != reachable.size();) {
            before = reachable.size();
            for (const auto& end : all)
                if (!dead.contains(end[0]) && !dead.contains(end[2]) &&
                    (reachable.contains(end[0]) || reachable.contains(end[2])))
                    reachable.insert({end[0], end[2]});
        }
        Ends expected;
        for (const auto& end : all)
            if (reachable.contains(end[0]) && reachable.contains(end[2]))
                expected.insert(end);
        EXPECT_EQ(line.notes.counted, reachable.size());
        EXPECT_EQ(linksOf(*line.notes.network, line.network), expected) << seed;
    }
}

TEST(Explore, CellsThatComeBackAreNoticedAndFoundAgain) {
    const Skin skin = arm();
    VirtualLine line(skin, placeForComputer(skin).value(), {}, 3);
    ASSERT_TRUE(line.connect());
    for (std::size_t cell = 0; cell < 40; cell += 2) {
        line.notes.restarts = 0;
        line.network.restart(cell);
        ASSERT_TRUE(line.runUntil([&] { return line.notes.restarts > 0; }, 1s)) << cell;
        ASSERT_TRUE(line.explore()) << cell << " at " << line.network.now().count() << " us, fault "
                                    << static_cast<int>(line.notes.fault.value_or(SkinFault{-1}));
        ASSERT_EQ(linksOf(*line.notes.network, line.network), linksOf(skin)) << cell;
    }
}

TEST(Explore, NumbersAreVoidWhereTheFirstCellBootsMeanwhile) {
    const Skin skin = gridSkin(5, 5);
    VirtualLine line(skin, skin.hostLinks.front(), {}, 3);
    line.client.open(line.network.now());
    ASSERT_TRUE(line.runUntil([&] { return line.notes.opened.has_value(); }, 2s));
    line.client.explore(line.network.now());
    ASSERT_TRUE(line.runUntil([&] { return line.notes.found > 0; }, 10s));
    line.network.restart(0);
    line.runFor(20s);
    EXPECT_GT(line.notes.restarts, 0);
    EXPECT_FALSE(line.notes.network) << "an exploration has ended that nobody could answer";
    EXPECT_EQ(line.client.cells(), 0U);
    EXPECT_TRUE(line.explore());
}

TEST(Explore, MayBeAskedForAgainAndAgain) {
    const Skin skin = gridSkin(5, 5);
    VirtualLine line(skin, skin.hostLinks.front(), {}, 3);
    ASSERT_TRUE(line.connect());
    for (int again = 0; again < 300; ++again) {  // epochs wrap at 255
        ASSERT_TRUE(line.explore(10s)) << again;
        ASSERT_EQ(line.notes.network->cells.size(), 25) << again;
    }
}

/// How many cells a computer finds that has never spoken to this network before; 0 where it finds none.
std::size_t foundByAnother(VirtualNetwork& network, std::uint32_t seed) {
    Notes notes;
    SkinClient client(notes, VirtualLine::linkOptions({}), seed);
    client.open(network.now());
    bool asked = false;
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < 100'000 && !notes.network && !notes.fault; ++i) {
        if (notes.opened && !std::exchange(asked, true))
            client.explore(network.now());
        bytes.clear();
        client.poll(network.now(), bytes);
        network.fromComputer(bytes);
        network.run(network.now() + 100us);
        client.receive(network.takeForComputer(), network.now());
    }
    return notes.network ? notes.network->cells.size() : 0;
}

TEST(Explore, EveryComputerIsHeardWhateverWasBefore) {
    const Skin skin = gridSkin(5, 4);
    Desk desk;
    VirtualNetwork network(skin, skin.hostLinks.front(), {}, 1, desk);
    for (std::uint32_t seed = 0; seed < 12; ++seed)
        EXPECT_EQ(foundByAnother(network, seed * 7919), 20) << seed;
}

// What a computer knows is what the first cell tells it; and that is nothing where it has restarted since.
TEST(Explore, ANewComputerFindsAllWhoeverHasRestartedSince) {
    const Skin skin = gridSkin(5, 4);
    std::mt19937 random(11);
    Desk desk;
    VirtualNetwork network(skin, skin.hostLinks.front(), {}, 1, desk);
    for (std::uint32_t round = 0; round < 200; ++round) {
        ASSERT_EQ(foundByAnother(network, round), 20) << round;
        network.restart(0);
        for (std::size_t others = random() % 4; others > 0; --others)
            network.restart(random() % 20);
        network.run(network.now() + 200ms);
    }
}

TEST(Explore, ABoardThatTakesItsTimeToStartIsWaitedFor) {
    const Skin skin = gridSkin(3, 2);
    for (const auto boots : {500ms, 2200ms, 4000ms}) {
        VirtualLine line(skin, skin.hostLinks.front(), {}, 4);
        line.network.kill(0);
        line.client.open(line.network.now(), 5s);
        line.runFor(boots);
        ASSERT_FALSE(line.notes.opened);
        line.network.restart(0);
        EXPECT_TRUE(line.runUntil([&] { return line.notes.opened.has_value(); }, 300ms)) << boots.count();
        EXPECT_TRUE(line.explore());
    }
}

TEST(Explore, NobodyThereIsSaid) {
    const Skin skin = gridSkin(1, 1);
    VirtualLine line(skin, skin.hostLinks.front(), {}, 1);
    line.network.kill(0);
    EXPECT_FALSE(line.connect());
    EXPECT_EQ(line.notes.fault, SkinFault::NoAnswer);
}

TEST(Explore, ASkinThatFallsSilentIsNoticedWithinASecond) {
    const Skin skin = gridSkin(4, 4);
    VirtualLine line(skin, skin.hostLinks.front(), {}, 1);
    ASSERT_TRUE(line.connect());
    line.runFor(20s);
    EXPECT_FALSE(line.notes.fault) << "it is there, though nobody asks it anything";
    line.network.cut(0, skin.hostLinks.front().port);
    EXPECT_TRUE(line.runUntil([&] { return line.notes.fault.has_value(); }, 1s));
    EXPECT_EQ(line.notes.fault, SkinFault::Silenced);
}

TEST(Explore, AnotherDeviceOrSpeedIsSaid) {
    Notes notes;
    SkinClient client(notes, {}, 1);
    client.open(0us);
    std::vector<std::uint8_t> bytes;
    client.poll(0us, bytes);
    const std::string chatter = "$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n";
    client.receive({reinterpret_cast<const std::uint8_t*>(chatter.data()), chatter.size()}, 1000us);
    client.poll(3s, bytes);
    EXPECT_EQ(notes.fault, SkinFault::Garbled);
}

TEST(Explore, ZerosAreGoodMannersAndNoAnswer) {
    Notes notes;
    SkinClient client(notes, {}, 1);
    client.open(0us);
    const std::vector<std::uint8_t> zeros(3, 0);
    client.receive(zeros, 1000us);
    std::vector<std::uint8_t> bytes;
    client.poll(3s, bytes);
    EXPECT_EQ(notes.fault, SkinFault::NoAnswer);
}

TEST(Explore, AnotherVersionIsSaid) {
    Notes notes;
    SkinClient client(notes, {}, 1);
    client.open(0us);
    FrameHeader header;
    header.version = 2;
    header.type = FrameType::Hello;
    std::vector<std::uint8_t> bytes;
    appendFrame(header, "", bytes);
    client.receive(bytes, 1000us);
    EXPECT_EQ(notes.fault, SkinFault::OtherVersion);
}

}  // namespace
}  // namespace skincal
