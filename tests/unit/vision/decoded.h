#pragma once

#include "core/vision/decoder.h"
#include "tests/unit/vision/scan_painter.h"

namespace skincal::testing {

/// What decodeView makes of a painted scan; a failed expectation and nothing where it fails.
[[nodiscard]] ViewDetections decode(const ScanPainter& scan, const DecoderOptions& options = {});

/// The entry of a module that was not detected, else null.
[[nodiscard]] const Undetected* missing(const ViewDetections& view, ModuleId module);

/// Nothing may be reported elsewhere than where it is, and every module is accounted for; returns how many were found.
std::size_t expectNoneWrong(const ScanPainter& scan, const ViewDetections& view, double tolerance_px = 0.5);

}  // namespace skincal::testing
