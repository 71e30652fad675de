// What the fuzzers of tests/fuzz do for hours, for seconds: what they have kept, and invented inputs.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "tests/fuzz/cell_entry.h"
#include "tests/fuzz/client_entry.h"
#include "tests/fuzz/frames_entry.h"

namespace skincal::test {
namespace {

struct Target {
    const char* name;
    void (*entry)(std::span<const std::uint8_t>);
};

class Garbage : public testing::TestWithParam<Target> {};

TEST_P(Garbage, ThatTheFuzzerKeptHurtsNobody) {
    std::size_t inputs = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::string(SKINCAL_FUZZ_CORPUS "/") + GetParam().name)) {
        std::ifstream file(entry.path(), std::ios::binary);
        const std::vector<char> bytes(std::istreambuf_iterator<char>(file), {});
        const std::vector<std::uint8_t> input(bytes.begin(), bytes.end());
        ASSERT_NO_THROW(GetParam().entry(input)) << entry.path();
        ++inputs;
    }
    EXPECT_GT(inputs, 20U);
}

TEST_P(Garbage, InventedHurtsNobody) {
    std::mt19937 random(1);
    for (int round = 0; round < 20'000; ++round) {
        // Records (ByteSource): what is said in one is often of a kind that somebody listens to.
        std::vector<std::uint8_t> input{static_cast<std::uint8_t>(random())};
        for (auto records = random() % 12; records > 0; --records) {
            const std::size_t length = 4 + random() % 36;
            input.push_back(static_cast<std::uint8_t>(length));
            for (std::size_t i = 0; i < length; ++i)
                input.push_back(static_cast<std::uint8_t>(random() % 3 == 0 ? random() % 16 : random()));
        }
        ASSERT_NO_THROW(GetParam().entry(input)) << round;
    }
}

INSTANTIATE_TEST_SUITE_P(, Garbage,
                         testing::Values(Target{"frames", takeApart}, Target{"cell", hearAsCell},
                                         Target{"client", hearAsComputer}),
                         [](const auto& target) { return target.param.name; });

TEST(MadeFrames, AreWhole) {
    std::mt19937 random(2);
    std::size_t whole = 0;
    for (int round = 0; round < 2000; ++round) {
        std::vector<std::uint8_t> input(60);
        for (std::uint8_t& byte : input)
            byte = static_cast<std::uint8_t>(random());
        input.front() %= 240;  // else they are mere bytes
        Course course;
        ByteSource from(input);
        std::vector<std::uint8_t> bytes;
        appendArrival(from, course, bytes);
        FrameDecoder decoder;
        decoder.feed(bytes, [&](const FrameHeader&, std::string_view) { ++whole; });
    }
    EXPECT_EQ(whole, 2000U) << "else nothing behind the CRC would ever be tried";
}

}  // namespace
}  // namespace skincal::test
