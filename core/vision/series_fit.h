#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/vision/word_match.h"

namespace skincal {

/// A series as the light of some words.
struct Explanation {
    std::vector<std::size_t> words;
    Eigen::VectorXd amplitudes;
    Eigen::VectorXd drift;                                  ///< of the columns of Codebook::drift
    double ambient = 0;                                     ///< share of what the surroundings do
    std::vector<std::uint8_t> used;                         ///< per plane, 0 where it is taken for disturbed
    double cost = std::numeric_limits<double>::infinity();  ///< -2 log likelihood
    std::size_t disturbed = 0;                              ///< planes
    std::size_t runs = 0;                                   ///< of disturbed planes
    double reducedCost = 0;                                 ///< of the used planes, per degree of freedom
    double explained = 0;      ///< share of the blinking in the used planes, camera noise taken off
    bool significant = false;  ///< and settled; else it may compete, but not win

    /// Nothing is left to explain.
    [[nodiscard]] bool isClean() const { return significant && disturbed == 0 && reducedCost <= 1; }
};

/// What of a series neither drift nor ambient explains.
[[nodiscard]] Eigen::VectorXd offDrift(const Codebook& codebook, const Ambient& ambient, const Eigen::VectorXd& y);

/// Fits words to one series, see WordMatcher; the codebook, the ambient and the options must outlive it.
class SeriesFit {
  public:
    /// @param sigma     of a value, from camera noise alone
    /// @param strength  of the LED, about: how evenly it shines counts as noise
    SeriesFit(const Codebook& codebook, const Eigen::VectorXd& y, double sigma, double strength, const Ambient& ambient,
              const WordMatchOptions& options);

    /// @param words  none, one or two
    [[nodiscard]] Explanation explain(const std::vector<std::size_t>& words) const;
    /// Cost of no LED at all, only drift, ambient and disturbances; or of a single step besides, as a knock of the
    /// camera or somebody who stays makes one, which costs as much as a disturbance.
    /// @param used  of the best explanation: steps are tried where it begins or ends to leave planes out
    [[nodiscard]] double costOfDarkness(const std::vector<std::uint8_t>& used) const;
    [[nodiscard]] bool believable(const Explanation& e) const;

  private:
    static constexpr int kMostColumns = 8;
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, kMostColumns, Eigen::RowMajor>;

    [[nodiscard]] Explanation refine(Rows rows, Eigen::Index columns, const std::vector<std::size_t>& words,
                                     std::vector<std::uint8_t> used) const;
    [[nodiscard]] double costOfNothing() const;
    [[nodiscard]] std::vector<std::uint8_t> calmPlanes(const Explanation& e) const;
    [[nodiscard]] bool mayBeDisturbance(const Explanation& e) const;
    [[nodiscard]] double divide(const Eigen::VectorXd& residuals, std::vector<std::uint8_t>& used) const;
    [[nodiscard]] Eigen::VectorXd residualsFromLevels(std::size_t word) const;

    const Codebook& codebook_;
    const Ambient& ambient_;
    const WordMatchOptions& options_;
    Eigen::VectorXd y_;
    double cameraSigma_;
    double sigma_;  ///< with the uneven brightness of the LEDs
    Rows base_;     ///< drift and ambient, and room for words
    Eigen::Index baseColumns_;
};

}  // namespace skincal
