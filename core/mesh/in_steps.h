#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/geometry/run_context.h"

namespace skincal {

/// So many triangles, corners or edges between two asks whether to stop: a millisecond or two.
inline constexpr std::size_t kAskEvery = 4096;

/// work(i) for every i below `count`, in order. False where it was cancelled on the way.
template <class Work>
bool forEachInSteps(std::size_t count, const RunContext& context, const Work& work) {
    for (std::size_t begin = 0; begin < count; begin += kAskEvery) {
        if (context.isCancelled())
            return false;
        for (std::size_t i = begin; i < std::min(begin + kAskEvery, count); ++i)
            work(i);
    }
    return true;
}

/// Sorts a million of something: runs of some thousand, then ever longer ones merged. False where it was cancelled on
/// the way, in any order then.
template <class T, class Before>
bool sortInSteps(std::vector<T>& values, const RunContext& context, const Before& before) {
    const auto at = [&](std::size_t i) {
        return values.begin() + static_cast<std::ptrdiff_t>(std::min(i, values.size()));
    };
    for (std::size_t begin = 0; begin < values.size(); begin += kAskEvery) {
        if (context.isCancelled())
            return false;
        std::sort(at(begin), at(begin + kAskEvery), before);
    }
    for (std::size_t run = kAskEvery; run < values.size(); run *= 2) {
        for (std::size_t begin = 0; begin + run < values.size(); begin += 2 * run) {
            if (context.isCancelled())
                return false;
            std::inplace_merge(at(begin), at(begin + run), at(begin + 2 * run), before);
        }
    }
    return true;
}

}  // namespace skincal
