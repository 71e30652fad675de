#pragma once

#include <optional>

#include "core/vision/spot_scan.h"
#include "core/vision/word_match.h"

namespace skincal {

/// By how many pictures a camera is later than whoever took them believed: each picture then shows what was lit before
/// it, and words that are shifted alike can be those of other modules. Told by the pictures in which all LEDs are on,
/// or all off (codedScan has such at both ends): the spots that agree with them only so many pictures later must then
/// blink twice as many words, four at least, as spots do as they are.
/// @param scan    exposure levelled
/// @param inTime  words that spots blink as they are
/// @return one or two; nothing where pictures are in time, and where a book has no such pictures or is coloured
[[nodiscard]] std::optional<int> picturesLate(const SpotScan& scan, std::size_t inTime,
                                              const WordMatchOptions& options = {});

}  // namespace skincal
