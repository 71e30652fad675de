#include "core/virtual_skin/virtual_network.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "resources/firmware/skin_cell.h"

namespace skincal {

struct VirtualNetwork::Cell {
    struct Wire {
        std::size_t cell = 0;
        int port = 0;
    };
    static constexpr std::size_t kComputer = static_cast<std::size_t>(-1);

    VirtualNetwork* network = nullptr;
    std::size_t index = 0;
    int ports = 0;
    bool alive = true;
    std::array<std::optional<Wire>, SKIN_MAX_PORTS> wires;
    std::uint32_t clockOffset = 0;  ///< clocks of cells start when they get power
    std::uint32_t colour = 0;
    Time wakeAt = Time::max();
    skin_board board{};
    skin_identity identity{};
    skin_cell cell{};

    static Cell& of(void* context) { return *static_cast<Cell*>(context); }
};

namespace {

std::uint16_t toU16(double value) {
    return static_cast<std::uint16_t>(std::clamp(value, 0.0, 65535.0));
}

}  // namespace

std::optional<HostLink> placeForComputer(const Skin& skin) {
    if (!skin.hostLinks.empty())
        return skin.hostLinks.front();
    std::set<std::pair<ModuleId, int>> taken;
    for (const Link& link : skin.links) {
        taken.emplace(link.a, link.a_port);
        taken.emplace(link.b, link.b_port);
    }
    for (std::size_t i = 0; i < skin.modules.size(); ++i)
        for (int port = 0; port < static_cast<int>(skin.templateOf(i).ports.size()); ++port)
            if (!taken.contains({skin.modules[i].id, port}))
                return HostLink{skin.modules[i].id, port};
    return std::nullopt;
}

VirtualNetwork::VirtualNetwork(const Skin& skin, const HostLink& root, const WireFaults& faults, std::uint64_t seed,
                               CellSenses& senses)
    : faults_(faults), senses_(senses), random_(seed), rootPort_(root.port) {
    const auto index = skin.indexById();
    if (!faults.validate() || !index.contains(root.module))
        throw std::logic_error("faults or root out of range");
    root_ = index.at(root.module);
    if (root.port < 0 || root.port >= static_cast<int>(skin.templateOf(root_).ports.size()))
        throw std::logic_error("the root has no such port");
    untilError_ = faults_.byteErrors > 0 ? std::geometric_distribution<int>(faults_.byteErrors)(random_) : 0;
    for (std::size_t i = 0; i < skin.modules.size(); ++i) {
        cells_.push_back(std::make_unique<Cell>());
        Cell& cell = *cells_.back();
        cell.network = this;
        cell.index = i;
        cell.ports = static_cast<int>(skin.templateOf(i).ports.size());
        if (cell.ports > SKIN_MAX_PORTS)
            throw std::logic_error("a module has more ports than the firmware was built for");
        for (std::uint8_t& byte : cell.identity.unique_id)
            byte = static_cast<std::uint8_t>(random_());
        skin.templateOf(i).name.copy(cell.identity.type, sizeof cell.identity.type - 1);
        std::string_view("virtual cell").copy(cell.identity.name, sizeof cell.identity.name - 1);
        cell.identity.firmware = 1;
        cell.identity.schema = SKINCAL_SCHEMA_HASH;
    }
    for (const Link& link : skin.links) {
        const std::size_t a = index.at(link.a);
        const std::size_t b = index.at(link.b);
        cells_[a]->wires[static_cast<std::size_t>(link.a_port)] = Cell::Wire{b, link.b_port};
        cells_[b]->wires[static_cast<std::size_t>(link.b_port)] = Cell::Wire{a, link.a_port};
    }
    cells_[root_]->wires[static_cast<std::size_t>(rootPort_)] = Cell::Wire{Cell::kComputer, 0};
    for (const auto& cell : cells_)
        boot(*cell);
}

VirtualNetwork::~VirtualNetwork() = default;

void VirtualNetwork::boot(Cell& cell) {
    cell.alive = true;
    cell.clockOffset = static_cast<std::uint32_t>(random_());
    cell.board.context = &cell;
    cell.board.byte_ns = static_cast<std::uint32_t>(1e9 / faults_.bytesPerSecond);
    cell.board.now_us = [](void* context) {
        const Cell& self = Cell::of(context);
        return static_cast<std::uint32_t>(self.network->now_.count()) + self.clockOffset;
    };
    cell.board.send = [](void* context, int port, const std::uint8_t* bytes, std::size_t count) {
        Cell& self = Cell::of(context);
        return self.network->send(self, port, {bytes, count});
    };
    cell.board.led = [](void* context, std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
        Cell& self = Cell::of(context);
        const std::uint32_t colour =
            static_cast<std::uint32_t>(red) << 16 | static_cast<std::uint32_t>(green) << 8 | blue;
        if (std::exchange(self.colour, colour) != colour && self.network->onLed_)
            self.network->onLed_(self.index, colour, self.network->now_);
    };
    cell.board.acceleration = [](void* context, float xyz[3]) {
        const Cell& self = Cell::of(context);
        const Vector3d reading = self.network->senses_.acceleration(self.index, self.network->now_);
        for (int i = 0; i < 3; ++i)
            xyz[i] = static_cast<float>(reading[i]);
    };
    cell.board.temperature = [](void* context) {
        const Cell& self = Cell::of(context);
        return static_cast<float>(self.network->senses_.temperature(self.index, self.network->now_));
    };
    cell.board.tactile = [](void* context, std::uint16_t* proximity, std::uint16_t force_mN[3]) {
        const Cell& self = Cell::of(context);
        const CellSenses::Touch touch = self.network->senses_.touch(self.index, self.network->now_);
        *proximity = toU16(touch.proximity * 65535);
        for (std::size_t i = 0; i < 3; ++i)
            force_mN[i] = toU16(touch.force[i] * 1000);
    };
    // Three of the longest frames, an acknowledgement and the way there and back.
    const auto timeout = duration(3 * SKIN_MAX_ENCODED) + 2 * faults_.latency + Time(1000);
    skin_cell_init(&cell.cell, &cell.board, &cell.identity, cell.ports, static_cast<std::uint32_t>(timeout.count()),
                   static_cast<std::uint32_t>(random_()));
    cell.wakeAt = Time::max();
    wakeAfter(cell, 0);
}

VirtualNetwork::Time VirtualNetwork::duration(std::size_t bytes) const {
    return Time(static_cast<Time::rep>(std::ceil(1e6 * static_cast<double>(bytes) / faults_.bytesPerSecond)));
}

void VirtualNetwork::spoil(std::vector<std::uint8_t>& bytes) {
    if (faults_.byteErrors <= 0)
        return;
    std::geometric_distribution<int> gap(faults_.byteErrors);
    while (untilError_ < static_cast<double>(bytes.size())) {
        bytes[static_cast<std::size_t>(untilError_)] ^= static_cast<std::uint8_t>(1U << (random_() & 7));
        untilError_ += 1 + gap(random_);
    }
    untilError_ -= static_cast<double>(bytes.size());
}

std::uint32_t VirtualNetwork::send(Cell& from, int port, std::span<const std::uint8_t> bytes) {
    const Time takes = duration(bytes.size());
    bytesSent_ += bytes.size();
    const auto& wire = from.wires[static_cast<std::size_t>(port)];
    const bool lost = faults_.lostFrames > 0 && std::bernoulli_distribution(faults_.lostFrames)(random_);
    if (wire && !lost) {
        Event event{now_ + takes + faults_.latency, order_++, wire->cell, wire->port, {bytes.begin(), bytes.end()}};
        spoil(event.bytes);
        events_.push(std::move(event));
    }
    return static_cast<std::uint32_t>(takes.count());
}

void VirtualNetwork::fromComputer(std::span<const std::uint8_t> bytes) {
    // As whole frames as they come: a cell collects bytes anyway.
    while (!bytes.empty()) {
        const auto zero = std::find(bytes.begin(), bytes.end(), 0);
        const auto count = static_cast<std::size_t>(zero - bytes.begin()) + (zero == bytes.end() ? 0 : 1);
        computerFree_ = std::max(computerFree_, now_) + duration(count);
        bytesSent_ += count;
        Event event{computerFree_ + faults_.latency,
                    order_++,
                    root_,
                    rootPort_,
                    {bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count)}};
        const bool lost = faults_.lostFrames > 0 && std::bernoulli_distribution(faults_.lostFrames)(random_);
        spoil(event.bytes);
        if (!lost && cells_[root_]->wires[static_cast<std::size_t>(rootPort_)])
            events_.push(std::move(event));
        bytes = bytes.subspan(count);
    }
}

void VirtualNetwork::wakeAfter(Cell& cell, std::uint32_t wait) {
    if (wait == UINT32_MAX)
        return;
    const Time when = now_ + Time(std::max<std::uint32_t>(wait, 1));
    if (when >= cell.wakeAt)
        return;
    cell.wakeAt = when;
    events_.push({when, order_++, cell.index, -1, {}});
}

void VirtualNetwork::run(Time until) {
    while (!events_.empty() && events_.top().time <= until) {
        // The queue's top is const, but it goes away right after.
        const Event event = std::move(const_cast<Event&>(events_.top()));  // NOLINT
        events_.pop();
        now_ = std::max(now_, event.time);
        if (event.cell == Cell::kComputer) {
            toComputer_.insert(toComputer_.end(), event.bytes.begin(), event.bytes.end());
            continue;
        }
        Cell& cell = *cells_[event.cell];
        if (!cell.alive || (event.port < 0 && cell.wakeAt != event.time))
            continue;
        if (event.port >= 0)
            skin_cell_receive(&cell.cell, event.port, event.bytes.data(), event.bytes.size());
        else
            cell.wakeAt = Time::max();
        wakeAfter(cell, skin_cell_run(&cell.cell));
    }
    now_ = std::max(now_, until);
}

std::optional<VirtualNetwork::Time> VirtualNetwork::next() const {
    return events_.empty() ? std::nullopt : std::optional(events_.top().time);
}

std::vector<std::uint8_t> VirtualNetwork::takeForComputer() {
    return std::exchange(toComputer_, {});
}

std::size_t VirtualNetwork::cells() const {
    return cells_.size();
}

std::string VirtualNetwork::uniqueId(std::size_t cell) const {
    std::string text;
    for (const std::uint8_t byte : cells_[cell]->identity.unique_id)
        fmt::format_to(std::back_inserter(text), "{:02x}", byte);
    return text;
}

std::uint32_t VirtualNetwork::led(std::size_t cell) const {
    return cells_[cell]->alive ? cells_[cell]->colour : 0;
}

void VirtualNetwork::kill(std::size_t cell) {
    cells_[cell]->alive = false;
    if (std::exchange(cells_[cell]->colour, 0) != 0 && onLed_)
        onLed_(cell, 0, now_);
}

void VirtualNetwork::restart(std::size_t cell) {
    kill(cell);
    boot(*cells_[cell]);
}

void VirtualNetwork::cut(std::size_t cell, int port) {
    auto& wire = cells_[cell]->wires[static_cast<std::size_t>(port)];
    if (!wire)
        return;
    if (wire->cell != Cell::kComputer)
        cells_[wire->cell]->wires[static_cast<std::size_t>(wire->port)].reset();
    wire.reset();
}

}  // namespace skincal
