#include "core/vision/word_ranking.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>
#include <tuple>

namespace skincal {
namespace {

constexpr std::size_t kMostInGroup = 10;  // of which a table of all sums still fits into the nearest cache
constexpr std::size_t kFewestInGroup = 4;

/// Sums of all subsets of some values.
void fillSums(std::span<const float> values, float* sums) {
    sums[0] = 0;
    for (std::size_t bit = 0; bit < values.size(); ++bit) {
        const std::size_t half = std::size_t{1} << bit;
        for (std::size_t subset = 0; subset < half; ++subset)
            sums[half + subset] = sums[subset] + values[bit];
    }
}

}  // namespace

/// The best few so far.
class WordRanking::Shortlist {
  public:
    Shortlist(const WordRanking& ranking, std::size_t most) : ranking_(ranking), most_(most) {}

    /// What w . y must be more than.
    [[nodiscard]] float least() const { return least_; }
    void offer(float product, std::size_t i) {
        if (!(product > least_))
            return;
        const RankedWord ranked{static_cast<double>(product * product * ranking_.inverseEnergy_[i]),
                                ranking_.words_[i]};
        const auto before = [](const RankedWord& a, const RankedWord& b) {
            return std::tuple(-a.score, a.word) < std::tuple(-b.score, b.word);
        };
        best_.insert(std::upper_bound(best_.begin(), best_.end(), ranked, before), ranked);
        if (best_.size() > most_)
            best_.pop_back();
        if (best_.size() == most_)
            least_ = kRounding * std::sqrt(static_cast<float>(best_.back().score) / ranking_.mostInverseEnergy_);
    }
    [[nodiscard]] std::vector<RankedWord> take() { return std::move(best_); }

  private:
    static constexpr float kRounding = 1 - 1e-5F;

    const WordRanking& ranking_;
    std::size_t most_;
    float least_ = 0;
    std::vector<RankedWord> best_;
};

WordRanking::WordRanking(const Codebook& codebook) : codebook_(codebook) {
    std::size_t lit = 0;
    for (std::size_t u = 0; u < codebook.lit.size(); ++u) {
        if (codebook.representative[u] != u || !codebook.blinks(u))
            continue;
        words_.push_back(static_cast<std::uint32_t>(u));
        lit += codebook.lit[u].size();
    }
    constexpr std::size_t kSparse = 8;  // planes for each one in which a word is lit
    if (kSparse * lit > codebook.planes() * words_.size()) {
        groupBits();
        sortByFirstGroup();
    }
    for (const std::uint32_t u : words_)
        inverseEnergy_.push_back(static_cast<float>(1 / codebook.energy[u]));
    if (!words_.empty())
        mostInverseEnergy_ = *std::max_element(inverseEnergy_.begin(), inverseEnergy_.end());
}

void WordRanking::groupBits() {
    bits_ = wordBits(codebook_, words_);
    // Where words are few, a large table costs more than it spares.
    const std::size_t most =
        std::clamp(static_cast<std::size_t>(std::bit_width(words_.size())), kFewestInGroup, kMostInGroup);
    // A single word has no bits that tell it from others.
    const std::size_t groups = std::max<std::size_t>(1, (bits_.count + most - 1) / most);
    for (std::size_t g = 0; g < groups; ++g) {
        Group group{g * bits_.count / groups, 0, std::vector<std::uint16_t>(words_.size(), 0)};
        group.count = (g + 1) * bits_.count / groups - group.first;
        for (std::size_t bit = 0; bit < group.count; ++bit) {
            for (std::size_t i = 0; i < words_.size(); ++i) {
                if (bits_.set[group.first + bit][i])
                    group.values[i] = static_cast<std::uint16_t>(group.values[i] | 1U << bit);
            }
        }
        groups_.push_back(std::move(group));
    }
    bits_.set.clear();
}

void WordRanking::sortByFirstGroup() {
    const std::vector<std::uint16_t> first = groups_.front().values;
    std::vector<std::size_t> order(words_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return first[a] < first[b]; });
    const auto sort = [&](auto& list) {
        const auto before = list;
        for (std::size_t i = 0; i < order.size(); ++i)
            list[i] = before[order[i]];
    };
    sort(words_);
    for (Group& group : groups_)
        sort(group.values);
    const std::size_t values = std::size_t{1} << groups_.front().count;
    begin_.assign(values + 1, 0);
    for (const std::uint16_t value : first)
        ++begin_[value + std::size_t{1}];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    near_.resize(values);
    std::iota(near_.begin(), near_.end(), std::uint16_t{0});
    std::stable_sort(near_.begin(), near_.end(),
                     [](std::uint16_t a, std::uint16_t b) { return std::popcount(a) < std::popcount(b); });
}

void WordRanking::rankSparse(const Eigen::VectorXd& y, Shortlist& shortlist) const {
    for (std::size_t i = 0; i < words_.size(); ++i) {
        float product = 0;
        for (const std::size_t plane : codebook_.lit[words_[i]])
            product += static_cast<float>(y[static_cast<Eigen::Index>(plane)]);
        shortlist.offer(product, i);
    }
}

void WordRanking::rankDense(const Eigen::VectorXd& y, Shortlist& shortlist) const {
    float all = 0;
    std::vector<float> values(bits_.count, 0.0F);
    for (std::size_t k = 0; k < bits_.planes.size(); ++k) {
        const auto [bit, isOpposite] = bits_.planes[k];
        const auto here = static_cast<float>(y[static_cast<Eigen::Index>(k)]);
        if (isOpposite)
            all += here;
        if (bit != WordBits::kNone)
            values[bit] += isOpposite ? -here : here;
    }
    constexpr std::size_t kTable = std::size_t{1} << kMostInGroup;
    std::vector<float> sums(kTable * groups_.size());
    float others = all;
    std::size_t hard = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        const std::span here = std::span(values).subspan(groups_[g].first, groups_[g].count);
        fillSums(here, sums.data() + g * kTable);
        for (std::size_t bit = 0; bit < here.size(); ++bit) {
            if (g == 0)
                hard |= (here[bit] > 0 ? std::size_t{1} : 0) << bit;
            else
                others += std::max(here[bit], 0.0F);
        }
    }
    // From the first bits that the series shows itself on: what comes soon raises the bar for all others.
    for (const std::uint16_t away : near_) {
        const std::size_t value = hard ^ away;
        if (sums[value] + others <= shortlist.least())
            continue;
        for (std::size_t i = begin_[value]; i < begin_[value + 1]; ++i) {
            float product = all + sums[value];
            for (std::size_t g = 1; g < groups_.size(); ++g)
                product += sums[g * kTable + groups_[g].values[i]];
            shortlist.offer(product, i);
        }
    }
}

std::vector<RankedWord> WordRanking::best(const Eigen::VectorXd& y, std::size_t most) const {
    Shortlist shortlist(*this, most);
    if (most > 0 && !groups_.empty())
        rankDense(y, shortlist);
    else if (most > 0)
        rankSparse(y, shortlist);
    return shortlist.take();
}

}  // namespace skincal
