#pragma once

#include <QString>
#include <memory>
#include <optional>
#include <tl/expected.hpp>

#include "core/device/line.h"

namespace skincal {

/// Where a skin is plugged in, as people write it:
///   /dev/ttyUSB0, ttyACM1, COM3, /dev/pts/4        a serial port, at 3 Mbaud
///   /dev/ttyUSB0@921600                            at another speed
///   tcp://gateway.local:5760                       a socket
///   exec:python3 bridge.py --robot left            a program that speaks the protocol on its input and output;
///                                                  quoted as in a shell
struct LineAddress {
    enum class Kind { Serial, Tcp, Program };
    static constexpr int kBaud = 3'000'000;

    Kind kind = Kind::Serial;
    QString target;  ///< port, host or command
    int number = 0;  ///< baud or TCP port
    QString text;    ///< as it was written

    friend bool operator==(const LineAddress&, const LineAddress&) = default;
};

/// The error says what was expected.
[[nodiscard]] tl::expected<LineAddress, QString> parseLineAddress(const QString& text);

[[nodiscard]] std::unique_ptr<Line> makeLine(const LineAddress& address);

/// What happened, in a sentence, and what to do about it: the very command where there is one.
[[nodiscard]] QString lineHelp(LineFault fault, const LineAddress& address, const QString& detail);

}  // namespace skincal
