#include "core/vision/word_bits.h"

#include <map>

namespace skincal {

WordBits wordBits(const Codebook& codebook, std::span<const std::uint32_t> words) {
    std::vector<std::vector<bool>> lit(codebook.planes(), std::vector<bool>(words.size(), false));
    for (std::size_t i = 0; i < words.size(); ++i) {
        for (const std::size_t plane : codebook.lit[words[i]])
            lit[plane][i] = true;
    }
    WordBits bits;
    std::map<std::vector<bool>, std::size_t> known{{std::vector<bool>(words.size(), false), WordBits::kNone}};
    for (std::vector<bool>& one : lit) {
        // Of a bit and its opposite the one that the first word does not have stands for both.
        const bool isOpposite = !one.empty() && one.front();
        if (isOpposite)
            one.flip();
        const auto [at, isNew] = known.try_emplace(one, bits.count);
        bits.planes.push_back({at->second, isOpposite});
        if (isNew) {
            bits.set.push_back(std::move(one));
            ++bits.count;
        }
    }
    return bits;
}

}  // namespace skincal
