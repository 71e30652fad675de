#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/vision/word_match.h"

namespace skincal {

/// Which planes of a series are believed. A disturbed plane costs `outlier`^2, from the third of a run on
/// `hiddenCost`^2 (WordMatchOptions), a used one (residual / sigma)^2; the cheapest division is found by dynamic
/// programming (Viterbi) over four states: used, first of a run, second, later. The options must outlive it. Ref:
/// Viterbi, IEEE Trans. Inf. Theory 13, 1967.
class PlaneDivision {
  public:
    explicit PlaneDivision(const WordMatchOptions& options) : options_(options) {}

    /// @param residuals  per plane, of a fit
    /// @param used       as many, set to 0 where a plane is disturbed, to 1 elsewhere
    /// @return its cost, -2 log likelihood
    [[nodiscard]] double divide(const Eigen::VectorXd& residuals, double sigma, std::vector<std::uint8_t>& used);
    /// Of so many planes that are all disturbed.
    [[nodiscard]] double costOfNothing(std::size_t count) const;

  private:
    const WordMatchOptions& options_;
    std::vector<std::array<std::uint8_t, 2>> from_;  ///< kept from one use to the next, so as not to be allocated
};

}  // namespace skincal
