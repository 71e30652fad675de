#include <gtest/gtest.h>

#include <random>

#include "tests/unit/protocol/virtual_line.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

/// A skin that has been explored, and lights by number.
class Lit {
  public:
    explicit Lit(std::uint64_t seed, const WireFaults& faults = {}, std::size_t columns = 9, std::size_t rows = 6)
        : skin_(gridSkin(columns, rows)), line(skin_, skin_.hostLinks.front(), faults, seed) {
        EXPECT_TRUE(line.connect());
        std::map<std::string, std::size_t> places;
        for (std::size_t i = 0; i < line.network.cells(); ++i)
            places[line.network.uniqueId(i)] = i;
        for (const NetworkCell& cell : line.notes.network->cells)
            place_[cell.number] = places.at(cell.uniqueId);
    }

    /// Whether it was shown within so long.
    bool light(const std::vector<LitCell>& lit, std::chrono::microseconds atMost = 20s) {
        line.client.light(lit, ++token_, line.network.now());
        return line.runUntil([&] { return line.notes.shown == token_ || line.notes.notShown.contains(token_); },
                             atMost) &&
               line.notes.shown == token_;
    }
    [[nodiscard]] std::map<CellNumber, std::uint32_t> showing() const {
        std::map<CellNumber, std::uint32_t> showing;
        for (const auto& [number, place] : place_)
            if (const std::uint32_t colour = line.network.led(place))
                showing[number] = colour;
        return showing;
    }
    [[nodiscard]] std::size_t placeOf(CellNumber number) const { return place_.at(number); }
    [[nodiscard]] std::uint64_t token() const { return token_; }

  private:
    Skin skin_;
    std::map<CellNumber, std::size_t> place_;
    std::uint64_t token_ = 0;

  public:
    VirtualLine line;
};

std::map<CellNumber, std::uint32_t> expected(const std::vector<LitCell>& lit) {
    std::map<CellNumber, std::uint32_t> all;
    for (const LitCell& one : lit)
        all[one.cell] =
            (one.colour & 1U ? 0xFF0000U : 0) | (one.colour & 2U ? 0xFF00U : 0) | (one.colour & 4U ? 0xFFU : 0);
    return all;
}

std::vector<LitCell> some(std::mt19937& random, std::size_t cells, unsigned share, bool coloured) {
    std::vector<LitCell> lit;
    for (std::size_t i = 1; i <= cells; ++i)
        if (random() % 100 < share)
            lit.push_back({static_cast<CellNumber>(i), static_cast<std::uint8_t>(coloured ? 1 + random() % 7 : 7)});
    return lit;
}

TEST(Lights, WhatIsShownIsExactlyWhatWasAskedFor) {
    std::mt19937 random(1);
    Lit lit(1);
    const std::size_t cells = lit.line.client.cells();
    for (const unsigned share : {0U, 100U, 2U, 50U, 97U, 0U})
        for (const bool coloured : {false, true}) {
            const std::vector<LitCell> set = some(random, cells, share, coloured);
            ASSERT_TRUE(lit.light(set)) << share;
            EXPECT_EQ(lit.showing(), expected(set)) << share;
        }
    ASSERT_TRUE(lit.light({{17, 7}}));
    EXPECT_EQ(lit.showing(), expected({{17, 7}}));
    ASSERT_TRUE(lit.light({{5, 2}}));
    EXPECT_EQ(lit.showing(), expected({{5, 2}}));
}

TEST(Lights, GoOffAndStreamsEndWhenTheComputerTakesItsLeave) {
    std::mt19937 random(2);
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        Lit lit(seed);
        const std::vector<LitCell> set = some(random, lit.line.client.cells(), 60, false);
        ASSERT_TRUE(lit.light(set));
        lit.line.client.streamRest(30ms);
        lit.line.client.streamTouch(10ms);
        lit.line.runFor(500ms);
        // In the midst of something else.
        lit.line.client.light({{3, 7}}, 4711, lit.line.network.now());
        lit.line.runFor(1ms);
        std::vector<std::uint8_t> bytes;
        lit.line.client.takeLeave(lit.line.network.now(), bytes);
        VirtualNetwork& network = lit.line.network;
        network.fromComputer(bytes);
        network.run(network.now() + 200ms);
        EXPECT_TRUE(lit.showing().empty()) << seed;
        // What was under way, and nobody acknowledges any more, is given up.
        network.run(network.now() + 20s);
        const std::uint64_t sent = network.bytesSent();
        network.run(network.now() + 5s);
        EXPECT_EQ(network.bytesSent(), sent) << seed;
    }
}

TEST(Lights, OnBadWiresAcknowledgedMeansShown) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
        std::mt19937 random(static_cast<unsigned>(seed));
        WireFaults faults;
        faults.byteErrors = 3e-3;
        faults.lostFrames = 0.01;
        Lit lit(seed, faults);
        for (int i = 0; i < 15; ++i) {
            const std::vector<LitCell> set = some(random, lit.line.client.cells(), 50, i % 3 == 0);
            if (lit.light(set)) {
                EXPECT_EQ(lit.showing(), expected(set)) << seed << ", " << i;
            } else {
                EXPECT_TRUE(lit.line.notes.notShown.contains(lit.token())) << seed << ", " << i;
            }
        }
    }
}

TEST(Lights, ACodedScanIsOneSmallBroadcastPerFrame) {
    std::mt19937 random(3);
    Lit lit(3, {}, 20, 20);
    const std::size_t cells = lit.line.client.cells();
    std::vector<std::vector<LitCell>> sets;
    for (int k = 0; k < 24; ++k)
        sets.push_back(some(random, cells, 50, false));
    lit.line.client.prepare(sets);
    ASSERT_TRUE(lit.light({}));  // the words go out before the first light
    const std::uint64_t before = lit.line.sent;
    for (const auto& set : sets) {
        ASSERT_TRUE(lit.light(set));
        EXPECT_EQ(lit.showing(), expected(set));
    }
    // Pattern, tally and acknowledgements; 400 cells would take 50 bytes more as a mask.
    EXPECT_LT((lit.line.sent - before) / sets.size(), 30 + 30 + 45);
}

TEST(Lights, ADeadCellIsNeverTakenForShown) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        Lit lit(seed);
        const auto cells = static_cast<CellNumber>(lit.line.client.cells());
        const auto dead = static_cast<CellNumber>(2 + seed * 7 % (cells - 2));
        std::vector<LitCell> all;
        for (CellNumber cell = 1; cell <= cells; ++cell)
            all.push_back({cell, 7});
        lit.line.network.kill(lit.placeOf(dead));
        EXPECT_FALSE(lit.light(all));
        // Named by what each says itself: that one, and whom it cuts off.
        const std::vector<CellNumber>& dark = lit.line.notes.notShown.at(lit.token());
        EXPECT_TRUE(std::binary_search(dark.begin(), dark.end(), dead));
        const auto showing = lit.showing();
        for (CellNumber cell = 1; cell <= cells; ++cell)
            EXPECT_NE(showing.contains(cell), std::binary_search(dark.begin(), dark.end(), cell))
                << seed << ": " << cell;
    }
}

TEST(Lights, ANewerPatternOvertakesAnOlder) {
    Lit lit(5);
    lit.line.client.light({{1, 7}}, 1000, lit.line.network.now());
    lit.line.client.light({{2, 7}}, 1001, lit.line.network.now());
    ASSERT_TRUE(lit.line.runUntil([&] { return lit.line.notes.shown == 1001U; }, 5s));
    lit.line.runFor(100ms);
    EXPECT_EQ(lit.showing(), expected({{2, 7}}));
}

TEST(Lights, AreLitAtTheTimeThatTheyAreToldAndAcknowledgedThen) {
    for (const double lost : {0.0, 0.05}) {
        WireFaults faults;
        faults.lostFrames = lost;
        Lit lit(6, faults);
        std::mt19937 random(6);
        int inTime = 0;
        for (std::uint64_t k = 0; k < 50; ++k) {
            const auto before = lit.showing();
            const auto set = some(random, lit.line.client.cells(), 50, false);
            const auto when = lit.line.network.now() + 40ms;
            lit.line.client.light(set, 1000 + k, lit.line.network.now(), when);
            lit.line.runFor(38ms);
            EXPECT_EQ(lit.showing(), before);
            EXPECT_NE(lit.line.notes.shown, 1000 + k);
            lit.line.runFor(4ms);
            inTime += lit.showing() == expected(set) ? 1 : 0;
            ASSERT_TRUE(lit.line.runUntil([&] { return lit.line.notes.shown == 1000 + k; }, 20s));
            EXPECT_EQ(lit.showing(), expected(set));
        }
        EXPECT_GE(inTime, lost == 0 ? 50 : 1);
    }
}

TEST(Lights, WordsHaveAtMost64Bits) {
    EXPECT_THROW(LedWords(std::vector<std::vector<LitCell>>(65), 1), std::logic_error);
    EXPECT_NO_THROW(LedWords(std::vector<std::vector<LitCell>>(64), 1));
}

}  // namespace
}  // namespace skincal
