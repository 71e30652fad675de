#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>

#include "core/session/session.h"
#include "ui/presenters/model_overlay.h"

namespace skincal {

/// What decided about a module in a view: means of the pictures around one pixel, 8 bit grey, all of one size; black
/// beyond the picture's edge.
struct SpotEvidence {
    cv::Mat lit;          ///< while its LED was on
    cv::Mat dark;         ///< while it was off
    cv::Mat difference;   ///< the first minus the second, stretched to full contrast
    cv::Mat threshold;    ///< where the blurred difference exceeds half its maximum here, 255 (paper, eq. 11b)
    cv::Point corner;     ///< of the crops in the picture
    double contrast = 0;  ///< grey levels between on and off at the brightest pixel
    double level = 0;     ///< of the threshold, grey levels of the blurred difference
    /// Gaussian sigma of a round spot fitted to the difference at the pixel; empty where none fits.
    std::optional<double> width_px;
};
/// Empty without pictures, outside of them, and where the module was not both on and off.
[[nodiscard]] std::optional<SpotEvidence> evidenceOf(const ScannedView& view, ModuleId module, const Vector2d& pixel,
                                                     int radius = 10);

/// One to show detections on: the second of the first look that counts, in which most LEDs shine. The view must have
/// pictures.
[[nodiscard]] const cv::Mat& pictureOf(const ScannedView& view);

/// Where the newest body has a module's LED in a view; empty where it has none there.
[[nodiscard]] std::optional<OverlayModule> placeByBody(const Session& session, const std::string& view,
                                                       ModuleId module);

}  // namespace skincal
