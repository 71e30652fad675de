#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vision/frame.h"

namespace skincal {

using LitSets = std::vector<std::vector<LitModule>>;

/// What to light, picture by picture, so that every module blinks a word of its own (codeWords): all off, all on, bit
/// after bit, then bit after bit of the complement, all on, all off: 4 + 2 n pictures, 28 for 200 modules, 42 for
/// 10,000. Every LED shines in half of them, and any two differ in at least six. Bits and their complements are far
/// apart, so that who hides an LED for up to n pictures hides no bit altogether. Both ends are alike: what moved in
/// between shows.
/// @param seed  which module gets which word: neighbours should not always have similar ones.
[[nodiscard]] LitSets codedScan(std::span<const ModuleId> modules, std::uint64_t seed);

}  // namespace skincal
