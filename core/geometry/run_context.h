#pragma once

#include <functional>
#include <string_view>

namespace skincal {

/// How long work talks to whoever runs it. Core knows no threads: both functions are called on the worker's own
/// thread, and it is up to the caller to make them safe.
struct RunContext {
    /// True once the work should stop; polled at least every 100 ms.
    std::function<bool()> isCancelled = [] { return false; };
    /// Stage in plain words and the share of it that is done, 0 to 1.
    std::function<void(std::string_view stage, double done)> report = [](std::string_view, double) {};
};

}  // namespace skincal
