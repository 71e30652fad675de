#pragma once

#include <functional>

#include "core/geometry/sentence.h"

namespace skincal {

/// How long work talks to whoever runs it. Core knows no threads: both functions are called on the worker's own
/// thread, and it is up to the caller to make them safe.
struct RunContext {
    /// True once the work should stop. Asked between steps that can't be broken off: at 1,000 modules and 30 views
    /// every 0.2 s and oftener, and in proportion at more (an iteration of the joint estimate over 10,000 takes a
    /// second).
    std::function<bool()> isCancelled = [] { return false; };
    /// Stage in plain words and the share of it that is done, 0 to 1.
    std::function<void(const Sentence& stage, double done)> report = [](const Sentence&, double) {};
};

}  // namespace skincal
