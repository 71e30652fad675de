#include "ui/texts/word_lines.h"

#include <gtest/gtest.h>

namespace skincal {
namespace {

TEST(WordLines, BitsStandBelowEachOther) {
    const auto lines =
        linesOf(WordReading{14, false, {0, 1, 2, 3, 4, 6, 7, 9, 10, 12}, {0, 1, 2, 4, 6, 7, 9, 10, 12}, {3}}, 10);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_EQ(lines[0].sent, "1111101101");
    EXPECT_EQ(lines[0].received, "111.101101");
    EXPECT_EQ(lines[1].sent, "1010");
    EXPECT_EQ(lines[1].received, "1010");
}

TEST(WordLines, OfOneLedAtATimePicturesAreNamed) {
    const auto lines = linesOf(WordReading{4001, false, {1, 130}, {1, 130, 377}, {8, 9}}, 64);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_EQ(lines[0].sent, "in picture 2, 131");
    EXPECT_EQ(lines[0].received, "in picture 2, 131, 378; 2 disturbed");
    EXPECT_EQ(linesOf(WordReading{4001, false, {130}, {}}, 64)[0].received, "in no picture");
    // What flickers all the time.
    WordReading flicker{4001, false, {130}};
    for (std::uint32_t plane = 0; plane < 900; plane += 9)
        flicker.received.push_back(plane);
    EXPECT_EQ(linesOf(flicker, 64)[0].received, QStringLiteral("in picture 1, 10, 19, 28, 37, 46, 55, 64, 73, …"));
}

TEST(WordLines, OfColoursChannelsAreNamed) {
    EXPECT_EQ(linesOf(WordReading{300, true, {7, 8}, {8}}, 64)[0].sent, "in picture 3 (green), 3 (red)");
}

}  // namespace
}  // namespace skincal
