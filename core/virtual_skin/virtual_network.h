#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <queue>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/skin/skin.h"

namespace skincal {

/// What cells of a virtual skin feel.
class CellSenses {
  public:
    using Time = std::chrono::microseconds;

    struct Touch {
        double proximity = 0;           ///< 0 nothing near, 1 touching
        std::array<double, 3> force{};  ///< N
    };

    virtual ~CellSenses() = default;
    /// One reading: specific force in the cell's frame, m/s^2.
    virtual Vector3d acceleration(std::size_t cell, Time time) = 0;
    virtual double temperature(std::size_t cell, Time time) = 0;  ///< degrees Celsius
    virtual Touch touch(std::size_t cell, Time time) = 0;
};

/// A cell that a computer can be wired to: the skin's own host link's, else the first that has a port free. Nothing
/// where there is none.
[[nodiscard]] std::optional<HostLink> placeForComputer(const Skin& skin);

/// How bad wires are. On all links alike, that to the computer included.
struct WireFaults {
    double byteErrors = 0;  ///< share of bytes with a flipped bit
    double lostFrames = 0;  ///< share of frames of which nothing arrives
    std::chrono::microseconds latency{0};
    double bytesPerSecond = 300'000;  ///< 3 Mbaud with start and stop bits

    [[nodiscard]] bool validate() const {
        return byteErrors >= 0 && byteErrors < 1 && lostFrames >= 0 && lostFrames < 1 && latency.count() >= 0 &&
               bytesPerSecond > 0;
    }
};

/// Cells that are wired to each other, each running the reference firmware (resources/firmware), and wires that take
/// their time and make mistakes. Time is simulated: nothing happens but in run(). The same plan, faults and seed give
/// the same bytes at the same times.
class VirtualNetwork {
  public:
    using Time = std::chrono::microseconds;

    /// @param skin    links are wires; both ends of none may be used twice, else what comes on such a port mixes
    /// @param root    where the computer is wired to
    /// @param senses  must outlive this
    /// Throws std::logic_error where a module has more ports than the firmware was built for, the root is none or
    /// faults are out of range.
    VirtualNetwork(const Skin& skin, const HostLink& root, const WireFaults& faults, std::uint64_t seed,
                   CellSenses& senses);
    ~VirtualNetwork();
    VirtualNetwork(const VirtualNetwork&) = delete;
    VirtualNetwork& operator=(const VirtualNetwork&) = delete;

    /// Bytes that the computer sends, beginning now.
    void fromComputer(std::span<const std::uint8_t> bytes);
    /// Lets everything happen until then.
    void run(Time until);
    [[nodiscard]] Time now() const { return now_; }
    /// When something will happen next on its own.
    [[nodiscard]] std::optional<Time> next() const;
    /// What has arrived at the computer and was not taken yet.
    [[nodiscard]] std::vector<std::uint8_t> takeForComputer();

    [[nodiscard]] std::size_t cells() const;
    [[nodiscard]] std::string uniqueId(std::size_t cell) const;  ///< 24 hexadecimal digits
    /// Colour shown now, 0xRRGGBB.
    [[nodiscard]] std::uint32_t led(std::size_t cell) const;
    /// Called whenever an LED changes.
    void onLed(std::function<void(std::size_t cell, std::uint32_t colour, Time when)> what) {
        onLed_ = std::move(what);
    }

    void kill(std::size_t cell);
    /// Power comes back, or goes and comes: it knows nothing any more.
    void restart(std::size_t cell);
    /// Nothing passes between these ports from now on, either way.
    void cut(std::size_t cell, int port);

    /// Bytes that have been sent on any wire.
    [[nodiscard]] std::uint64_t bytesSent() const { return bytesSent_; }

  private:
    struct Cell;
    struct Event {
        Time time{};
        std::uint64_t order = 0;
        std::size_t cell = 0;
        int port = -1;  ///< where bytes arrive; -1: it asked to be woken
        std::vector<std::uint8_t> bytes;
    };
    struct Later {
        bool operator()(const Event& a, const Event& b) const {
            return a.time != b.time ? a.time > b.time : a.order > b.order;
        }
    };

    [[nodiscard]] std::uint32_t send(Cell& from, int port, std::span<const std::uint8_t> bytes);
    void boot(Cell& cell);
    void wakeAfter(Cell& cell, std::uint32_t wait);
    void spoil(std::vector<std::uint8_t>& bytes);
    [[nodiscard]] Time duration(std::size_t bytes) const;

    WireFaults faults_;
    CellSenses& senses_;
    std::mt19937_64 random_;
    std::vector<std::unique_ptr<Cell>> cells_;
    std::size_t root_ = 0;
    int rootPort_ = 0;
    Time now_{};
    Time computerFree_{};
    std::uint64_t order_ = 0;
    std::priority_queue<Event, std::vector<Event>, Later> events_;
    std::vector<std::uint8_t> toComputer_;
    std::function<void(std::size_t, std::uint32_t, Time)> onLed_;
    std::uint64_t bytesSent_ = 0;
    double untilError_ = 0;
};

}  // namespace skincal
