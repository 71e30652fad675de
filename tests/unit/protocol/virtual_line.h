#pragma once

#include <map>
#include <memory>

#include "core/device/protocol/skin_client.h"
#include "core/virtual_skin/virtual_network.h"

namespace skincal {

/// Rectangles in rows and columns, each linked to its neighbours; the computer goes to the first's left.
inline Skin gridSkin(std::size_t columns, std::size_t rows) {
    Skin skin;
    skin.templates.push_back(rectangleTemplate());
    const auto id = [&](std::size_t column, std::size_t row) {
        return ModuleId(static_cast<std::uint32_t>(row * columns + column + 1));
    };
    // Ports of two that face each other point in opposite directions.
    const std::vector<Vector3d>& ports = skin.templates.front().ports;
    const auto facing = [&](const Vector3d& direction) {
        const auto along = [&](const Vector3d& a, const Vector3d& b) { return a.dot(direction) < b.dot(direction); };
        return static_cast<int>(std::max_element(ports.begin(), ports.end(), along) - ports.begin());
    };
    const Vector3d x = Vector3d::UnitX();
    const Vector3d y = Vector3d::UnitY();
    for (std::size_t row = 0; row < rows; ++row)
        for (std::size_t column = 0; column < columns; ++column) {
            skin.modules.push_back({id(column, row), 0});
            if (column > 0)
                skin.links.push_back({id(column - 1, row), facing(x), id(column, row), facing(-x)});
            if (row > 0)
                skin.links.push_back({id(column, row - 1), facing(y), id(column, row), facing(-y)});
        }
    skin.hostLinks.push_back({id(0, 0), facing(-x)});
    return skin;
}

/// Cells on a desk: gravity along their z, and something that touches some of them.
class Desk : public CellSenses {
  public:
    Vector3d acceleration(std::size_t cell, Time) override { return {0.001 * static_cast<double>(cell), 0, 9.81}; }
    double temperature(std::size_t, Time) override { return 25; }
    /// Every other cell, that is.
    Touch touch(std::size_t cell, Time) override { return cell % 2 == 0 ? Touch{0.5, {1, 0, 0}} : Touch{}; }
};

/// Keeps what a client tells.
class Notes : public SkinListener {
  public:
    void onOpened(const std::string& firmware) override { opened = firmware; }
    void onFault(SkinFault what) override { fault = what; }
    void onCounted(std::size_t n) override { counted = n; }
    void onCell(const NetworkCell&) override { ++found; }
    void onExplored(const SkinNetwork& what) override { network = what; }
    void onRestarted() override { ++restarts; }
    void onShown(std::uint64_t token) override { shown = token; }
    void onNotShown(std::uint64_t token, std::span<const CellNumber> dark) override {
        notShown[token].assign(dark.begin(), dark.end());
    }
    void onAcceleration(const RestReading& reading, Time) override { streamed.push_back(reading); }
    void onRest(std::span<const RestReading> readings, std::span<const CellNumber> without) override {
        rest.assign(readings.begin(), readings.end());
        restMissing.assign(without.begin(), without.end());
        restCame = true;
    }
    void onTouch(std::span<const CellTouch> some, Time) override {
        touches.insert(touches.end(), some.begin(), some.end());
    }

    std::optional<std::string> opened;
    std::optional<SkinFault> fault;
    std::size_t counted = 0;
    std::size_t found = 0;
    std::optional<SkinNetwork> network;
    int restarts = 0;
    std::optional<std::uint64_t> shown;
    std::map<std::uint64_t, std::vector<CellNumber>> notShown;
    std::vector<RestReading> streamed;
    std::vector<RestReading> rest;
    std::vector<CellNumber> restMissing;
    bool restCame = false;
    std::vector<CellTouch> touches;
};

/// A client and a virtual skin on one line, in simulated time.
class VirtualLine {
  public:
    using Time = std::chrono::microseconds;

    VirtualLine(const Skin& skin, const HostLink& root, const WireFaults& faults, std::uint64_t seed)
        : network(skin, root, faults, seed, desk),
          client(notes, linkOptions(faults), static_cast<std::uint32_t>(seed)) {}

    /// Opens and explores. Returns whether the network is known within so long.
    bool connect(Time atMost = std::chrono::seconds(60)) {
        client.open(network.now());
        if (!runUntil([&] { return notes.opened.has_value() || notes.fault; }, atMost) || notes.fault)
            return false;
        return explore(atMost);
    }
    /// Anew where cells say meanwhile that they have just booted.
    bool explore(Time atMost = std::chrono::seconds(60)) {
        for (int again = 0; again < 5; ++again) {
            notes.network.reset();
            notes.restarts = 0;
            client.explore(network.now());
            if (!runUntil([&] { return notes.network || notes.fault || notes.restarts > 0; }, atMost) || notes.fault)
                return false;
            if (notes.restarts == 0)
                return true;
        }
        return false;
    }

    /// Until `done`, for so long at most. Returns whether it was done.
    template <class Done>
    bool runUntil(Done done, Time atMost) {
        const Time end = network.now() + atMost;
        std::vector<std::uint8_t> bytes;
        while (!done()) {
            bytes.clear();
            client.poll(network.now(), bytes);
            network.fromComputer(bytes);
            sent += bytes.size();
            Time next = end;
            if (const auto wake = client.wakeAt())
                next = std::min(next, *wake);
            if (const auto wake = network.next())
                next = std::min(next, *wake);
            if (network.now() >= end)
                return false;
            network.run(std::max(next, network.now() + Time(1)));
            const auto received = network.takeForComputer();
            client.receive(received, network.now());
        }
        return true;
    }
    void runFor(Time time) {
        runUntil([] { return false; }, time);
    }

    static ReliableLinkOptions linkOptions(const WireFaults& faults) {
        ReliableLinkOptions options;
        options.bytesPerSecond = faults.bytesPerSecond;
        options.timeout = Time(5000) + 2 * faults.latency;
        return options;
    }

    Desk desk;
    Notes notes;
    VirtualNetwork network;
    SkinClient client;
    std::uint64_t sent = 0;
};

}  // namespace skincal
