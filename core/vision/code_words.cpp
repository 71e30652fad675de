#include "core/vision/code_words.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <stdexcept>

namespace skincal {
namespace {

constexpr int kLongest = 31;

/// Word number `index` of the code of length n: its bits stand at the positions that are no powers of two (counted
/// from one), and those at the powers of two make H w = 0.
std::uint32_t codeWord(std::uint32_t index, int n) {
    std::uint32_t word = 0;
    std::uint32_t syndrome = 0;
    for (int position = 1; position <= n; ++position) {
        if (std::has_single_bit(static_cast<unsigned>(position)))
            continue;
        if ((index & 1U) != 0) {
            word |= 1U << static_cast<unsigned>(position - 1);
            syndrome ^= static_cast<std::uint32_t>(position);
        }
        index >>= 1U;
    }
    for (unsigned r = 0; (1U << r) <= static_cast<unsigned>(n); ++r) {
        if (((syndrome >> r) & 1U) != 0)
            word |= 1U << ((1U << r) - 1);
    }
    return word;
}

/// 1…1 is a word of the code where the columns of H, the numbers up to n, add up to zero.
bool hasAllOnes(int n) {
    int sum = 0;
    for (int position = 1; position <= n; ++position)
        sum ^= position;
    return sum == 0;
}

/// How many words the code of length n has, all but one of them other than 0…0.
std::size_t codeSize(int n) {
    return std::size_t{1} << static_cast<unsigned>(n - static_cast<int>(std::bit_width(static_cast<unsigned>(n))));
}

}  // namespace

CodeWords codeWords(std::size_t count) {
    CodeWords code{3, {}};
    while (codeSize(code.bits) - 1 - (hasAllOnes(code.bits) ? 1 : 0) < count) {
        if (++code.bits > kLongest)
            throw std::logic_error("codeWords: too many words");
    }
    const std::uint32_t ones = (1U << static_cast<unsigned>(code.bits)) - 1U;
    for (std::size_t index = 1; index < codeSize(code.bits); ++index) {
        if (const std::uint32_t word = codeWord(static_cast<std::uint32_t>(index), code.bits); word != ones)
            code.words.push_back(word);
    }
    const auto skew = [&](std::uint32_t word) { return std::abs(2 * std::popcount(word) - code.bits); };
    std::stable_sort(code.words.begin(), code.words.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return skew(a) < skew(b); });
    code.words.resize(count);
    std::sort(code.words.begin(), code.words.end());
    return code;
}

}  // namespace skincal
