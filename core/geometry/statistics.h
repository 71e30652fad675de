#pragma once

#include <vector>

namespace skincal {

/// Median of `values` in linear time on average: the middle one in their order, or the mean of the two in the middle
/// where their count is even. Fewer than half of the values can never move it out of the range of the others.
/// The values are reordered: move a vector that is no longer needed, else a copy is made.
/// @param values  at least one, no NaN (which has no place in the order)
/// Throws std::logic_error where there is none.
[[nodiscard]] double median(std::vector<double> values);

}  // namespace skincal
