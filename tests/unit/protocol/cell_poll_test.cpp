#include "core/device/protocol/cell_poll.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace skincal {
namespace {

using namespace std::chrono_literals;

std::vector<CellNumber> numbers(CellNumber count) {
    std::vector<CellNumber> all;
    for (CellNumber i = 1; i <= count; ++i)
        all.push_back(i);
    return all;
}

TEST(CellPoll, EveryoneWhoAnswersAtAllIsHeardAndTheOthersAreNamed) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        std::mt19937 random(seed);
        const std::set<CellNumber> deaf{3, 77, 300};
        CellPoll poll(numbers(500), 100ms, 0us);
        std::size_t mostAtOnce = 0;
        std::set<CellNumber> asked;
        for (auto now = 0us; !poll.isOver(); now += 10ms) {
            ASSERT_LT(now, 60s);
            for (const CellRange& range : poll.poll(now)) {
                EXPECT_LE(range.count, CellPoll::kRange);
                for (CellNumber i = 0; i < range.count; ++i)
                    asked.insert(static_cast<CellNumber>(range.first + i));
            }
            mostAtOnce = std::max(mostAtOnce, asked.size());
            for (auto cell = asked.begin(); cell != asked.end();) {
                const unsigned luck = random() % 10;
                if (luck < 3 && !deaf.contains(*cell)) {
                    EXPECT_TRUE(poll.answered(*cell, now));
                }
                cell = luck < 4 ? asked.erase(cell) : std::next(cell);  // one in ten gets lost
            }
        }
        EXPECT_LE(mostAtOnce, CellPoll::kAtOnce + 30);
        EXPECT_EQ(poll.missing(), std::vector<CellNumber>(deaf.begin(), deaf.end()));
    }
}

TEST(CellPoll, AnswersOfStrangersAndSecondAnswersDontCount) {
    CellPoll poll({4, 5}, 100ms, 0us);
    EXPECT_EQ(poll.poll(0us), std::vector<CellRange>({{4, 2}}));
    EXPECT_FALSE(poll.answered(6, 1ms));
    EXPECT_FALSE(poll.answered(0, 1ms));
    EXPECT_TRUE(poll.answered(4, 1ms));
    EXPECT_FALSE(poll.answered(4, 1ms));
    EXPECT_FALSE(poll.isOver());
    EXPECT_TRUE(poll.answered(5, 2ms));
    EXPECT_TRUE(poll.isOver());
}

TEST(CellPoll, NobodyToAskIsOverAtOnce) {
    CellPoll poll({}, 100ms, 0us);
    EXPECT_TRUE(poll.isOver());
    EXPECT_TRUE(poll.poll(0us).empty());
}

}  // namespace
}  // namespace skincal
