#pragma once

#include <filesystem>

#include "app/quality_table.h"
#include "core/formats/recording.h"
#include "core/workflow/calibrate.h"

namespace skincal {

/// Calibrates a recording, writes the body model, and prints the figures as a table or as JSON; progress on a terminal.
/// The exit code.
/// @param directory  of the recording
/// @param output     is replaced where it is there
/// @param more       lines of the table before the output's
int calibrateToFile(const std::filesystem::path& directory, const Recording& recording, const CalibrateOptions& options,
                    const std::filesystem::path& output, bool json, std::vector<TableRow> more = {});

}  // namespace skincal
