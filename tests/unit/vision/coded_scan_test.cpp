#include "core/vision/coded_scan.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <set>

#include "core/vision/code_words.h"

namespace skincal::testing {
namespace {

std::vector<ModuleId> modulesNamed(std::size_t count) {
    std::vector<ModuleId> modules;
    for (std::size_t u = 0; u < count; ++u)
        modules.push_back(ModuleId{static_cast<std::uint32_t>(3 * u + 1)});
    return modules;
}

// Words at a distance of three: no word, and none with one bit wrong, is any other with one bit wrong.
bool canMendOneBit(const CodeWords& code) {
    std::set<std::uint32_t> seen;
    for (const std::uint32_t word : code.words) {
        if (!seen.insert(word).second)
            return false;
        for (int bit = 0; bit < code.bits; ++bit) {
            if (!seen.insert(word ^ (1U << static_cast<unsigned>(bit))).second)
                return false;
        }
    }
    return true;
}

TEST(CodeWords, AnyWrongBitCanBeMended) {
    for (std::size_t count = 1; count <= 300; ++count) {
        const CodeWords code = codeWords(count);
        ASSERT_EQ(code.words.size(), count);
        EXPECT_TRUE(canMendOneBit(code)) << count;
    }
    for (const std::size_t count : {1000, 2047, 2048, 10'000})
        EXPECT_TRUE(canMendOneBit(codeWords(count))) << count;
}

TEST(CodeWords, NoneBlinksLikeALamp) {
    for (const std::size_t count : {1, 7, 11, 120, 2046, 10'000}) {
        const CodeWords code = codeWords(count);
        for (const std::uint32_t word : code.words) {
            EXPECT_NE(word, 0U);
            EXPECT_LT(std::popcount(word), code.bits);
        }
    }
}

TEST(CodeWords, AreNearlyAsShortAsCanBe) {
    for (std::size_t count = 2; count <= 5000; count += 1 + count / 50) {
        const int bits = codeWords(count).bits;
        const int best = bits - (count > 2048 ? 2 : 3);
        EXPECT_GT(static_cast<double>(count) * (1 + best), std::exp2(best)) << count << " words of " << bits << " bits";
    }
}

TEST(CodeWords, SpareWordsAreTheLopsidedOnes) {
    const CodeWords code = codeWords(200);
    for (const std::uint32_t word : code.words)
        EXPECT_LE(std::abs(std::popcount(word) - 6), 2);
}

TEST(CodeWords, TooManyAreRefused) {
    EXPECT_THROW((void)codeWords(std::size_t{1} << 40U), std::logic_error);
}

TEST(CodedScan, GrowsWithTheLogarithm) {
    EXPECT_EQ(codedScan(modulesNamed(7), 1).size(), 16U);
    EXPECT_LE(codedScan(modulesNamed(200), 1).size(), 28U);
    EXPECT_LE(codedScan(modulesNamed(1000), 1).size(), 32U);
    EXPECT_LE(codedScan(modulesNamed(10'000), 1).size(), 48U);
}

TEST(CodedScan, BothEndsAreAlikeAndEveryLedShinesInHalf) {
    for (const std::size_t count : {1, 7, 55, 200}) {
        const LitSets scan = codedScan(modulesNamed(count), count);
        EXPECT_TRUE(scan.front().empty());
        EXPECT_TRUE(scan.back().empty());
        EXPECT_EQ(scan[1].size(), count);
        EXPECT_EQ(scan[scan.size() - 2].size(), count);
        std::map<ModuleId, std::size_t> shines;
        for (const auto& lit : scan) {
            for (const LitModule& one : lit)
                ++shines[one.module];
        }
        for (const auto& [module, times] : shines)
            EXPECT_EQ(times, scan.size() / 2);
    }
}

TEST(CodedScan, WhatHidesAsManyPicturesAsThereAreBitsHidesNoWord) {
    const LitSets scan = codedScan(modulesNamed(100), 4);
    const std::size_t bits = scan.size() / 2 - 2;
    for (std::size_t first = 0; first + bits <= scan.size(); ++first) {
        std::map<ModuleId, std::string> words;
        for (std::size_t k = 0; k < scan.size(); ++k) {
            if (k >= first && k < first + bits)
                continue;
            for (const ModuleId module : modulesNamed(100))
                words[module] += '0';
            for (const LitModule& one : scan[k])
                words[one.module].back() = '1';
        }
        for (auto a = words.begin(); a != words.end(); ++a) {
            for (auto b = std::next(a); b != words.end(); ++b) {
                int distance = 0;
                for (std::size_t k = 0; k < a->second.size(); ++k)
                    distance += a->second[k] != b->second[k] ? 1 : 0;
                EXPECT_GE(distance, 3) << "hidden from picture " << first;
            }
        }
    }
}

TEST(CodedScan, TheSeedDecidesWhoGetsWhichWord) {
    const auto words = [](std::uint64_t seed) {
        std::map<ModuleId, std::string> result;
        for (const auto& lit : codedScan(modulesNamed(20), seed)) {
            for (const ModuleId module : modulesNamed(20))
                result[module] += '0';
            for (const LitModule& one : lit)
                result[one.module].back() = '1';
        }
        return result;
    };
    EXPECT_EQ(words(5), words(5));
    EXPECT_NE(words(5), words(6));
}

}  // namespace
}  // namespace skincal::testing
