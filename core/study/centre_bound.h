#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/simulation/renderer.h"
#include "core/vision/frame.h"

namespace skincal {

/// Cramer-Rao bound of the centre of each LED of a scan in simulated pictures, px per axis (the mean of both).
///   I = sum over pixels p of g_p g_p^T / (v_p,lit / n_lit + v_p,dark / n_dark),   bound^2 = tr(I^-1) / 2
/// with g_p the slope of the LED's light against its centre, n frames with it lit and without, and v_p the noise that
/// the sensor has at the grey level there, rounding included. Of each pixel's ground nothing is known beforehand. Shape
/// and brightness of a round spot tell nothing of its centre, nor it of them: that they are unknown costs nothing.
/// Light of neighbours adds its noise, but counts as known. Where a pixel is black its noise is taken as if values
/// below zero were read out, too: clipping takes information away, and the bound without it is no higher. Nothing where
/// the LED is clipped, or never lit, never dark, or hardly seen.
/// @param pictures  8-bit grey, one per frame; each is taken for what its LEDs make of a room that stays as it is
/// Ref: Kay, Fundamentals of Statistical Signal Processing I, 1993; Winick, J. Opt. Soc. Am. A 3, 1986.
[[nodiscard]] std::vector<std::optional<double>> centreBounds(const World& world, std::span<const LedSpot> spots,
                                                              std::span<const FrameInfo> frames,
                                                              std::span<const cv::Mat> pictures);

}  // namespace skincal
