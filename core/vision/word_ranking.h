#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/vision/word_bits.h"

namespace skincal {

struct RankedWord {
    double score = 0;  ///< how much of the series' energy light that blinks so explains
    std::size_t word = 0;
};

/// The words of a codebook that explain most of a series on their own:
///   score_u = (w_u . y)^2 / |w_u|^2,   w_u . y > 0,   y and w_u off the drift
/// Where words are dense, their bits (WordBits) are taken some at a time: a table has the sums of all that these may
/// be, and what the other bits can add at most rules nearly all words out at a look at their first few. The codebook
/// must outlive it.
class WordRanking {
  public:
    explicit WordRanking(const Codebook& codebook);

    /// @param y     off the drift
    /// @param most  how many to return at most, best first; only one of modules that share a word is among them
    [[nodiscard]] std::vector<RankedWord> best(const Eigen::VectorXd& y, std::size_t most) const;

  private:
    class Shortlist;
    /// Some bits of all words, one after the other.
    struct Group {
        std::size_t first = 0;
        std::size_t count = 0;
        std::vector<std::uint16_t> values;  ///< per word
    };

    void groupBits();
    /// Words of like first bits after each other.
    void sortByFirstGroup();
    void rankSparse(const Eigen::VectorXd& y, Shortlist& shortlist) const;
    void rankDense(const Eigen::VectorXd& y, Shortlist& shortlist) const;

    const Codebook& codebook_;
    std::vector<std::uint32_t> words_;  ///< those that can be told from others and from drift
    std::vector<float> inverseEnergy_;  ///< of these
    float mostInverseEnergy_ = 0;
    WordBits bits_;
    std::vector<Group> groups_;         ///< empty where words are sparse
    std::vector<std::uint32_t> begin_;  ///< per value of the first group, where its words begin; and their end
    std::vector<std::uint16_t> near_;   ///< all values of the first group, those of few set bits first
};

}  // namespace skincal
