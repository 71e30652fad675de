#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "core/vision/codebook.h"

namespace skincal {

struct RankedWord {
    double score = 0;  ///< how much of the series' energy light that blinks so explains
    std::size_t word = 0;
};

/// The words of a codebook that explain most of a series on their own:
///   score_u = (w_u . y)^2 / |w_u|^2,   w_u . y > 0,   y and w_u off the drift
/// Sums over the planes in which thousands of words are lit are the bulk of decoding: where words are dense, they are
/// added up eight planes at a time from a table of all sums of these. The codebook must outlive it.
class WordRanking {
  public:
    explicit WordRanking(const Codebook& codebook);

    /// @param y     off the drift
    /// @param most  how many to return at most, best first; only one of modules that share a word is among them
    [[nodiscard]] std::vector<RankedWord> best(const Eigen::VectorXd& y, std::size_t most) const;

  private:
    void addBlock(const Eigen::VectorXd& y, std::size_t block, std::vector<float>& products) const;

    const Codebook& codebook_;
    std::vector<std::uint32_t> words_;  ///< those that can be told from others and from drift
    std::vector<float> inverseEnergy_;  ///< of these
    std::vector<std::uint64_t>
        masks_;  ///< of these, a bit per plane, 64 planes at a time; empty where words are sparse
};

}  // namespace skincal
