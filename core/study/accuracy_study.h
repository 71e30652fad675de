#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "core/estimation/body_model.h"
#include "core/geometry/run_context.h"
#include "core/study/truth_estimate.h"

namespace skincal {

/// How near the joint method comes, from the data alone, to the best that is possible: the same least squares started
/// at the truth (estimateFromTruth); and whether its covariances are right. Over random worlds (randomWorld).
struct AccuracyStudyOptions {
    int worlds = 30;
    std::uint64_t firstSeed = 1;  ///< the worlds are those of this seed and the next ones

    [[nodiscard]] bool validate() const { return worlds > 0 && worlds <= 100'000; }
};

/// After rigid alignment without scale, over the modules that both estimates place.
struct PoseAccuracy {
    double positionRms = 0;  ///< m
    double rotationRms = 0;  ///< rad
};

/// Errors against the covariances that came with them, relative to the first placed view, which is the body frame:
///   e_u = (log(R R_true^T), t - t_true),  NEES_u = e_u^T C_u^-1 e_u
/// If the covariances are right, each NEES is chi-squared with six degrees of freedom; those of one world are not
/// independent.
struct Consistency {
    std::size_t modules = 0;  ///< those that have a covariance
    double meanNees = 0;
    double drawnNees = 0;        ///< of one module, drawn by the world's seed
    double largestSigmas = 0;    ///< largest of all errors' components, in its own standard deviations
    std::size_t beyondFive = 0;  ///< modules with a component beyond five standard deviations
};

/// What came out in one world, or on one recording with known truth.
struct WorldAccuracy {
    std::uint64_t seed = 0;
    std::string world;    ///< what it is, in a few words
    std::string failure;  ///< why one of the estimates failed; empty where none did
    std::size_t modules = 0;
    std::size_t placed = 0;     ///< from the data alone
    std::size_t placeable = 0;  ///< from the truth: whose pose the data tell
    std::size_t missed = 0;     ///< of the placeable ones, those not placed
    std::optional<Trust> verdict;
    std::optional<PoseAccuracy> fromData;
    std::optional<PoseAccuracy> fromTruth;
    std::optional<double> ratio;  ///< of the position rms, from the data to from the truth
    std::optional<Consistency> consistency;
    /// Of the estimate from the truth: what is wrong here is wrong with the model of the noise, not with the estimate.
    std::optional<Consistency> consistencyFromTruth;
    double seconds = 0;  ///< that calibrateJoint took
};

/// Calibrates from the data alone and from the truth. Fails with Cancelled only; other failures are figures, too.
/// @param seed  draws the module of Consistency::drawnNees.
[[nodiscard]] tl::expected<WorldAccuracy, CalibrationError> assessAccuracy(const Measurements& measurements,
                                                                           const KnownTruth& truth, std::uint64_t seed,
                                                                           const RunContext& context = {});

/// The covariances as a hypothesis: one module per world, so that the terms are independent, and their sum is
/// chi-squared with 6 * worlds degrees of freedom. In 19 of 20 studies with right covariances `mean` lies in
/// [low, high]; above it they are too small, below it too large.
struct NeesTest {
    std::size_t worlds = 0;
    double mean = 0;  ///< expected 6
    double low = 0;
    double high = 0;

    [[nodiscard]] bool passes() const { return mean >= low && mean <= high; }
};

struct AccuracySummary {
    std::size_t withoutResult = 0;  ///< worlds without a ratio
    std::size_t modules = 0;
    std::size_t missed = 0;
    std::size_t beyondFive = 0;
    std::optional<double> geometricMean;  ///< of the ratios
    std::optional<double> worst;
    std::uint64_t worstSeed = 0;
    std::optional<NeesTest> nees;
    std::optional<NeesTest> neesFromTruth;
};

[[nodiscard]] AccuracySummary summarise(const std::vector<WorldAccuracy>& worlds);

struct AccuracyStudy {
    AccuracyStudyOptions options;
    std::vector<WorldAccuracy> worlds;
    bool cancelled = false;
};

/// Everything but the seconds is the same whenever it runs. Throws std::logic_error where the options are out of range.
[[nodiscard]] AccuracyStudy runAccuracyStudy(const AccuracyStudyOptions& options = {}, const RunContext& context = {});

/// As a Markdown table, one row per world, and the summary below it.
[[nodiscard]] std::string accuracyTable(const AccuracyStudy& study);

/// One world's figures on one line, for messages.
[[nodiscard]] std::string inWords(const WorldAccuracy& world);

}  // namespace skincal
