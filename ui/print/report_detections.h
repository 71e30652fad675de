#pragma once

#include "ui/print/report.h"

namespace skincal {

/// A report's part on what the pictures showed: a table per scan, a line per detection.
[[nodiscard]] QString detectionsHtml(const BodyModel& body, const std::vector<ReportedScan>& scans);

}  // namespace skincal
