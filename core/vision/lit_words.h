#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "core/geometry/sentence.h"
#include "core/vision/frame.h"

namespace skincal {

/// One grey picture out of a frame: the frame itself (channel -1: mean of its channels), or one channel (0 blue,
/// 1 green, 2 red) where LEDs were lit in colours.
struct Plane {
    std::size_t frame = 0;
    int channel = -1;
};

/// When each module was lit, over the planes of a view.
struct LitWords {
    std::vector<Plane> planes;                  ///< in the order of the frames
    std::vector<std::vector<std::size_t>> lit;  ///< per module, the planes in which it shines, ascending
    bool coloured = false;                      ///< three planes per frame

    [[nodiscard]] std::size_t planesPerFrame() const { return coloured ? 3 : 1; }
};

/// The words of `modules` over `frames`. Colours are told apart as soon as any module is lit in a colour other than
/// white. Fails with a sentence when a frame lights a module that is not among `modules`, or lights one twice, or a
/// colour is not made of zeros and ones.
[[nodiscard]] tl::expected<LitWords, Sentence> litWords(std::span<const ModuleId> modules,
                                                        std::span<const FrameInfo> frames);

}  // namespace skincal
