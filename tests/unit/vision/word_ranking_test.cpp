#include "core/vision/word_ranking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/random.h"
#include "core/vision/coded_scan.h"

namespace skincal::testing {
namespace {

Codebook bookOf(std::vector<std::vector<std::size_t>> lit, std::size_t planes) {
    LitWords words;
    words.lit = std::move(lit);
    for (std::size_t k = 0; k < planes; ++k)
        words.planes.push_back({k, -1});
    return makeCodebook(words);
}

Codebook codedBook(std::size_t modules) {
    std::vector<ModuleId> ids;
    for (std::size_t u = 0; u < modules; ++u)
        ids.emplace_back(static_cast<std::uint32_t>(u + 1));
    const LitSets scan = codedScan(ids, 1);
    std::vector<std::vector<std::size_t>> lit(modules);
    for (std::size_t k = 0; k < scan.size(); ++k) {
        for (const LitModule& one : scan[k])
            lit[one.module.value - 1].push_back(k);
    }
    return bookOf(std::move(lit), scan.size());
}

Codebook randomBook(std::size_t modules, std::size_t planes, double share, Random& random) {
    std::vector<std::vector<std::size_t>> lit(modules);
    for (auto& word : lit) {
        for (std::size_t k = 0; k < planes; ++k) {
            if (random.uniform() < share)
                word.push_back(k);
        }
    }
    return bookOf(std::move(lit), planes);
}

/// Word by word.
std::vector<RankedWord> plainly(const Codebook& book, const Eigen::VectorXd& y, std::size_t most) {
    std::vector<RankedWord> all;
    for (std::size_t u = 0; u < book.lit.size(); ++u) {
        double sum = 0;
        for (const std::size_t plane : book.lit[u])
            sum += y[static_cast<Eigen::Index>(plane)];
        if (book.representative[u] == u && book.blinks(u) && sum > 0)
            all.push_back({sum * sum / book.energy[u], u});
    }
    std::sort(all.begin(), all.end(), [](const RankedWord& a, const RankedWord& b) { return a.score > b.score; });
    all.resize(std::min(all.size(), most));
    return all;
}

void expectSame(const Codebook& book, Random& random) {
    const WordRanking ranking(book);
    for (int i = 0; i < 20; ++i) {
        Eigen::VectorXd y(static_cast<Eigen::Index>(book.planes()));
        for (double& value : y)
            value = random.normal();
        // Half of the time there is a word in it.
        if (i % 2 == 0) {
            for (const std::size_t plane : book.lit[random.index(book.lit.size())])
                y[static_cast<Eigen::Index>(plane)] += 4;
        }
        y.array() -= y.mean();
        const auto expected = plainly(book, y, 8);
        const auto ranked = ranking.best(y, 8);
        ASSERT_EQ(ranked.size(), expected.size());
        for (std::size_t j = 0; j < ranked.size(); ++j) {
            EXPECT_EQ(ranked[j].word, expected[j].word);
            EXPECT_NEAR(ranked[j].score, expected[j].score, 1e-5 * expected[0].score);
        }
    }
}

TEST(WordRanking, CodedScansAreRankedAsWordByWord) {
    Random random(1, "ranking");
    for (const std::size_t modules : {2, 7, 55, 1000, 5000})
        expectSame(codedBook(modules), random);
}

TEST(WordRanking, SoAreWordsWithoutOrder) {
    Random random(2, "ranking");
    expectSame(randomBook(40, 90, 0.5, random), random);
    expectSame(randomBook(3000, 35, 0.3, random), random);
    expectSame(randomBook(100, 200, 0.02, random), random);
}

TEST(WordRanking, ASingleWordIsFound) {
    const Codebook book = bookOf({{1, 2}}, 5);
    Eigen::VectorXd y(5);
    y << -1, 2, 1, -1, -1;
    const auto ranked = WordRanking(book).best(y, 8);
    ASSERT_EQ(ranked.size(), 1U);
    EXPECT_EQ(ranked[0].word, 0U);
}

TEST(WordBits, WhatSaysTheSameOrTheOppositeIsOneBit) {
    // Two planes alike, one their opposite, one in which all are lit, one in which none is.
    const Codebook book = bookOf({{0, 1, 3}, {2, 3}, {0, 1, 3}}, 5);
    const WordBits bits = wordBits(book, std::vector<std::uint32_t>{0, 1, 2});
    EXPECT_EQ(bits.count, 1U);
    EXPECT_EQ(bits.planes[0].bit, bits.planes[2].bit);
    EXPECT_NE(bits.planes[0].isOpposite, bits.planes[2].isOpposite);
    EXPECT_EQ(bits.planes[3].bit, WordBits::kNone);
    EXPECT_TRUE(bits.planes[3].isOpposite);
    EXPECT_EQ(bits.planes[4].bit, WordBits::kNone);
    EXPECT_FALSE(bits.planes[4].isOpposite);
}

}  // namespace
}  // namespace skincal::testing
