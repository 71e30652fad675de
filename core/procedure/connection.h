#pragma once

#include <cstddef>
#include <variant>
#include <vector>

#include "core/procedure/machine.h"

namespace skincal {

/// From no skin to one whose network is known. In Disconnected and Lost the last thing the device was told is to close
/// (or it was never told to open).
struct Connection {
    enum class Phase {
        Disconnected,
        Opening,    ///< the device was told to open
        Exploring,  ///< it is open and modules report
        Connected,  ///< the network is known
        Lost,       ///< it was there and is not any more, or never came: `fault` says
    };
    /// Why a skin was lost; the window has a sentence for each.
    enum class Fault {
        None,
        Failed,     ///< the device said so, in words of its own
        Closed,     ///< it went without a word
        NoAnswer,   ///< it did not open in time
        NoModules,  ///< it is open, but none reported
        Silent,     ///< the network went silent after `found` modules
    };
    Phase phase = Phase::Disconnected;
    std::size_t found = 0;      ///< modules that have reported
    Fault fault = Fault::None;  ///< in Phase::Lost

    friend bool operator==(const Connection&, const Connection&) = default;
};

namespace connection {

struct Connect {};     ///< the operator's; in Connected: explore again
struct Disconnect {};  ///< the operator's
struct Opened {};      ///< of the newest OpenDevice
struct Closed {};
struct Failed {};
struct ModuleFound {};
struct Explored {};
struct TimedOut {};  ///< nothing came for as long as StartTimer said

using Event = std::variant<Connect, Disconnect, Opened, Closed, Failed, ModuleFound, Explored, TimedOut>;

struct OpenDevice {
    friend bool operator==(const OpenDevice&, const OpenDevice&) = default;
};
struct CloseDevice {
    friend bool operator==(const CloseDevice&, const CloseDevice&) = default;
};
struct Explore {
    friend bool operator==(const Explore&, const Explore&) = default;
};

using Effect = std::variant<OpenDevice, CloseDevice, Explore, StartTimer, StopTimer>;

}  // namespace connection

[[nodiscard]] Stepped<Connection, connection::Effect> step(const Connection& state, const connection::Event& event);

}  // namespace skincal
