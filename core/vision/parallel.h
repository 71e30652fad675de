#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <opencv2/core/utility.hpp>

#include "core/geometry/run_context.h"

namespace skincal {

/// Calls `work` with 0 … count-1 on all processors, in any order. Between blocks the context is asked on this thread
/// whether to stop; returns false where it was.
inline bool forEach(std::size_t count, const RunContext& context, const std::function<void(std::size_t)>& work) {
    constexpr std::size_t kBlock = 1000;
    for (std::size_t first = 0; first < count; first += kBlock) {
        if (context.isCancelled())
            return false;
        const auto last = std::min(count, first + kBlock);
        cv::parallel_for_(cv::Range(static_cast<int>(first), static_cast<int>(last)), [&](const cv::Range& range) {
            for (int i = range.start; i < range.end; ++i)
                work(static_cast<std::size_t>(i));
        });
    }
    return true;
}

/// Calls `work` with bands of 0 … rows-1, from the first row to before the second, on all processors.
inline void forBands(int rows, const std::function<void(int, int)>& work) {
    cv::parallel_for_(
        cv::Range(0, rows), [&](const cv::Range& range) { work(range.start, range.end); }, cv::getNumThreads());
}

}  // namespace skincal
