#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/vision/plane_division.h"
#include "core/vision/word_match.h"

namespace skincal {

/// Unknowns of a series at most: drift, ambient and two words, or a word and a step.
constexpr int kMostUnknowns = 8;
/// Small enough for the stack: some ten fits are made per spot.
using Unknowns = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostUnknowns, 1>;
using UnknownsSquare = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostUnknowns, kMostUnknowns>;

/// A series as the light of some words.
struct Explanation {
    std::vector<std::size_t> words;
    Unknowns amplitudes;
    Unknowns drift;                                         ///< of the columns of Codebook::drift
    double ambient = 0;                                     ///< share of what the surroundings do
    std::vector<std::uint8_t> used;                         ///< per plane, 0 where it is taken for disturbed
    std::vector<std::uint8_t> met;                          ///< per plane, 1 where it is a bound and tells no more
    double cost = std::numeric_limits<double>::infinity();  ///< -2 log likelihood
    std::size_t disturbed = 0;                              ///< planes
    std::size_t runs = 0;                                   ///< of disturbed planes
    std::size_t fitted = 0;    ///< planes that are neither disturbed nor a bound that is met
    double reducedCost = 0;    ///< of the used planes, per degree of freedom
    double explained = 0;      ///< share of the blinking in the used planes, camera noise taken off
    bool significant = false;  ///< and settled; else it may compete, but not win

    /// Nothing is left to explain.
    [[nodiscard]] bool isClean() const { return significant && disturbed == 0 && reducedCost <= 1; }
};

/// What of a series neither drift nor ambient explains.
[[nodiscard]] Eigen::VectorXd offDrift(const Codebook& codebook, const Ambient& ambient, const Eigen::VectorXd& y);

/// What is to be explained.
struct FittedSeries {
    const Eigen::VectorXd& y;               ///< per plane, grey levels
    double sigma = 1;                       ///< of a value, from camera noise alone
    double strength = 0;                    ///< of the LED, about: how evenly it shines counts as noise
    std::span<const std::uint8_t> atLeast;  ///< per plane, 1 where the value is a lower bound; empty where none is
};

/// Fits words to one series, see WordMatcher; the codebook, the series, the ambient and the options must outlive it.
class SeriesFit {
  public:
    SeriesFit(const Codebook& codebook, const FittedSeries& series, const Ambient& ambient,
              const WordMatchOptions& options);

    /// The best of two starts: plain least squares, and (for single words) levels that hidden planes don't move.
    /// @param words  none, one or two
    [[nodiscard]] Explanation explain(const std::vector<std::size_t>& words);
    /// From plain least squares alone, for half the price: what hidden planes mislead may cost too much.
    [[nodiscard]] Explanation explainPlainly(const std::vector<std::size_t>& words);
    /// Cost of no LED at all, only drift, ambient and disturbances; or of a single step besides, as a knock of the
    /// camera or somebody who stays makes one, which costs as much as a disturbance.
    /// @param used  of the best explanation: steps are tried where it begins or ends to leave planes out
    [[nodiscard]] double costOfDarkness(const std::vector<std::uint8_t>& used);
    [[nodiscard]] bool believable(const Explanation& e) const;

  private:
    /// Least squares over the used planes.
    struct Solution {
        Eigen::LDLT<UnknownsSquare, Eigen::Lower> factor;  ///< of the normal matrix
        Unknowns values;
        double drifted = 0;  ///< what the first of the drift is less where the ambient is off its mean over all planes
    };

    [[nodiscard]] const std::vector<std::uint8_t>& fittedOf(const std::vector<std::uint8_t>& used);
    [[nodiscard]] Explanation refine(const std::vector<std::size_t>& words, std::vector<std::uint8_t> used);
    void appendColumn(std::span<const std::size_t> planes);
    /// @param fitted  planes that count
    [[nodiscard]] std::optional<Solution> solve(const std::vector<std::uint8_t>& fitted) const;
    /// Sets residuals to zero where a bound is met, and `met` to one.
    void meetBounds(Eigen::VectorXd& residuals, std::vector<std::uint8_t>& met) const;
    void judge(const Solution& solution, bool settled, Explanation& e) const;
    void setResiduals(const Solution& solution);
    /// Ambient::ridge is for camera noise; here LEDs that shine unevenly are noise, too.
    [[nodiscard]] double ridge() const { return ambient_.ridge * std::pow(sigma_ / cameraSigma_, 2); }
    [[nodiscard]] bool hasAmbient() const { return ambient_.light.size() > 0; }
    [[nodiscard]] std::vector<std::uint8_t> calmPlanes(const Explanation& e) const;
    [[nodiscard]] bool mayBeDisturbance(const Explanation& e) const;
    [[nodiscard]] Eigen::VectorXd residualsFromLevels(std::size_t word) const;

    const Codebook& codebook_;
    const Ambient& ambient_;
    const WordMatchOptions& options_;
    const Eigen::VectorXd& y_;
    std::vector<std::size_t> bounds_;  ///< planes whose values are lower bounds
    double cameraSigma_;
    double sigma_;  ///< with the uneven brightness of the LEDs
    PlaneDivision division_;
    // Planes x unknowns: drift, ambient off its mean, and then the columns of what is being fitted.
    Eigen::MatrixXd columns_;
    Eigen::Index baseCount_ = 0;
    Eigen::Index count_ = 0;
    // Sums over all planes, of the columns with each other (lower triangle) and with y.
    UnknownsSquare N_;
    Unknowns moment_;
    // Kept from one use to the next, so as not to be allocated each time.
    Eigen::VectorXd residuals_;
    std::vector<std::uint8_t> next_;
    std::vector<std::uint8_t> fitted_;
    std::vector<std::uint8_t> met_;
    std::vector<std::uint8_t> nextMet_;
};

}  // namespace skincal
