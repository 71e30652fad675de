#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>

#include "app/command_line.h"

namespace skincal {
namespace {

volatile std::sig_atomic_t interruptedFlag = 0;

}  // namespace

bool interrupted() {
    return interruptedFlag != 0;
}

struct TerminalProgress::Shown {
    using Clock = std::chrono::steady_clock;
    Clock::time_point start = Clock::now();
    Clock::time_point last = start;
    bool terminal = ::isatty(STDERR_FILENO) != 0;
    bool any = false;
};

TerminalProgress::TerminalProgress() : shown_(std::make_unique<Shown>()) {
    std::signal(SIGINT, [](int) { interruptedFlag = 1; });
}

TerminalProgress::~TerminalProgress() {
    if (shown_->any)
        fmt::print(stderr, "\r\033[K");
    std::signal(SIGINT, SIG_DFL);
}

RunContext TerminalProgress::context() {
    RunContext context;
    context.isCancelled = interrupted;
    context.report = [shown = shown_.get()](const Sentence& stage, double done) {
        using namespace std::chrono_literals;
        const auto now = Shown::Clock::now();
        if (!shown->terminal || now - shown->start < 1s || now - shown->last < 100ms)
            return;
        shown->last = now;
        shown->any = true;
        fmt::print(stderr, "\r\033[K{:>3.0f} %  {}", 100 * done, stage);
        std::fflush(stderr);
    };
    return context;
}

}  // namespace skincal
