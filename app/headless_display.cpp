#include "app/headless_display.h"

#include <X11/Xlib.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>

namespace skincal {
namespace {

std::string displayName() {
    const char* name = std::getenv("DISPLAY");
    return name == nullptr ? "" : name;
}

/// A name alone says nothing: it may be left over from a session that has ended.
bool canDraw(const std::string& name) {
    if (name.empty())
        return false;
    Display* display = ::XOpenDisplay(name.c_str());
    if (display == nullptr)
        return false;
    int code = 0;
    int event = 0;
    int error = 0;
    const bool drawsIn3d = ::XQueryExtension(display, "GLX", &code, &event, &error) != 0;
    ::XCloseDisplay(display);
    return drawsIn3d;
}

/// In the child: becomes Xvfb, which writes the display it chose to descriptor 3 once it is ready. Never returns.
[[noreturn]] void becomeServer(int ready, pid_t parent) {
    // Killed with us, even by SIGKILL; unless we died before this line.
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent)
        ::_exit(1);
    constexpr int kReady = 3;
    if (ready == kReady)
        ::fcntl(ready, F_SETFD, 0);  // dup2 to itself would leave it to be closed
    else
        ::dup2(ready, kReady);
    const int null = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
    ::dup2(null, STDOUT_FILENO);
    ::dup2(null, STDERR_FILENO);
    // Not to reset when the first client leaves: the one that asks whether it can draw leaves just before the one that
    // does.
    ::execlp("Xvfb", "Xvfb", "-displayfd", "3", "-screen", "0", "1280x1024x24", "-nolisten", "tcp", "-noreset",
             nullptr);
    ::_exit(127);
}

/// What the server says within ten seconds, up to the end of the line; empty where it says nothing.
std::string readLine(int descriptor) {
    std::string line;
    constexpr int kPatience_ms = 10'000;
    pollfd ready{descriptor, POLLIN, 0};
    while (line.find('\n') == std::string::npos) {
        std::array<char, 32> buffer{};
        const ssize_t n = ::poll(&ready, 1, kPatience_ms) > 0 ? ::read(descriptor, buffer.data(), buffer.size()) : 0;
        if (n <= 0)
            return {};
        line.append(buffer.data(), static_cast<std::size_t>(n));
    }
    return line.substr(0, line.find('\n'));
}

}  // namespace

HeadlessDisplay::HeadlessDisplay() : before_(displayName()) {
    if (canDraw(before_))
        return;
    std::array<int, 2> pipe{};
    std::string number;
    if (::pipe2(pipe.data(), O_CLOEXEC) == 0) {
        const pid_t self = ::getpid();
        server_ = ::fork();
        if (server_ == 0)
            becomeServer(pipe[1], self);
        ::close(pipe[1]);
        if (server_ > 0)
            number = readLine(pipe[0]);
        ::close(pipe[0]);
    }
    if (!number.empty() && canDraw(":" + number)) {
        ::setenv("DISPLAY", (":" + number).c_str(), 1);
        return;
    }
    stop();
    complaint_ =
        before_.empty() ? "there is no X display to draw with" : "the X display '" + before_ + "' can't be used";
    complaint_ += ", and Xvfb could not be started: install xvfb, or set DISPLAY";
}

HeadlessDisplay::~HeadlessDisplay() {
    if (server_ <= 0)
        return;
    stop();
    if (before_.empty())
        ::unsetenv("DISPLAY");
    else
        ::setenv("DISPLAY", before_.c_str(), 1);
}

void HeadlessDisplay::stop() {
    if (server_ <= 0)
        return;
    ::kill(server_, SIGTERM);
    ::waitpid(server_, nullptr, 0);
    server_ = -1;
}

}  // namespace skincal
