#pragma once

#include "core/vision/codebook.h"
#include "core/vision/coded_scan.h"

namespace skincal::testing {

/// A coded scan as frames.
inline std::vector<FrameInfo> codedFrames(std::span<const ModuleId> modules, std::uint64_t seed) {
    std::vector<FrameInfo> frames;
    for (auto& lit : codedScan(modules, seed))
        frames.push_back({{}, std::move(lit), {}, 0});
    return frames;
}

/// The words that a scan of so many modules lights.
inline Codebook codedBook(std::size_t count, std::uint64_t seed) {
    std::vector<ModuleId> modules;
    for (std::size_t u = 0; u < count; ++u)
        modules.emplace_back(static_cast<std::uint32_t>(10 + u));
    return makeCodebook(litWords(modules, codedFrames(modules, seed)).value());
}

}  // namespace skincal::testing
