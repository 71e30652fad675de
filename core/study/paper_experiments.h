#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/run_context.h"

namespace skincal {

/// The experiments of the paper's section III in simulated worlds with known truth: the paper's method and ours on the
/// same data, next to what the paper printed and to the Cramer-Rao bound for the simulated noise.
struct PaperStudyOptions {
    int trials = 50;           ///< worlds per experiment, seeds 1, 2, …
    double pixelNoise = 0.05;  ///< px per axis, the same for both methods
    std::string only{};        ///< experiments whose name has this in it; all where it is empty

    [[nodiscard]] bool validate() const { return trials > 0 && trials <= 100'000 && pixelNoise > 0; }
};

/// What one method reached over all trials.
struct MethodOutcome {
    /// Trials in which it gave a result: the "n of N" of the table; mean and rms are over these alone. Ours gives none
    /// where a picture of a flat patch could be of its mirror pose as well: it says so, and the paper's does not. Such
    /// a trial still counts as an answer where both sides agree, that is where the quantity in every other pose that
    /// is nearly as likely (BodySolution::rivals) differs from the given one by less than the rms error that the
    /// Cramer-Rao bound of this world allows. So n differs between quantities of the same worlds.
    int solved = 0;
    std::optional<double> mean;  ///< of the quantity
    std::optional<double> rms;   ///< of its error
};

struct ExperimentRow {
    std::string experiment;
    std::string quantity;
    std::string unit;
    double truth = 0;               ///< value of the quantity
    std::optional<double> printed;  ///< the paper's figure
    MethodOutcome paper;
    MethodOutcome ours;
    /// The rms error of an estimate that reaches the Cramer-Rao bound, over all trials. Lengths of vectors are biased
    /// even then (see meanSquareOfLength).
    std::optional<double> bound;
};

struct PaperStudy {
    PaperStudyOptions options;
    std::vector<ExperimentRow> rows;
    bool cancelled = false;
};

[[nodiscard]] PaperStudy runPaperStudy(const PaperStudyOptions& options = {}, const RunContext& context = {});

/// As a Markdown table.
[[nodiscard]] std::string studyTable(const PaperStudy& study);

}  // namespace skincal
