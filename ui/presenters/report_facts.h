#pragma once

#include "core/geometry/run_context.h"
#include "core/session/solution.h"
#include "ui/print/report.h"

namespace skincal {

/// Puts into a report what it says of the data: how many there are, what was decided about them, and for each detection
/// of each view that counts what decided. Crops of at most `mostCrops` detections, those with the least lead, since
/// they are the bulk of a report. Touches nothing but its arguments: any thread will do. Cancelled, it is left
/// unfinished.
void addData(ReportFacts& facts, const Measured& measured, const Decisions& decisions, std::size_t mostCrops,
             const RunContext& context = {});

}  // namespace skincal
