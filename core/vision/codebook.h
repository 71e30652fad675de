#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/vision/lit_words.h"

namespace skincal {

/// The words of all modules, made ready for matching: projected off a constant per channel and a straight drift.
struct Codebook {
    Eigen::MatrixXd drift;                      ///< planes x (channels + 1), orthonormal; no slope below 8 planes
    std::vector<std::size_t> channelOf;         ///< per plane, 0 … channels-1
    std::vector<std::vector<std::size_t>> lit;  ///< per module, as in LitWords
    std::vector<double> energy;                 ///< per module, squared norm of its word off the drift
    std::vector<std::size_t> representative;    ///< per module, the first module with the same word
    bool coloured = false;

    /// False where the word is constant (never or always lit) or looks like drift: nothing can find such a module.
    [[nodiscard]] bool blinks(std::size_t module) const { return energy[module] > 0.2; }
    [[nodiscard]] std::size_t planes() const { return channelOf.size(); }
};
[[nodiscard]] Codebook makeCodebook(const LitWords& words);

/// What the surroundings of a spot do from plane to plane. A spot on patterned ground follows them: sun, lamps and
/// neighbours' light change it by a share of what they change around it.
struct Ambient {
    Eigen::VectorXd light{};  ///< per plane, grey levels; empty where it is not known
    double ridge = 0;         ///< (noise of a value / what that share is believed to be at most)^2, grey levels squared
};

/// Off its mean over the planes in `used`: of what hides a spot the surroundings tell, and must not stand for the
/// intercept.
[[nodiscard]] Ambient centred(const Ambient& ambient, std::span<const std::uint8_t> used);

/// Columns of the linear model y = X p of a series: the drift's, the ambient's where it is known, then one per word
/// with ones where it is lit.
[[nodiscard]] Eigen::MatrixXd designMatrix(const Codebook& codebook, std::span<const std::size_t> words,
                                           const Ambient& ambient = {});

/// Inverse of X^T X over the planes in `used`, the ambient's ridge added to its diagonal. Nothing where they can't tell
/// the columns apart.
[[nodiscard]] std::optional<Eigen::MatrixXd> inverseNormalMatrix(const Eigen::MatrixXd& X,
                                                                 std::span<const std::uint8_t> used,
                                                                 const Codebook& codebook, const Ambient& ambient = {});

/// Weights that turn pixel values over the planes into the amplitude of each word in `words` (least squares on drift,
/// ambient and words over the planes in `used`): one row per word, one column per plane. Empty when they can't be
/// separated.
[[nodiscard]] Eigen::MatrixXd amplitudeWeights(const Codebook& codebook, std::span<const std::size_t> words,
                                               std::span<const std::uint8_t> used, const Ambient& ambient = {});

/// The same where the design matrix, whose last columns are those of the words, and inverseNormalMatrix are at hand.
[[nodiscard]] Eigen::MatrixXd amplitudeWeights(const Eigen::MatrixXd& X, const Eigen::MatrixXd& inverse,
                                               std::size_t words, std::span<const std::uint8_t> used);

/// Orthonormal basis of what drift, ambient and `words` can explain over the planes in `used`: planes x unknowns, zero
/// rows for planes not used. What it leaves of a pixel's values is light that follows none of them.
[[nodiscard]] Eigen::MatrixXd explainedSpace(const Codebook& codebook, std::span<const std::size_t> words,
                                             std::span<const std::uint8_t> used, const Ambient& ambient = {});

}  // namespace skincal
