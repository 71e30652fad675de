#pragma once

#include <tl/expected.hpp>

#include "core/adjustment/pixel_prediction.h"
#include "core/estimation/body_solution.h"

namespace skincal {

struct SpotOptions {
    /// Standard deviations within which a spot lies where the body has the LED: by chance one LED of 3,000 does not.
    double fits = 4;
    double others = 10;              ///< standard deviations beyond which every other spot must lie
    double maxSigma_px = 5;          ///< a body that tells the pixel less exactly (worst direction) does not choose …
    double maxSigmaAlone_px = 2;     ///< … nor where there is a single spot, which nothing else speaks against
    double maxAngle = 85 * kDegree;  ///< between an LED's axis and the ray to the camera
    int maxRounds = 3;               ///< each choice makes the body more exact, and others possible

    [[nodiscard]] bool validate() const {
        return fits > 0 && others > fits && maxSigma_px > 0 && maxSigmaAlone_px > 0 && maxAngle > 0 && maxRounds >= 0;
    }
};

/// Settles which of several spots that blink a module's word in a view is its LED (Undetected::spots), by where all
/// other data have it. With prediction p of covariance P (predictPixels: module and view together, for a module that no
/// picture shows from links and gravity alone), spot z_i of standard deviation s_i by the solution's weights:
///   d_i^2 = (z_i - p)^T (P + s_i^2 I)^-1 (z_i - p)
/// A single spot, of which the decoder says that it may be a reflection, is taken likewise where the body tells the
/// pixel to `maxSigmaAlone_px`. The spot is taken whose d_i is within `fits` where all others are beyond `others`; the
/// difference in -log L is then at least 42, three times what decides between places of a view (view_hypotheses). It
/// counts from there on as a detection like any other. Where none fits, or more than one, where the body is not known
/// well enough, where view or module have no pose or the view may stand elsewhere, none is taken. Spots already taken
/// are not asked again. Every case has its verdict with the reason in `solution.estimate.spots`.
/// @return how many were taken: solve again, then dropRejectedSpots(). Fails with Cancelled; where the data do not fix
/// all unknowns nothing is taken.
/// Ref: for the gate, Bar-Shalom and Fortmann, Tracking and Data Association, 1988.
[[nodiscard]] tl::expected<std::size_t, CalibrationError> settleSpots(BodySolution& solution,
                                                                      const SpotOptions& options = {},
                                                                      const RunContext& context = {});

/// From here on the spot counts as a detection like any other.
void takeSpot(BodySolution& solution, const LedInView& led, const SpotChoice& spot, const Sentence& reason);

/// Spots that were taken and have been rejected or set aside since, or whose view or module has no pose, count as open
/// again.
void dropRejectedSpots(BodySolution& solution);

/// Detections that were taken from spots before, put back after `solution.input.pixels` was filled anew from
/// measurements that may have changed: those whose spot is still there.
void restoreSpots(BodySolution& solution);

}  // namespace skincal
