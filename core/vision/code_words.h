#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace skincal {

/// A binary block code of minimum distance three, one word per module: of any word one wrong bit can be mended, or two
/// bits that were not seen.
struct CodeWords {
    int bits = 0;                      ///< n
    std::vector<std::uint32_t> words;  ///< bit i of a word is symbol i, 0 … n-1
};

/// The Hamming code with parity-check matrix H = [1 2 … n] (columns are the numbers in binary), shortened to the least
/// n that has `count` words besides 0…0 and 1…1, which blink like a lamp: of its 2^(n - ceil(log2(n + 1))) words those
/// that are most nearly half ones, in order of value.
///
/// No code of distance three can do with fewer bits than the sphere-packing bound allows, count (1 + n) <= 2^n. Two
/// words or more never need more than two bits above it, from 2,049 on one:
///   words      7   55  200  1,000  10,000
///   bits       6   10   12     14      19
///   bound      6   10   12     14      18
/// Ref: Hamming, Bell System Technical Journal 29, 1950.
/// Throws std::logic_error where more than 67 million words are asked for.
[[nodiscard]] CodeWords codeWords(std::size_t count);

}  // namespace skincal
