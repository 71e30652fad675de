#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/geometry/run_context.h"
#include "core/study/scan_case.h"
#include "core/study/scan_score.h"
#include "core/study/scan_world.h"

namespace skincal {

/// Scans view 1 of scanWorld in pictures and decodes them. Cancelled: no views.
[[nodiscard]] ScanScore scoreScan(const ScanCase& what, std::uint64_t seed, const RunContext& context = {});
/// The same of a world of scanWorld in which something was changed.
[[nodiscard]] ScanScore scoreScan(World world, const ScanCase& what, const RunContext& context = {});

struct ScanStudyOptions {
    std::vector<ScanCase> cases;
    int seeds = 10;
    std::uint64_t firstSeed = 1;

    [[nodiscard]] bool validate() const;
};

struct ScanStudyRow {
    ScanCase what;
    ScanScore score;
};
struct ScanStudy {
    ScanStudyOptions options;
    std::vector<ScanStudyRow> rows;
    bool cancelled = false;
};

/// Scans are made on all processors beside each other, which the seconds, of each by itself, feel; all else is the same
/// whenever it runs. What was cancelled has no rows. Throws std::logic_error where the options are out of range.
[[nodiscard]] ScanStudy runScanStudy(const ScanStudyOptions& options, const RunContext& context = {});

/// As a Markdown table, one line per case, and the sum below it.
[[nodiscard]] std::string scanTable(const ScanStudy& study);

/// As a picture (SVG): for each disturbance, the share found against its strength, one line per method; crosses where
/// anything was taken for what it is not.
[[nodiscard]] std::string scanPlot(const ScanStudy& study);

}  // namespace skincal
