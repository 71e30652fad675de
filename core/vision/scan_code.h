#pragma once

#include <cstdint>
#include <span>

#include "core/vision/coded_scan.h"

namespace skincal {

/// How a scan tells modules apart. The decoder takes the words from what was lit, whichever it was.
enum class ScanCode {
    Words,       ///< every module blinks a word of its own: 4 + 2 log2 N pictures, about (codedScan)
    OneAtATime,  ///< each LED alone between backgrounds, as in the paper: 2 N + 3 pictures
    Colours,     ///< up to seven LEDs at once, each in a colour, as in the paper: 2 N / 7 + 6 pictures, in colour
};

/// Background, LED, background, LED, …, background, as in the paper.
/// @param repeats  pictures of each LED, with a background each
[[nodiscard]] LitSets oneAtATimeScan(std::span<const ModuleId> modules, int repeats = 1);

/// Between backgrounds up to seven LEDs at once, in red, green, blue, yellow, cyan, magenta and white, as in the paper.
[[nodiscard]] LitSets colouredScan(std::span<const ModuleId> modules);

/// A scan to be taken of a real skin. All begin with a dark picture and one of all LEDs, so that light can be timed
/// (ScanRun); in colours, one of all LEDs in each of red, green and blue follows, which tell how those look to the
/// camera (ColourMixing).
/// @param seed  of the words, where there are any
[[nodiscard]] LitSets scanOf(ScanCode code, std::span<const ModuleId> modules, std::uint64_t seed);

}  // namespace skincal
