#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "core/simulation/world.h"
#include "core/vision/detection.h"

namespace skincal {

/// What came out, of one view or the sum over many.
struct ScanScore {
    std::size_t views = 0;
    std::size_t refused = 0;  ///< of these, in which the decoder refused the pictures of a look: it adds nothing
    std::size_t frames = 0;
    std::size_t visible = 0;   ///< modules that face the camera, in the picture and not hidden by the body
    std::size_t found = 0;     ///< of these, where they are
    std::size_t choices = 0;   ///< of these, not found, but among the spots that were handed on to choose from
    std::size_t settled = 0;   ///< visible, and taken from such spots by the body, which are then none to choose from
    std::size_t wrong = 0;     ///< modules that were found, or taken by the body, more than `kElsewhere_px` off, nearer
                               ///< to another module's LED than to their own, or although the camera sees no light of
                               ///< theirs
    double squaredError = 0;   ///< px^2, sum over found and both axes
    double squaredSigmas = 0;  ///< the same in units of the reported standard deviation
    std::size_t sharp = 0;     ///< of the found, those that are not clipped and that centreBounds has a bound of
    double squaredBounds = 0;  ///< of these, squared error over the squared bound, sum over both axes
    double sharpSigmas = 0;    ///< of these, the part of squaredSigmas
    double seconds = 0;        ///< that decoding took after the last picture

    static constexpr double kElsewhere_px = 3;
    /// By the picture or the body.
    [[nodiscard]] double foundShare() const;
    [[nodiscard]] double rms_px() const;     ///< per axis
    [[nodiscard]] double rmsSigmas() const;  ///< per axis; one where the standard deviations are right
    [[nodiscard]] double rmsBounds() const;  ///< per axis; one where no unbiased estimate could be better
    void add(const ScanScore& other);
};

/// Of one view: of what a decoder makes of kScanView of scanWorld.
/// @param taken   by the body of what the view left to choose from (spotsTakenByBody)
/// @param bounds  of the centres (centreBounds), per module; empty where there are none
[[nodiscard]] ScanScore scoreOf(const World& world, const ViewDetections& view, std::span<const LedDetection> taken,
                                std::span<const std::optional<double>> bounds);

}  // namespace skincal
