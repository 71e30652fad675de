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
    double moved_px = 0;  ///< between the first and the last picture without light
};

/// Decodes the pictures of a scan. The error is a sentence; empty where it was cancelled.
[[nodiscard]] tl::expected<ScanResult, std::string> decodeScan(std::vector<FrameInfo> frames,
                                                               std::shared_ptr<const Pictures> pictures,
                                                               const std::vector<ModuleId>& modules,
                                                               const RunContext& context);

/// What decided about a module in a view: means of the pictures around one pixel, 8 bit grey.
struct SpotEvidence {
    cv::Mat lit;          ///< while its LED was on
    cv::Mat dark;         ///< while it was off
    cv::Mat difference;   ///< the first minus the second, stretched to full contrast
    cv::Point corner;     ///< of the crops in the picture
    double contrast = 0;  ///< grey levels between on and off at the brightest pixel
};
[[nodiscard]] std::optional<SpotEvidence> evidenceOf(const ScannedView& view, ModuleId module, const Vector2d& pixel,
                                                     int radius = 16);

}  // namespace skincal
