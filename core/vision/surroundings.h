#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vision/codebook.h"

namespace skincal {

/// What the surroundings of a spot do, at the exposure that is usual; nothing where `around` is empty, and in colours,
/// whose channels have surroundings of their own: in so few frames they would explain too much.
/// @param around  per plane, SpotBrightness::around
/// @param sigma   of the values that may follow them
[[nodiscard]] Ambient ambientOf(const Codebook& codebook, const Eigen::VectorXf& around, std::span<const double> gains,
                                double sigma);

/// The used planes without those in which a spot's surroundings are far from what they usually are: who walks past
/// leaves light there that no word explains. Lamps and neighbours change them all the time, other LEDs hardly.
/// @param around  per plane, SpotBrightness::around
[[nodiscard]] std::vector<std::uint8_t> calmPlanes(const Eigen::VectorXf& around, std::span<const double> gains,
                                                   std::span<const std::uint8_t> used);

}  // namespace skincal
