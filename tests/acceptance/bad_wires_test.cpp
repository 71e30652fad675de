// A whole skin brought up over bad wires, in simulated time: numbered, described, a coded scan, a gravity pose. In full
// with SKINCAL_CELLS=10000 SKINCAL_SEEDS=100.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <set>

#include "tests/unit/protocol/virtual_line.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

std::size_t fromEnvironment(const char* name, std::size_t otherwise) {
    const char* text = std::getenv(name);
    return text ? std::strtoul(text, nullptr, 10) : otherwise;
}

struct Outcome {
    double seconds = 0;  ///< simulated, of everything but what a camera takes
    std::size_t wrongIds = 0;
    std::size_t wrongNeighbours = 0;
    std::size_t missingLinks = 0;  ///< between cells that are there
    std::size_t wrongLights = 0;
    std::size_t wrongReadings = 0;
    std::size_t missing = 0;  ///< cells that are listed as such
    std::size_t unlisted = 0;
    std::size_t notShown = 0;  ///< patterns that the skin said it could not vouch for
    std::optional<SkinFault> stopped;
    bool isComplete = false;
};

/// Place and port of both ends of a link, the lower first.
using Ends = std::array<std::size_t, 4>;

Ends ends(std::size_t a, int aPort, std::size_t b, int bPort) {
    const auto [low, high] = std::minmax(std::pair(a, aPort), std::pair(b, bPort));
    return {low.first, static_cast<std::size_t>(low.second), high.first, static_cast<std::size_t>(high.second)};
}

/// Everything that the network says, against what it is.
void compare(const SkinNetwork& network, const VirtualNetwork& truth, const Skin& skin, Outcome& outcome) {
    std::map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < truth.cells(); ++i)
        places[truth.uniqueId(i)] = i;
    std::map<CellNumber, std::size_t> placeOf;
    std::set<std::size_t> found;
    for (const NetworkCell& cell : network.cells) {
        const auto place = places.find(cell.uniqueId);
        if (place == places.end() || !found.insert(place->second).second)
            ++outcome.wrongIds;
        else
            placeOf[cell.number] = place->second;
    }
    outcome.missing = network.missing.size();
    outcome.unlisted = truth.cells() - network.cells.size() - network.missing.size();
    const auto index = skin.indexById();
    std::set<Ends> links;
    for (const Link& link : skin.links)
        links.insert(ends(index.at(link.a), link.a_port, index.at(link.b), link.b_port));
    std::set<Ends> said;
    for (const NetworkCell& cell : network.cells)
        for (const NetworkCell::Heard& heard : cell.heard)
            if (heard.cell != 0 && placeOf.contains(heard.cell) && placeOf.contains(cell.number))
                said.insert(ends(placeOf[cell.number], heard.port, placeOf[heard.cell], heard.port_there));
    for (const Ends& link : said)
        outcome.wrongNeighbours += links.contains(link) ? 0 : 1;
    for (const Ends& link : links)
        outcome.missingLinks += found.contains(link[0]) && found.contains(link[2]) && !said.contains(link) ? 1 : 0;
}

Outcome bringUp(std::size_t cells, double byteErrors, std::uint64_t seed) {
    const auto columns = static_cast<std::size_t>(std::sqrt(static_cast<double>(cells)));
    const Skin skin = gridSkin(columns, cells / columns);
    WireFaults faults;
    faults.byteErrors = byteErrors;
    VirtualLine line(skin, skin.hostLinks.front(), faults, seed);
    Outcome outcome;
    const bool isConnected = line.connect(600s);
    outcome.stopped = line.notes.fault;
    if (!isConnected)
        return outcome;
    compare(*line.notes.network, line.network, skin, outcome);
    std::map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < line.network.cells(); ++i)
        places[line.network.uniqueId(i)] = i;

    std::vector<std::vector<LitCell>> sets(24);
    for (std::size_t k = 0; k < sets.size(); ++k)
        for (std::size_t i = 1; i <= line.client.cells(); ++i)
            if ((i * 2654435761U >> k) & 1U)
                sets[k].push_back({static_cast<CellNumber>(i), 7});
    line.client.prepare(sets);
    std::uint64_t token = 0;
    bool allShown = true;
    for (const auto& set : sets) {
        bool isSaid = false;
        // As a scan does: what was not acknowledged is asked for again.
        for (int again = 0; again < 4 && line.notes.shown != token + 1; ++again) {
            line.client.light(set, token + 1, line.network.now());
            line.runUntil([&] { return line.notes.shown == token + 1 || line.notes.notShown.contains(token + 1); },
                          30s);
            isSaid = line.notes.notShown.contains(token + 1);
            line.notes.notShown.clear();
        }
        ++token;
        allShown = allShown && line.notes.shown == token;
        outcome.notShown += line.notes.shown != token && isSaid;
        std::set<std::size_t> lit;
        for (const LitCell& one : set)
            lit.insert(one.cell);
        if (line.notes.shown == token)
            for (const NetworkCell& cell : line.notes.network->cells)
                outcome.wrongLights += (line.network.led(places.at(cell.uniqueId)) != 0) != lit.contains(cell.number);
    }
    line.client.measureRest(300ms, line.network.now());
    line.runUntil([&] { return line.notes.restCame; }, 120s);
    for (const RestReading& reading : line.notes.rest) {
        const NetworkCell& cell = *std::find_if(line.notes.network->cells.begin(), line.notes.network->cells.end(),
                                                [&](const NetworkCell& c) { return c.number == reading.cell; });
        const double expected = 0.001 * static_cast<double>(places.at(cell.uniqueId));
        outcome.wrongReadings += std::abs(reading.mean.x() - expected) > 5e-4;
    }
    outcome.missing += line.notes.restMissing.size();
    outcome.stopped = line.notes.fault;
    outcome.isComplete = allShown && line.notes.restCame && line.notes.rest.size() == line.client.cells();
    outcome.seconds = 1e-6 * static_cast<double>(line.network.now().count());
    return outcome;
}

TEST(BadWires, AtOneErrorInAThousandBytesNothingIsWrongAndNothingMissing) {
    const std::size_t cells = fromEnvironment("SKINCAL_CELLS", 400);
    const std::size_t seeds = fromEnvironment("SKINCAL_SEEDS", 10);
    const Outcome clean = bringUp(cells, 0, 1);
    ASSERT_TRUE(clean.isComplete);
    EXPECT_EQ(clean.wrongNeighbours + clean.missingLinks, 0U);
    EXPECT_LT(clean.seconds, 8) << "by the clock of the simulation, which no busy machine slows";
    double worst = 0;
    double sum = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const Outcome outcome = bringUp(cells, 1e-3, seed);
        EXPECT_EQ(outcome.wrongIds, 0U) << seed;
        EXPECT_EQ(outcome.wrongNeighbours, 0U) << seed;
        EXPECT_EQ(outcome.missingLinks, 0U) << seed;
        EXPECT_EQ(outcome.wrongLights, 0U) << seed;
        EXPECT_EQ(outcome.wrongReadings, 0U) << seed;
        EXPECT_EQ(outcome.unlisted, 0U) << seed;
        EXPECT_TRUE(outcome.isComplete) << seed;
        worst = std::max(worst, outcome.seconds);
        sum += outcome.seconds;
    }
    std::cout << cells << " cells, simulated time: clean " << clean.seconds << " s, at 1e-3 byte errors mean "
              << sum / static_cast<double>(seeds) << " s, worst " << worst << " s\n";
    EXPECT_LT(worst, 2 * clean.seconds);
}

TEST(BadWires, AtOneErrorInAHundredBytesItIsSlowAndStillRight) {
    const std::size_t cells = fromEnvironment("SKINCAL_CELLS", 100);
    for (std::uint64_t seed = 0; seed < fromEnvironment("SKINCAL_SEEDS", 5); ++seed) {
        const Outcome outcome = bringUp(cells, 1e-2, seed);
        EXPECT_EQ(outcome.wrongIds + outcome.wrongNeighbours + outcome.wrongLights + outcome.wrongReadings, 0U) << seed;
        EXPECT_EQ(outcome.unlisted, 0U) << seed;
        EXPECT_TRUE(outcome.isComplete || outcome.stopped || outcome.missing + outcome.notShown > 0)
            << seed << ": neither done nor is it said what is not";
        std::cout << cells << " cells at 1e-2 byte errors, seed " << seed << ": " << outcome.seconds << " s simulated, "
                  << (outcome.stopped ? "stopped with fault " + std::to_string(static_cast<int>(*outcome.stopped))
                                      : std::to_string(outcome.missing) + " cells listed as missing, " +
                                            std::to_string(outcome.notShown) + " patterns as not shown")
                  << "\n";
    }
}

}  // namespace
}  // namespace skincal
