#include "core/vision/word_ranking.h"

#include <algorithm>
#include <array>
#include <span>

namespace skincal {
namespace {

constexpr std::size_t kGroup = 8;
constexpr std::size_t kGroups = 8;
constexpr std::size_t kBlock = kGroup * kGroups;  // planes of which one number tells where a word is lit
constexpr std::size_t kAtOnce = 64;
constexpr std::size_t kSums = std::size_t{1} << kGroup;

using Sums = std::array<std::array<float, kSums>, kGroups>;

// The inner loop of decoding: unrolled, for which compilers must know its length.
template <std::size_t groups>
void addSums(const Sums& sums, std::span<const std::uint64_t> masks, std::vector<float>& products) {
    for (std::size_t i = 0; i < masks.size(); ++i) {
        float sum = products[i];
        for (std::size_t group = 0; group < groups; ++group)
            sum += sums[group][masks[i] >> (kGroup * group) & (kSums - 1)];
        products[i] = sum;
    }
}

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
    masks_.assign((codebook.planes() + kBlock - 1) / kBlock * words_.size(), 0);
    for (std::size_t i = 0; i < words_.size(); ++i) {
        for (const std::size_t plane : codebook.lit[words_[i]])
            masks_[plane / kBlock * words_.size() + i] |= std::uint64_t{1} << (plane % kBlock);
    }
}

void WordRanking::addBlock(const Eigen::VectorXd& y, std::size_t block, std::vector<float>& products) const {
    const std::size_t planes = std::min(kBlock, codebook_.planes() - block * kBlock);
    const std::size_t groups = (planes + kGroup - 1) / kGroup;
    Sums sums{};
    for (std::size_t bit = 0; bit < kGroup * groups; ++bit) {
        auto& table = sums[bit / kGroup];
        const float here = bit < planes ? static_cast<float>(y[static_cast<Eigen::Index>(block * kBlock + bit)]) : 0.0F;
        const std::size_t half = std::size_t{1} << (bit % kGroup);
        for (std::size_t mask = 0; mask < half; ++mask)
            table[half + mask] = table[mask] + here;
    }
    const std::span masks(masks_.data() + block * words_.size(), words_.size());
    switch (groups) {
        case 1:
            return addSums<1>(sums, masks, products);
        case 2:
            return addSums<2>(sums, masks, products);
        case 3:
            return addSums<3>(sums, masks, products);
        case 4:
            return addSums<4>(sums, masks, products);
        case 5:
            return addSums<5>(sums, masks, products);
        case 6:
            return addSums<6>(sums, masks, products);
        case 7:
            return addSums<7>(sums, masks, products);
        default:
            return addSums<kGroups>(sums, masks, products);
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
        for (std::size_t block = 0; block * kBlock < codebook_.planes(); ++block)
            addBlock(y, block, products);
    }
    std::vector<RankedWord> best;
    if (most == 0)
        return best;
    // Nearly all words are far from the best few: whole groups are passed over.
    float least = 0;
    for (std::size_t first = 0; first < products.size(); first += kAtOnce) {
        const std::size_t count = std::min(products.size() - first, kAtOnce);
        const auto size = static_cast<Eigen::Index>(count);
        Eigen::Map<Eigen::ArrayXf> scores(products.data() + first, size);
        scores = scores.max(0.0F).square() * Eigen::Map<const Eigen::ArrayXf>(inverseEnergy_.data() + first, size);
        if (!(scores.maxCoeff() > least))
            continue;
        for (std::size_t i = first; i < first + count; ++i) {
            if (!(products[i] > least))
                continue;
            if (best.size() == most)
                best.pop_back();
            const RankedWord ranked{static_cast<double>(products[i]), words_[i]};
            best.insert(std::upper_bound(best.begin(), best.end(), ranked,
                                         [](const RankedWord& a, const RankedWord& b) { return a.score > b.score; }),
                        ranked);
            least = best.size() == most ? static_cast<float>(best.back().score) : 0.0F;
        }
    }
    return best;
}

}  // namespace skincal
