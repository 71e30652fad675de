#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vision/codebook.h"

namespace skincal {

/// What tells words apart: planes in which the same words are lit, or just all the others, as in a scan's second half,
/// say the same and are one bit. Of a scan's planes fewer than half are left.
struct WordBits {
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    struct Plane {
        std::size_t bit = kNone;  ///< kNone where no word is lit (or every one, where it is opposite)
        bool isOpposite = false;  ///< lit where the bit is not set
    };
    std::vector<Plane> planes;
    std::size_t count = 0;
    std::vector<std::vector<bool>> set;  ///< per bit, whether it is set in each of the words
};

/// @param words  modules of the codebook
[[nodiscard]] WordBits wordBits(const Codebook& codebook, std::span<const std::uint32_t> words);

}  // namespace skincal
