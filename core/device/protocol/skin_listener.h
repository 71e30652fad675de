#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/se3.h"

namespace skincal {

/// What a cell is called during one exploration: 1 to 65534. The next may number anew; the unique id stays.
using CellNumber = std::uint16_t;

/// A cell as it described itself.
struct NetworkCell {
    struct Heard {
        int port = 0;         ///< of this cell
        CellNumber cell = 0;  ///< 0: the computer
        int port_there = 0;
    };
    CellNumber number = 0;
    std::string uniqueId;  ///< 24 hexadecimal digits, lower case
    std::string type;      ///< name of its module template
    int ports = 0;
    std::uint32_t firmware = 0;
    std::vector<Heard> heard;
};

/// What an exploration found.
struct SkinNetwork {
    std::vector<NetworkCell> cells;   ///< by rising number
    std::vector<CellNumber> missing;  ///< numbered, but they did not describe themselves however often they were asked
};

/// Average of accelerometer readings of one cell.
struct RestReading {
    CellNumber cell = 0;
    std::uint32_t count = 0;
    Vector3d mean = Vector3d::Zero();      ///< specific force, module frame, m/s^2
    Vector3d variance = Vector3d::Zero();  ///< of one reading, (m/s^2)^2
    double temperature = 0;                ///< degrees Celsius
};

struct CellTouch {
    CellNumber cell = 0;
    float proximity = 0;                  ///< 0 nothing near, 1 touching
    std::array<float, 3> force{};         ///< N
    float temperature = 0;                ///< degrees Celsius
    std::array<float, 3> acceleration{};  ///< m/s^2, module frame
};

/// What went wrong with a skin at the other end of a line.
enum class SkinFault {
    NoAnswer,      ///< nothing came back at all
    Garbled,       ///< bytes came, none of them a frame: most likely another speed, or another device
    OtherVersion,  ///< it speaks another version of the protocol
    Stalled,       ///< it answered, but never finished what it was asked
    Silenced,      ///< it was there and no longer answers
};

/// Who wants to know what a SkinClient learns. All are called from inside SkinClient's functions; none may call them.
class SkinListener {
  public:
    virtual ~SkinListener() = default;
    using Time = std::chrono::microseconds;  ///< on the clock that the client is told the time of

    virtual void onOpened(const std::string& firmware) = 0;
    virtual void onFault(SkinFault fault) = 0;
    /// How many cells an exploration will describe.
    virtual void onCounted(std::size_t cells) = 0;
    virtual void onCell(const NetworkCell& cell) = 0;
    virtual void onExplored(const SkinNetwork& network) = 0;
    /// A cell lost power or crashed: numbers are void until the next exploration.
    virtual void onRestarted() = 0;
    /// All cells vouch for having shown it.
    virtual void onShown(std::uint64_t token) = 0;
    /// Some don't, or can't be reached.
    /// @param dark  those, each asked by itself
    virtual void onNotShown(std::uint64_t token, std::span<const CellNumber> dark) = 0;
    virtual void onAcceleration(const RestReading& reading, Time time) = 0;
    /// What measureRest() has come to.
    /// @param missing  those that did not answer
    virtual void onRest(std::span<const RestReading> readings, std::span<const CellNumber> missing) = 0;
    virtual void onTouch(std::span<const CellTouch> touches, Time time) = 0;
};

}  // namespace skincal
