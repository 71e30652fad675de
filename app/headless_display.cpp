#include "app/headless_display.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <string>

extern char** environ;

namespace skincal {

HeadlessDisplay::HeadlessDisplay() {
    if (std::getenv("DISPLAY") != nullptr)
        return;
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0)
        return;
    // The server writes the display it chose to descriptor 3 once it is ready.
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, pipe[1], 3);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::array<std::string, 8> words{"Xvfb", "-displayfd", "3", "-screen", "0", "1280x1024x24", "-nolisten", "tcp"};
    std::array<char*, 9> arguments{};
    for (std::size_t i = 0; i < words.size(); ++i)
        arguments.at(i) = words.at(i).data();
    const int failed = ::posix_spawnp(&server_, "Xvfb", &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(pipe[1]);
    if (failed != 0)
        server_ = -1;

    std::string display;
    constexpr int kPatience_ms = 10'000;
    pollfd ready{pipe[0], POLLIN, 0};
    while (server_ > 0 && display.find('\n') == std::string::npos && ::poll(&ready, 1, kPatience_ms) > 0) {
        std::array<char, 32> buffer{};
        const ssize_t n = ::read(pipe[0], buffer.data(), buffer.size());
        if (n <= 0)
            break;
        display.append(buffer.data(), static_cast<std::size_t>(n));
    }
    ::close(pipe[0]);
    if (display.find('\n') != std::string::npos)
        ::setenv("DISPLAY", (":" + display.substr(0, display.find('\n'))).c_str(), 1);
}

HeadlessDisplay::~HeadlessDisplay() {
    if (server_ <= 0)
        return;
    ::kill(server_, SIGTERM);
    ::waitpid(server_, nullptr, 0);
    ::unsetenv("DISPLAY");
}

}  // namespace skincal
