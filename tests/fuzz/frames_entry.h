#pragma once

#include "resources/firmware/skin_frame.h"
#include "tests/fuzz/made_message.h"

namespace skincal::test {

/// Frames one after the other.
struct FrameLog {
    std::vector<FrameHeader> headers;
    std::string payloads;
    std::vector<std::size_t> ends;  ///< of each one's payload

    void clear() {
        headers.clear();
        payloads.clear();
        ends.clear();
    }
    void add(const FrameHeader& header, std::string_view payload) {
        headers.push_back(header);
        payloads += payload;
        ends.push_back(payloads.size());
    }
    friend bool operator==(const FrameLog&, const FrameLog&) = default;
};

inline FrameHeader fromCell(const skin_header& h) {
    return {h.version,
            h.incompatible,
            h.compatible,
            static_cast<FrameType>(h.type),
            h.sequence,
            h.epoch,
            static_cast<FrameDirection>(h.direction),
            h.first,
            h.count,
            h.time_us};
}

/// The cell's encoder writes what the computer's does.
inline void checkEncoders(const FrameHeader& h, std::string_view payload) {
    static std::vector<std::uint8_t> computers;
    computers.clear();
    appendFrame(h, payload, computers);
    const skin_header header{h.version,
                             h.incompatible,
                             h.compatible,
                             static_cast<std::uint8_t>(h.type),
                             h.sequence,
                             h.epoch,
                             static_cast<std::uint8_t>(h.direction),
                             h.first,
                             h.count,
                             h.time_us};
    std::array<std::uint8_t, SKIN_MAX_ENCODED> cells{};
    const std::size_t count =
        skin_frame_encode(&header, reinterpret_cast<const std::uint8_t*>(payload.data()), payload.size(), cells.data());
    require(std::ranges::equal(computers, std::span(cells).first(count)), "two ends encode a frame differently");
}

/// Bytes through both ends' decoders, in pieces: neither finds a frame that the other doesn't.
inline void takeApart(std::span<const std::uint8_t> input) {
    ByteSource from(input);
    const std::uint8_t how = from.byte();
    static std::vector<std::uint8_t> bytes;
    bytes.clear();
    if (how % 4 == 0) {
        bytes.assign(from.rest().begin(), from.rest().end());
    } else {
        // Frames with the right CRC; one time in three, one byte of them is another then.
        while (!from.isOver()) {
            ByteSource record = from.record();
            appendSeen(record, bytes);
        }
        if (how % 4 == 3 && !bytes.empty())
            bytes[input.back() * std::size_t{7} % bytes.size()] ^= how;
    }

    static FrameLog computers;
    computers.clear();
    FrameDecoder decoder;
    const auto sink = [](const FrameHeader& header, std::string_view payload) {
        computers.add(header, payload);
        checkEncoders(header, payload);
    };
    const std::size_t piece = how / 4 == 0 ? bytes.size() : how / 4;
    for (std::span<const std::uint8_t> left = bytes; !left.empty();) {
        const std::size_t next = std::min(piece, left.size());
        decoder.feed(left.first(next), sink);
        left = left.subspan(next);
    }

    static FrameLog cells;
    cells.clear();
    skin_receiver receiver{};
    for (const std::uint8_t byte : bytes) {
        skin_header header;
        const std::uint8_t* payload = nullptr;
        std::size_t length = 0;
        if (skin_frame_push(&receiver, byte, &header, &payload, &length))
            cells.add(fromCell(header), {reinterpret_cast<const char*>(payload), length});
    }
    require(computers == cells, "two ends decode the same bytes differently");
    require(how % 4 == 0 || how % 4 == 3 || decoder.counts().damaged == 0, "a frame that was whole was dropped");
}

}  // namespace skincal::test
