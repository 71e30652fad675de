#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/vision/codebook.h"
#include "core/vision/word_ranking.h"

namespace skincal {

struct WordMatchOptions {
    double outlier = 5;               ///< a plane that is off by more standard deviations than this counts as disturbed
    double hiddenCost = 2;            ///< the same where the two before it are disturbed, too: what hides an LED stays
    double maxHidden = 0.5;           ///< share of the planes that may be disturbed in a single run …
    double maxDisturbed = 0.2;        ///< … and where there are several runs
    double minSignificance = 6;       ///< amplitude over its standard deviation
    double minMargin = 20;            ///< lead over any other explanation, in -2 log likelihood
    double maxReducedCost = 4;        ///< misfit of the undisturbed planes over the noise
    double minExplained = 0.8;        ///< share of the light's blinking there that a word must explain …
    double minExplainedByTwo = 0.95;  ///< … and that two must, of which there are so many more
    double brightnessSpread = 0.05;   ///< how evenly one LED shines from plane to plane, relative
    double colourSpread = 0.1;        ///< the same between colours, where LEDs are lit in colours
    int shortlist = 8;                ///< words examined robustly per series
    int maxIterations = 50;           ///< of fitting and dropping disturbed planes; what has not settled then is no fit

    [[nodiscard]] bool validate() const;
};

enum class SeriesVerdict {
    Matched,    ///< one word, or the sum of two, explains the series and nothing else does
    Ambiguous,  ///< another explanation does nearly as well; `words` holds the best one
    Unlike,     ///< blinks, but like no word nor sum of two; `words` holds the nearest word
    Dark,       ///< no word has light in it
};

struct SeriesMatch {
    SeriesVerdict verdict = SeriesVerdict::Dark;
    std::vector<std::size_t> words;  ///< module positions, brightest first, at most 2
    std::vector<double> amplitudes;  ///< grey levels, same order
    Eigen::VectorXd drift{};         ///< of the columns of Codebook::drift
    double ambient = 0;              ///< share of what the surroundings do
    std::vector<std::uint8_t> used;  ///< per plane, 0 where it was disturbed
    std::vector<std::uint8_t> met;   ///< per plane, 1 where its value is a lower bound and the words give more
    double margin = 0;               ///< lead over the runner-up, -2 log likelihood
    std::optional<std::size_t> runnerUp{};
};

/// Whose LED is it? Maximum likelihood over modules u (and, where no single word will do, pairs) of
///   y_k = intercept + slope t_k + rho a_k + sum_u c_u w_u[k] + noise,   c_u > 0, rho ~ N(0, ambient prior)
/// but for disturbed planes, of which nothing is believed: the first two of a run cost `outlier`^2, each one more
/// `hiddenCost`^2 (the cheapest division into runs, by dynamic programming), so that a flash costs a plane, and who
/// walks past a run of them, but not the decision. The likelihoods of the best and the second-best explanation (no
/// light at all included) must differ by `minMargin`. One-at-a-time words have a single lit plane and hence no
/// redundancy: there a flash exactly in that frame looks like the LED; the shape of the spot has to decide.
/// A plane that is known to have its light or more (a clipped LED under a lamp has as much as the lamp leaves) costs
/// nothing where the model is above it by more than the noise, and is left out of the fit. A quarter of the planes must
/// be left.
/// The words of a Matched series can be separated over its `used` planes (amplitudeWeights is not empty) and its
/// amplitudes are the least-squares ones there (with `ambient`, but for its prior, and without bounds that are met): an
/// explanation whose planes keep coming and going counts as a rival, but never as the answer.
class WordMatcher {
  public:
    /// The codebook must outlive it. Throws std::logic_error on bad options.
    explicit WordMatcher(const Codebook& codebook, const WordMatchOptions& options = {});

    /// @param series   one value per plane of the codebook, grey levels
    /// @param sigma    standard deviation of a value from camera noise alone, > 0
    /// @param ambient  of the spot, where it is known
    /// @param atLeast  per plane, 1 where the value is a lower bound; empty where none is
    /// Throws std::logic_error on a size mismatch.
    [[nodiscard]] SeriesMatch match(std::span<const double> series, double sigma, const Ambient& ambient = {},
                                    std::span<const std::uint8_t> atLeast = {}) const;

  private:
    const Codebook& codebook_;
    WordMatchOptions options_;
    WordRanking ranking_;
};

}  // namespace skincal
