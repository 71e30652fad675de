#pragma once

#include <cstddef>
#include <optional>

#include "core/geometry/se3.h"
#include "core/geometry/sentence.h"

namespace skincal {

/// What became of a module for which several spots of a view blink (Undetected::spots).
struct SpotVerdict {
    std::size_t view = 0;
    std::size_t module = 0;
    std::optional<std::size_t> pixel{};  ///< entry of AdjustmentInput::pixels; nothing where none was taken
    std::optional<Vector2d> spot{};      ///< which of them that is
    Sentence reason;                     ///< of either
};

}  // namespace skincal
