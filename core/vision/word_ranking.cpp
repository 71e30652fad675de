#include "core/vision/word_ranking.h"

#include <algorithm>
#include <array>

namespace skincal {
namespace {

constexpr std::size_t kGroup = 8;

}  // namespace

WordRanking::WordRanking(const Codebook& codebook) : codebook_(codebook) {
    std::size_t lit = 0;
    for (std::size_t u = 0; u < codebook.lit.size(); ++u) {
        if (codebook.representative[u] != u || !codebook.blinks(u))
            continue;
        words_.push_back(static_cast<std::uint32_t>(u));
        inverseEnergy_.push_back(static_cast<float>(1 / codebook.energy[u]));
        lit += codebook.lit[u].size();
    }
    const std::size_t groups = (codebook.planes() + kGroup - 1) / kGroup;
    if (lit <= groups * words_.size())
        return;
    masks_.assign(groups * words_.size(), 0);
    for (std::size_t i = 0; i < words_.size(); ++i) {
        for (const std::size_t plane : codebook.lit[words_[i]])
            masks_[plane / kGroup * words_.size() + i] |= static_cast<std::uint8_t>(1U << (plane % kGroup));
    }
}

std::vector<RankedWord> WordRanking::best(const Eigen::VectorXd& y, std::size_t most) const {
    std::vector<float> products(words_.size(), 0.0F);
    if (masks_.empty()) {
        for (std::size_t i = 0; i < words_.size(); ++i) {
            for (const std::size_t plane : codebook_.lit[words_[i]])
                products[i] += static_cast<float>(y[static_cast<Eigen::Index>(plane)]);
        }
    } else {
        std::array<float, std::size_t{1} << kGroup> sums{};
        for (std::size_t group = 0; group * kGroup < codebook_.planes(); ++group) {
            for (std::size_t bit = 0; bit < kGroup; ++bit) {
                const std::size_t plane = group * kGroup + bit;
                const float here =
                    plane < codebook_.planes() ? static_cast<float>(y[static_cast<Eigen::Index>(plane)]) : 0.0F;
                const std::size_t half = std::size_t{1} << bit;
                for (std::size_t mask = 0; mask < half; ++mask)
                    sums[half + mask] = sums[mask] + here;
            }
            const std::uint8_t* mask = masks_.data() + group * words_.size();
            for (std::size_t i = 0; i < products.size(); ++i)
                products[i] += sums[mask[i]];
        }
    }
    std::vector<RankedWord> best;
    if (most == 0)
        return best;
    float least = 0;
    for (std::size_t i = 0; i < products.size(); ++i) {
        if (products[i] <= 0)
            continue;
        const float score = products[i] * products[i] * inverseEnergy_[i];
        if (best.size() == most && score <= least)
            continue;
        if (best.size() == most)
            best.pop_back();
        const RankedWord ranked{static_cast<double>(score), words_[i]};
        best.insert(std::upper_bound(best.begin(), best.end(), ranked,
                                     [](const RankedWord& a, const RankedWord& b) { return a.score > b.score; }),
                    ranked);
        least = static_cast<float>(best.back().score);
    }
    return best;
}

}  // namespace skincal
