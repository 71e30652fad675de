#pragma once

#include <stdexcept>
#include <vector>

#include "core/device/protocol/skin_client.h"
#include "resources/firmware/skin_cell.h"

namespace skincal::test {

/// Believes nothing that a client tells it unless it can be.
class Sceptic : public SkinListener {
  public:
    void onOpened(const std::string&) override {}
    void onFault(SkinFault) override {}
    void onCounted(std::size_t cells) override { require(cells > 0 && cells < 0xFFFF); }
    void onCell(const NetworkCell& cell) override { require(cell.number > 0 && cell.uniqueId.size() == 24); }
    void onExplored(const SkinNetwork& network) override {
        for (const NetworkCell& cell : network.cells)
            for (const NetworkCell::Heard& heard : cell.heard)
                require(heard.port >= 0 && heard.port < cell.ports && heard.port_there >= 0);
    }
    void onRestarted() override {}
    void onShown(std::uint64_t) override {}
    void onNotShown(std::uint64_t, std::size_t) override {}
    void onAcceleration(const RestReading& reading, Time) override { require(reading.mean.allFinite()); }
    void onRest(std::span<const RestReading> readings, std::span<const CellNumber>) override {
        for (const RestReading& reading : readings)
            require(reading.count > 0 && reading.mean.allFinite() && reading.variance.allFinite());
    }
    void onTouch(std::span<const CellTouch> touches, Time) override {
        for (const CellTouch& touch : touches)
            require(touch.proximity >= 0 && touch.proximity <= 1);
    }

  private:
    static void require(bool so) {
        if (!so)
            throw std::logic_error("a listener was told what can't be");
    }
};

/// Frames of the input: header fields and payload as they stand, lengths and CRC made right. Each begins with its
/// payload's length.
inline std::vector<std::uint8_t> mended(std::span<const std::uint8_t> input) {
    std::vector<std::uint8_t> bytes;
    while (input.size() > kFrameHeaderSize) {
        const std::size_t length = std::min<std::size_t>(input[0] % (kMaxPayload + 1), input.size() - kFrameHeaderSize);
        FrameHeader header;
        // Mostly frames that somebody listens to: of this version, without unknown flags.
        header.version = input[1] < 250 ? FrameHeader::kVersion : input[1];
        header.incompatible = input[2] < 250 ? 0 : input[2];
        header.compatible = input[3];
        header.type = static_cast<FrameType>(input[4]);
        header.sequence = static_cast<std::uint16_t>(input[5] | input[6] << 8);
        header.epoch = input[7] < 200 ? 1 : input[7];
        header.direction = static_cast<FrameDirection>(input[8] % 4);
        header.first = static_cast<std::uint16_t>(input[10] < 200 ? input[9] % 8 : input[9] | input[10] << 8);
        header.count = static_cast<std::uint16_t>(input[12] < 200 ? input[11] : input[11] | input[12] << 8);
        header.time_us = input[13];
        const auto payload = input.subspan(kFrameHeaderSize, length);
        appendFrame(header, {reinterpret_cast<const char*>(payload.data()), payload.size()}, bytes);
        input = input.subspan(kFrameHeaderSize + length);
    }
    return bytes;
}

/// A board that does nothing and counts what is sent: not without end.
struct QuietBoard {
    std::uint32_t now = 0;
    std::size_t sent = 0;
    skin_board board{};

    QuietBoard() {
        board.context = this;
        board.byte_ns = 3333;
        board.now_us = [](void* self) { return static_cast<QuietBoard*>(self)->now; };
        board.send = [](void* self, int, const std::uint8_t*, std::size_t count) {
            static_cast<QuietBoard*>(self)->sent += count;
            return static_cast<std::uint32_t>(count * 10 / 3);
        };
        board.led = [](void*, std::uint8_t, std::uint8_t, std::uint8_t) {};
        board.acceleration = [](void*, float xyz[3]) { xyz[0] = xyz[1] = xyz[2] = 1; };
        board.temperature = [](void*) { return 20.0F; };
        board.tactile = [](void*, std::uint16_t* proximity, std::uint16_t force[3]) {
            *proximity = force[0] = force[1] = force[2] = 7;
        };
    }
};

/// A frame as the other side would send it, of the first exploration.
inline std::vector<std::uint8_t> said(FrameType type, std::uint16_t sequence, std::string_view payload,
                                      std::uint16_t upFrom = 0) {
    FrameHeader header;
    header.compatible = FrameHeader::kReliable;
    header.type = type;
    header.sequence = sequence;
    header.epoch = type == FrameType::Hello ? 0 : 1;
    header.direction = upFrom == 0 ? FrameDirection::Local : FrameDirection::Up;
    header.first = upFrom;
    header.count = 1;
    std::vector<std::uint8_t> bytes;
    appendFrame(header, payload, bytes);
    return bytes;
}

/// Brings a client to where it knows four cells: most of what can go wrong lies behind.
inline void introduce(SkinClient& client, std::vector<std::uint8_t>& out) {
    using Time = SkinClient::Time;
    using namespace std::string_view_literals;
    client.receive(said(FrameType::Hello, 1, "\x08\x01\x10\x01"sv), Time(100));
    client.explore(Time(200));
    client.receive(said(FrameType::Subtree, 2, "\x08\x04"sv), Time(300));
    for (std::uint16_t cell = 1; cell <= 4; ++cell)
        client.receive(said(FrameType::CellInfo, static_cast<std::uint16_t>(2 + cell),
                            "\x0A\x0Cuniqueid0000\x12\x03hex\x18\x04"sv, cell),
                       Time(400));
    client.poll(Time(500), out);
}

/// Brings a cell to where it has the number 1, its parent on port 0 and no children.
inline void introduce(skin_cell& cell, QuietBoard& quiet) {
    using namespace std::string_view_literals;
    const auto hear = [&](const std::vector<std::uint8_t>& bytes) {
        skin_cell_receive(&cell, 0, bytes.data(), bytes.size());
        for (int i = 0; i < 12; ++i, quiet.now += 50'000)
            skin_cell_run(&cell);
    };
    hear(said(FrameType::Explore, 1, ""sv));
    hear(said(FrameType::Assign, 2, "\x08\x01"sv));
    if (cell.tree.number != 1)
        throw std::logic_error("a cell that does not take part");
}

/// Client and cell are fed with the same bytes, raw or mended. Whatever they are, both return and tell nothing that
/// can't be.
inline void talk(std::span<const std::uint8_t> input) {
    if (input.empty())
        return;
    const std::uint8_t how = input.front();
    input = input.subspan(1);
    const std::vector<std::uint8_t> bytes =
        how % 4 == 0 ? std::vector<std::uint8_t>(input.begin(), input.end()) : mended(input);

    using Time = SkinClient::Time;
    Sceptic sceptic;
    SkinClient client(sceptic, {}, how);
    std::vector<std::uint8_t> out;
    client.open(Time(0));
    client.poll(Time(0), out);
    const bool areIntroduced = how & 8U;
    if (areIntroduced)
        introduce(client, out);
    const std::size_t half = how % 4 < 2 ? 0 : bytes.size() / 2;
    client.receive(std::span(bytes).first(half), Time(1000));
    if (!areIntroduced)
        client.explore(Time(2000));
    client.receive(std::span(bytes).subspan(half), Time(3000));
    client.light({{1, 7}, {2, 3}}, 5, Time(4000));
    client.measureRest(std::chrono::milliseconds(10), Time(5000));
    client.receive(bytes, Time(6000));
    for (int i = 1; i < 12; ++i)
        client.poll(Time(i * 300'000), out);

    QuietBoard quiet;
    skin_identity identity{};
    skin_cell cell;
    skin_cell_init(&cell, &quiet.board, &identity, 4, 4000);
    if (areIntroduced)
        introduce(cell, quiet);
    skin_cell_receive(&cell, areIntroduced ? 0 : how % 3, bytes.data(), half);
    for (int i = 0; i < 8; ++i, quiet.now += 50'000)
        skin_cell_run(&cell);
    skin_cell_receive(&cell, areIntroduced ? 0 : (how + 1) % 3, bytes.data() + half, bytes.size() - half);
    for (int i = 0; i < 8; ++i, quiet.now += 50'000)
        skin_cell_run(&cell);
    if (skin_link_room(&cell.link) > SKIN_BUFFERS)
        throw std::logic_error("more room than there is");
}

}  // namespace skincal::test
