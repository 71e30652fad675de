// What tests/fuzz/fuzz_protocol does for hours, for a second: both ends are fed with bytes that mean little.

#include <gtest/gtest.h>

#include <random>

#include "tests/fuzz/protocol_entry.h"

namespace skincal::test {
namespace {

TEST(Garbage, RawOrMendedHurtsNobody) {
    std::mt19937 random(1);
    for (int round = 0; round < 6000; ++round) {
        std::vector<std::uint8_t> input(random() % 400);
        for (std::uint8_t& byte : input)
            byte = static_cast<std::uint8_t>(random() % 3 == 0 ? random() % 64 : random());
        ASSERT_NO_THROW(talk(input)) << round;
    }
}

TEST(Garbage, MendedFramesAreWhole) {
    std::mt19937 random(2);
    std::size_t whole = 0;
    for (int round = 0; round < 200; ++round) {
        std::vector<std::uint8_t> input(300);
        for (std::uint8_t& byte : input)
            byte = static_cast<std::uint8_t>(random());
        FrameDecoder decoder;
        decoder.feed(mended(input), [&](const FrameHeader&, std::string_view) { ++whole; });
        EXPECT_EQ(decoder.counts().damaged, 0U);
    }
    EXPECT_GT(whole, 200U) << "else nothing behind the CRC would ever be tried";
}

}  // namespace
}  // namespace skincal::test
