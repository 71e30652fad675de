#include "core/vision/coded_scan.h"

#include <algorithm>
#include <bit>

#include "core/geometry/random.h"

namespace skincal {
namespace {

using Word = std::uint32_t;

/// Words of `bits` bits, no two nearer than `distance`, none all on or off, in order of value.
std::vector<Word> distinctWords(std::size_t count, int bits, int distance) {
    std::vector<Word> words;
    for (Word word = 1; word + 1 < (Word{1} << static_cast<unsigned>(bits)) && words.size() < count; ++word) {
        const bool far = std::all_of(words.begin(), words.end(),
                                     [&](Word other) { return std::popcount(word ^ other) >= distance; });
        if (far)
            words.push_back(word);
    }
    return words;
}

/// As few bits as give every module a word that differs from all others in two bits.
std::vector<Word> codeBook(std::size_t modules, int& bits) {
    constexpr int kDistance = 2;
    for (bits = 3;; ++bits) {
        auto words = distinctWords(modules, bits, kDistance);
        if (words.size() == modules)
            return words;
    }
}

}  // namespace

LitSets codedScan(std::span<const ModuleId> modules, std::uint64_t seed) {
    int bits = 0;
    auto words = codeBook(modules.size(), bits);
    Random random(seed, "words");
    for (std::size_t i = words.size(); i > 1; --i)
        std::swap(words[i - 1], words[random.index(i)]);
    LitSets scan{{}, {}};
    for (const ModuleId module : modules)
        scan[1].push_back({module, std::nullopt});
    for (int bit = 0; bit < bits; ++bit) {
        for (const bool complement : {false, true}) {
            std::vector<LitModule> lit;
            for (std::size_t u = 0; u < words.size(); ++u) {
                if ((((words[u] >> static_cast<unsigned>(bit)) & 1U) != 0) != complement)
                    lit.push_back({modules[u], std::nullopt});
            }
            scan.push_back(std::move(lit));
        }
    }
    scan.emplace_back();
    return scan;
}

}  // namespace skincal
