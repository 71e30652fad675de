#pragma once

#include <array>
#include <cstdint>

namespace skincal {

using Rgb = std::array<std::uint8_t, 3>;

/// Viridis: brightness grows evenly with the value, so it can be read without seeing red and green, and in grey.
/// Less its darkest end in front of a dark background, less its lightest in front of a light one.
/// @param value  0 to 1, others count as the nearest of these.
[[nodiscard]] Rgb valueColour(double value, bool dark);

/// Blue below, pale yellow in the middle, red above: evenly bright to both sides, told apart without seeing red and
/// green, and no grey, which means unknown. ColorBrewer's RdYlBu (Harrower and Brewer).
/// @param value  0 to 1, the middle at 0.5; others count as the nearest of these.
[[nodiscard]] Rgb divergingColour(double value);

/// Of modules without a value.
[[nodiscard]] Rgb unknownColour(bool dark);

/// Between two colours, `share` of the second.
[[nodiscard]] Rgb mixed(const Rgb& a, const Rgb& b, double share);

/// From components in 0..1, such as patchColour's.
[[nodiscard]] Rgb toRgb(const std::array<double, 3>& colour);

}  // namespace skincal
