#pragma once

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "core/geometry/se3.h"
#include "core/geometry/sentence.h"

namespace skincal {

enum class PixelState : unsigned char {
    Good,
    Saturated,  ///< `value` is a lower bound
    Excluded,
};

/// Weak beliefs about a spot's shape. They settle what a clipped spot leaves open and hardly touch its centre.
struct SpotPrior {
    double logWidth = 0.18;
    double logWidthSigma = 0.7;
    double halo = 0.03;
    double haloSigma = 0.05;
};

/// Light of one LED in a small window of the picture: what it adds while it is lit, grey levels.
struct SpotWindow {
    int x0 = 0;                ///< picture column of value(0, 0)
    int y0 = 0;                ///< picture row of value(0, 0)
    Eigen::ArrayXXd value;     ///< rows are picture rows
    Eigen::ArrayXXd variance;  ///< grey levels squared, > 0
    Eigen::Array<PixelState, Eigen::Dynamic, Eigen::Dynamic> state;
};

struct SpotFitOptions {
    SpotPrior prior{};
    double haloWidth = 2.5;     ///< halo's width over the core's
    double minWidth_px = 0.35;  ///< standard deviation of the core; below it is a hot pixel
    double maxWidth_px = 4.0;
    double minSignificance = 6;  ///< amplitude over its standard deviation; with a blind middle, light over a slope
    double narrow_px = 1.6;      ///< a spot no wider than this has the lens's shape; a wider one may have the LED's own
    double minExplained = 0.8;   ///< share of the light's variation that a spot of this shape must explain …
    double minExplainedNarrow = 0.92;  ///< … and must of a narrow one …
    double maxReducedChi2 = 4;         ///< … unless the misfit is no more than this many times the noise
    double sigmaFloor_px = 0.001;      ///< what no model of a lens gets right, added in quadrature
    int minPixels = 16;                ///< pixels that are not clipped

    [[nodiscard]] bool validate() const;
};

enum class SpotFitError {
    TooFewPixels,
    NoLight,        ///< nothing above the noise
    WrongShape,     ///< not a round spot, or far too wide or narrow
    OutsideWindow,  ///< the light comes from beyond the window's edge
};
[[nodiscard]] Sentence sentenceOf(SpotFitError error);

struct SpotFit {
    Vector2d centre = Vector2d::Zero();  ///< in the picture, px
    double sigma_px = 0;  ///< standard deviation of the centre, per axis; larger where the misfit exceeds the noise
    double width_px = 0;  ///< Gaussian sigma of the core
    double logWidthSigma = 0;  ///< standard deviation of its logarithm
    double amplitude = 0;      ///< of the core, grey levels; beyond 255 where the spot is clipped
    double chi2 = 0;           ///< per degree of freedom
    bool clipped = false;
    bool blind = false;  ///< of most of its middle nothing is known, only of its rim

    /// Light of the core, grey levels times pixels.
    [[nodiscard]] double flux() const;
};

/// How many of the pixels so near to a centre are excluded, 0 to 1.
[[nodiscard]] double blindShare(const SpotWindow& window, const Vector2d& centre, double radius_px);

/// Sub-pixel centre of an LED's light: maximum likelihood for a round Gaussian with a faint halo on a constant offset
/// (SpotModel), every pixel weighted with its own noise, clipped pixels as lower bounds. Six unknowns.
/// Degenerate cases are the errors of SpotFitError. Throws std::logic_error where the three arrays differ in size or
/// the options are not valid. Ref: Winick, J. Opt. Soc. Am. A 3, 1986 (bounds).
[[nodiscard]] tl::expected<SpotFit, SpotFitError> fitSpot(const SpotWindow& window, const SpotFitOptions& options = {});

}  // namespace skincal
