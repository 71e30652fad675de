#include <gtest/gtest.h>

#include <set>

#include "tests/unit/protocol/virtual_line.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

/// Every cell reads its own place as x, so that a reading credited to another is seen.
std::size_t placeIn(const RestReading& reading) {
    return static_cast<std::size_t>(std::lround(reading.mean.x() * 1000));
}

std::map<CellNumber, std::size_t> placesOf(const VirtualLine& line) {
    std::map<std::string, std::size_t> byId;
    for (std::size_t i = 0; i < line.network.cells(); ++i)
        byId[line.network.uniqueId(i)] = i;
    std::map<CellNumber, std::size_t> places;
    for (const NetworkCell& cell : line.notes.network->cells)
        places[cell.number] = byId.at(cell.uniqueId);
    return places;
}

TEST(Senses, APoseIsTheAverageOfEveryCellOverItsTime) {
    for (const double errors : {0.0, 1e-3, 4e-3}) {
        WireFaults faults;
        faults.byteErrors = errors;
        const Skin skin = gridSkin(12, 9);
        VirtualLine line(skin, skin.hostLinks.front(), faults, 11);
        ASSERT_TRUE(line.connect());
        const auto places = placesOf(line);
        for (int pose = 0; pose < 3; ++pose) {
            line.notes.restCame = false;
            line.client.measureRest(200ms, line.network.now());
            ASSERT_TRUE(line.runUntil([&] { return line.notes.restCame; }, 60s)) << errors;
            EXPECT_TRUE(line.notes.restMissing.empty()) << errors;
            ASSERT_EQ(line.notes.rest.size(), skin.modules.size());
            for (const RestReading& reading : line.notes.rest) {
                EXPECT_EQ(placeIn(reading), places.at(reading.cell));
                EXPECT_NEAR(reading.mean.z(), 9.81, 1e-5);
                EXPECT_NEAR(reading.count, 20, 2);
                EXPECT_NEAR(reading.temperature, 25, 1e-6);
                EXPECT_LT(reading.variance.maxCoeff(), 1e-10);
            }
        }
    }
}

TEST(Senses, WhoDoesNotAnswerIsNamed) {
    const Skin skin = gridSkin(6, 6);
    VirtualLine line(skin, skin.hostLinks.front(), {}, 12);
    ASSERT_TRUE(line.connect());
    const auto places = placesOf(line);
    // A corner has nobody behind it.
    const auto corner = std::find_if(places.begin(), places.end(), [](const auto& p) { return p.second == 35; });
    line.network.kill(35);
    line.client.measureRest(100ms, line.network.now());
    ASSERT_TRUE(line.runUntil([&] { return line.notes.restCame; }, 60s));
    EXPECT_EQ(line.notes.restMissing, std::vector{corner->first});
    EXPECT_EQ(line.notes.rest.size(), 35);
}

TEST(Senses, StreamsComeFromEveryCellUntilTheyAreStopped) {
    const Skin skin = gridSkin(6, 5);
    VirtualLine line(skin, skin.hostLinks.front(), {}, 13);
    ASSERT_TRUE(line.connect());
    const auto places = placesOf(line);
    line.client.streamRest(50ms);
    line.runFor(1s);
    std::map<CellNumber, int> came;
    for (const RestReading& reading : line.notes.streamed) {
        EXPECT_EQ(placeIn(reading), places.at(reading.cell));
        ++came[reading.cell];
    }
    EXPECT_EQ(came.size(), 30);
    for (const auto& [cell, times] : came)
        EXPECT_NEAR(times, 19.5, 2.5) << cell;
    line.client.streamRest(0ms);
    line.runFor(100ms);
    line.notes.streamed.clear();
    line.runFor(500ms);
    EXPECT_TRUE(line.notes.streamed.empty());
}

TEST(Senses, OnBadWiresEveryCellStreamsToo) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        WireFaults faults;
        faults.byteErrors = 1e-3;
        const Skin skin = gridSkin(9, 7);
        VirtualLine line(skin, skin.hostLinks.front(), faults, seed);
        ASSERT_TRUE(line.connect());
        line.notes.restarts = 0;
        line.client.streamRest(0ms);  // may be overtaken by the next, and then is void
        line.client.streamRest(100ms);
        line.runFor(1s);
        std::map<CellNumber, int> came;
        for (const RestReading& reading : line.notes.streamed)
            ++came[reading.cell];
        EXPECT_EQ(came.size(), 63U) << seed << ", restarts " << line.notes.restarts;
    }
}

TEST(Senses, TouchIsSentWhenItChanges) {
    const Skin skin = gridSkin(5, 5);
    VirtualLine line(skin, skin.hostLinks.front(), {}, 14);
    ASSERT_TRUE(line.connect());
    const auto places = placesOf(line);
    line.client.streamTouch(20ms, 5);
    line.runFor(500ms);
    std::map<CellNumber, int> came;
    for (const CellTouch& touch : line.notes.touches) {
        ++came[touch.cell];
        EXPECT_NEAR(touch.proximity, places.at(touch.cell) % 2 == 0 ? 0.5 : 0.0, 1e-4);
        EXPECT_NEAR(touch.force[0], places.at(touch.cell) % 2 == 0 ? 1 : 0, 1e-3);
        EXPECT_NEAR(touch.temperature, 25, 0.01);
        EXPECT_NEAR(touch.acceleration[2], 9.81, 0.011);
    }
    EXPECT_EQ(came.size(), 25);
    for (const auto& [cell, times] : came)
        EXPECT_EQ(times, 1) << "nothing changed after the first";
    line.notes.touches.clear();
    line.client.streamRest(50ms);
    line.runFor(500ms);
    EXPECT_TRUE(line.notes.touches.empty()) << "another stream is none of its business";
    EXPECT_FALSE(line.notes.streamed.empty());
    line.client.streamRest(0ms);
    line.client.streamTouch(20ms);
    line.runFor(1s);
    EXPECT_NEAR(static_cast<double>(line.notes.touches.size()), 25 * 49.0, 40);
}

}  // namespace
}  // namespace skincal
