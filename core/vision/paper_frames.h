#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/vision/frame.h"

namespace skincal {

/// A frame with LEDs lit, and the background to subtract from it.
struct FramePair {
    std::size_t foreground = 0;
    std::size_t background = 0;
};

/// For each frame the background (nothing lit) that is nearest to it in time, itself excepted: of the last one before
/// and the first one after it, the one at the smaller distance in FrameInfo::time_s where all three carry a time, else
/// in the order of the frames; of equals the earlier one. Nothing where there is no other background.
/// @param frames  in the order in which they were taken. Linear in their number.
[[nodiscard]] std::vector<std::optional<std::size_t>> nearestBackgrounds(std::span<const FrameInfo> frames);

/// Frames that show the same, as far as the paper's detector is concerned.
struct PaperGroup {
    std::vector<LitModule> lit;      ///< by module; a single one, in white, unless `coloured`
    bool coloured = false;           ///< every LED has a colour of its own, which tells which one it is
    std::vector<FramePair> pairs{};  ///< in the order of the frames; none where the view has no background
};

/// What the paper's detector can use of a view: frames in which one module shines alone in white, grouped by module,
/// and frames whose LEDs shine in colours that are pairwise distinct, none of them black, at most `nativeColours` at
/// once, grouped by equal lit sets. A module lit without a colour is lit in white. Groups come in the order of their
/// first frame; frames of any other kind are in none.
[[nodiscard]] std::vector<PaperGroup> paperGroups(std::span<const FrameInfo> frames, std::size_t nativeColours);

[[nodiscard]] std::array<int, 3> colourOf(const LitModule& lit);  ///< white where none is given
[[nodiscard]] bool isBlack(const std::array<int, 3>& colour);
[[nodiscard]] bool isWhite(const std::array<int, 3>& colour);

}  // namespace skincal
