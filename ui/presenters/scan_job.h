#pragma once

#include <opencv2/core/mat.hpp>
#include <tl/expected.hpp>
#include <vector>

#include "core/geometry/run_context.h"
#include "core/session/session_data.h"

namespace skincal {

/// A view that was scanned, and how much the camera moved meanwhile.
struct ScanResult {
    ScannedView view;
    double moved_px = 0;  ///< in the looks that count, as LEDs and pictures without light tell
};

/// Decodes the pictures of a scan. The error is a sentence; empty where it was cancelled.
/// @param before  what all looks but the last gave, where they were decoded already
[[nodiscard]] tl::expected<ScanResult, Sentence> decodeScan(std::vector<FrameInfo> frames,
                                                            std::shared_ptr<const Pictures> pictures,
                                                            const std::vector<ModuleId>& modules,
                                                            const RunContext& context,
                                                            std::optional<ViewDetections> before = std::nullopt);

}  // namespace skincal
