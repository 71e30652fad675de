#pragma once

#include <QCoreApplication>
#include <array>
#include <csignal>

#include "app/command_line.h"

namespace skincal {

/// What Qt wants to know of a program's arguments; the program has read them itself.
struct NoArguments {
    int count = 1;
    std::array<char, 8> name{"skincal"};
    std::array<char*, 2> values{name.data(), nullptr};
};

/// Qt's event loop for a command without a window. Ctrl-C and SIGTERM end it: exec() returns kDataDoNotSuffice.
template <class Application>
class CommandApplication : private NoArguments, public Application {
  public:
    CommandApplication() : Application(count, values.data()) {
        for (const int signal : {SIGINT, SIGTERM})
            std::signal(signal, [](int) { QCoreApplication::exit(kDataDoNotSuffice); });
    }
};

}  // namespace skincal
