#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vision/frame.h"

namespace skincal {

using LitSets = std::vector<std::vector<LitModule>>;

/// What to light, picture by picture, so that every module blinks a word of its own: all off, all on, bit after bit and
/// its complement, all off. Words differ in at least two bits, none is all on or all off; as few bits as that takes.
/// @param seed  which module gets which word: neighbours should not always have similar ones.
[[nodiscard]] LitSets codedScan(std::span<const ModuleId> modules, std::uint64_t seed);

}  // namespace skincal
