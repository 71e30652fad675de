#pragma once

#include <bit>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/device/protocol/frame.h"
#include "tests/fuzz/byte_source.h"

namespace skincal::test {

/// Fields of skin.proto, as far as they matter to whoever reads them.
enum class FieldKind : std::uint8_t { Number, Id, Name, Block, Samples, Fixed32, Fixed64, Floats, Heard };

struct MessageShape {
    FrameType type{};
    FrameDirection usual{};
    std::array<FieldKind, 6> fields{};  ///< numbered from 1
    std::size_t count = 0;
};

inline constexpr auto kShapes = [] {
    using enum FieldKind;
    using enum FrameDirection;
    return std::to_array<MessageShape>({
        {FrameType::Ack, Local, {}, 0},
        {FrameType::Hello, Local, {Number, Number, Number, Fixed32, Name, Number}, 6},
        {FrameType::Explore, Local, {}, 0},
        {FrameType::Explored, Local, {Number, Number}, 2},
        {FrameType::Subtree, Local, {Number}, 1},
        {FrameType::Assign, Local, {Number}, 1},
        {FrameType::Neighbour, Local, {Number, Number}, 2},
        {FrameType::CellInfo, Up, {Id, Name, Number, Heard, Number}, 5},
        {FrameType::Booted, Local, {}, 0},
        {FrameType::Restarted, Up, {Number}, 1},
        {FrameType::Report, Down, {Number, Number}, 2},
        {FrameType::Pattern, Down, {Number, Number, Number, Number, Number, Number}, 6},
        {FrameType::Mask, Down, {Number, Block, Number}, 3},
        {FrameType::Words, Down, {Number, Block, Number}, 3},
        {FrameType::Latched, Up, {Number, Fixed64, Fixed64, Number}, 4},
        {FrameType::Tally, Down, {Number, Number}, 2},
        {FrameType::Tallied, Local, {Number, Number}, 2},
        {FrameType::TimeMark, Down, {}, 0},
        {FrameType::Measure, Down, {Number, Number}, 2},
        {FrameType::Rest, Up, {Number, Floats, Floats, Fixed32, Number}, 5},
        {FrameType::Tactile, Up, {Samples}, 1},
        {FrameType::Stream, Down, {Number, Number, Number, Number}, 4},
        {FrameType::Refused, Local, {Number, Number}, 2},
        {static_cast<FrameType>(99), Local, {Number}, 1},  // of a newer version
    });
}();

/// Protocol Buffers by hand: the library's writers can't write what is wrong.
class PayloadWriter {
  public:
    explicit PayloadWriter(std::string& to) : to_(to) {}

    void number(int field, std::uint64_t value) {
        varint(static_cast<std::uint64_t>(field) << 3);
        varint(value);
    }
    void bytes(int field, std::string_view value) {
        varint(static_cast<std::uint64_t>(field) << 3 | 2);
        varint(value.size());
        to_ += value;
    }
    template <class Integer>
    void fixed(int field, Integer value) {
        varint(static_cast<std::uint64_t>(field) << 3 | (sizeof value == 8 ? 1 : 5));
        plain(to_, value);
    }
    template <class Integer>
    static void plain(std::string& to, Integer value) {
        for (std::size_t i = 0; i < sizeof value; ++i)
            to += static_cast<char>(value >> 8 * i & 0xFF);
    }

  private:
    void varint(std::uint64_t value) {
        for (; value >= 0x80; value >>= 7)
            to_ += static_cast<char>(value | 0x80);
        to_ += static_cast<char>(value);
    }
    std::string& to_;
};

/// A length that somebody may have a limit at.
inline std::size_t blockLength(ByteSource& from) {
    constexpr std::array<std::uint8_t, 16> kLengths{0,   1,   2,   8,   16,  20,  40,  100,
                                                    120, 126, 127, 128, 160, 191, 192, 200};
    const std::uint8_t chosen = from.byte();
    return chosen < 128 ? kLengths[chosen % kLengths.size()] : chosen;
}

inline void appendFloats(ByteSource& from, std::string& to) {
    using Limits = std::numeric_limits<float>;
    constexpr std::array<float, 10> kValues{0,
                                            1,
                                            -9.81F,
                                            1e-3F,
                                            1e20F,
                                            Limits::max(),
                                            Limits::denorm_min(),
                                            Limits::infinity(),
                                            -Limits::infinity(),
                                            Limits::quiet_NaN()};
    const std::uint8_t count = from.byte();
    for (int i = 0; i < (count < 224 ? 3 : count % 8); ++i)
        PayloadWriter::plain(to, std::bit_cast<std::uint32_t>(kValues[from.below(kValues.size())]));
}

inline void appendField(FieldKind kind, int number, ByteSource& from, PayloadWriter& writer) {
    std::string value;
    switch (kind) {
        case FieldKind::Number:
            if (const std::uint64_t plain = from.number(); plain != 0)
                writer.number(number, plain);
            break;
        case FieldKind::Fixed32:
            writer.fixed(number, static_cast<std::uint32_t>(from.number()));
            break;
        case FieldKind::Fixed64:
            writer.fixed(number, from.number());
            break;
        case FieldKind::Id: {
            const std::uint8_t which = from.byte();
            writer.bytes(number, std::string(which < 224 ? 12 : which % 32, static_cast<char>(which)));
            break;
        }
        case FieldKind::Name:
            writer.bytes(number, std::string(from.below(32), 'x'));
            break;
        case FieldKind::Block: {
            value.resize(blockLength(from));
            const std::uint8_t filling = from.byte();
            for (std::size_t i = 0; i < value.size(); ++i)
                value[i] = static_cast<char>(filling + i);
            writer.bytes(number, value);
            break;
        }
        case FieldKind::Samples: {
            const std::uint8_t count = from.byte();
            for (int i = 0; i < count % 12; ++i) {
                PayloadWriter::plain(value, static_cast<std::uint16_t>(from.number()));
                value.append(18, static_cast<char>(from.byte()));
            }
            value.append(count < 192 ? 0 : count % 20, '\x01');  // half a sample
            writer.bytes(number, value);
            break;
        }
        case FieldKind::Floats:
            appendFloats(from, value);
            writer.bytes(number, value);
            break;
        case FieldKind::Heard:
            for (std::uint32_t i = from.below(10); i > 0; --i) {
                value.clear();
                PayloadWriter inner(value);
                for (int f = 1; f <= 3; ++f)
                    inner.number(f, from.number());
                writer.bytes(number, value);
            }
            break;
    }
}

/// A message as it should be, or nearly: fields of any value, and one time in four something cut, changed or added.
inline std::string makePayload(const MessageShape& shape, ByteSource& from) {
    std::string payload;
    PayloadWriter writer(payload);
    const std::uint8_t wrong = from.byte();
    for (std::size_t i = 0; i < shape.count; ++i)
        appendField(shape.fields[i], static_cast<int>(i + 1), from, writer);
    if (payload.size() > kMaxPayload)
        payload.resize(kMaxPayload);
    if (wrong < 192 || payload.empty())
        return payload;
    const std::size_t place = from.byte() % payload.size();
    if (wrong < 208)
        payload.resize(place);
    else if (wrong < 240)
        payload[place] = static_cast<char>(from.byte());
    else
        payload.insert(place, std::string(std::min<std::size_t>(kMaxPayload - payload.size(), wrong % 8), '\x2A'));
    return payload;
}

/// What both sides of a link keep in mind, so that what is made is mostly taken.
struct Course {
    std::uint16_t sequence = 0;  ///< of the frame before
    std::uint8_t epoch = 0;
    std::uint16_t cell = 0;  ///< about which numbers are chosen
    std::uint32_t now = 0;
};

/// A header that the receiver takes, but for what one byte in some says.
inline FrameHeader makeHeader(const MessageShape& shape, Course& course, ByteSource& from) {
    FrameHeader header;
    header.type = shape.type;
    header.direction = shape.usual;
    header.compatible = shape.type == FrameType::Ack || shape.type == FrameType::Tactile ? 0 : FrameHeader::kReliable;
    header.epoch = course.epoch;
    header.sequence = ++course.sequence;
    header.count = 1;
    const std::uint8_t odd = from.byte();
    if (shape.usual != FrameDirection::Local || shape.type == FrameType::Ack) {
        const std::uint64_t first = from.number();
        header.first =
            static_cast<std::uint16_t>(shape.usual == FrameDirection::Down ? course.cell + 3 - first : first);
        header.count = static_cast<std::uint16_t>(from.number());
    }
    if (odd & 1U)
        header.time_us = course.now + static_cast<std::uint32_t>(from.number()) * 1000;
    if (odd < 128)
        return header;
    switch (odd / 2 % 8) {
        case 0:
            header.epoch = static_cast<std::uint8_t>(course.epoch + from.byte());
            break;
        case 1:
            header.sequence = static_cast<std::uint16_t>(course.sequence + from.number() - 8);
            break;
        case 2:
            header.sequence = course.sequence = static_cast<std::uint16_t>(from.number());
            header.compatible |= FrameHeader::kFirst;
            break;
        case 3:
            header.direction = static_cast<FrameDirection>(from.below(4));
            break;
        case 4:
            header.version = from.byte();
            break;
        case 5:
            header.incompatible = from.byte();
            break;
        case 6:
            header.compatible = from.byte();
            break;
        default:
            header.epoch = ++course.epoch;  // everybody explores anew
            break;
    }
    return header;
}

/// A frame as it was seen on a wire: its header's bytes and its payload, one after the other.
inline void appendSeen(ByteSource& from, std::vector<std::uint8_t>& bytes) {
    std::array<std::uint8_t, kFrameHeaderSize> h{};
    for (std::uint8_t& byte : h)
        byte = from.byte();
    FrameHeader header;
    header.version = h[0];
    header.incompatible = h[1];
    header.compatible = h[2];
    header.type = static_cast<FrameType>(h[3]);
    header.sequence = static_cast<std::uint16_t>(h[4] | h[5] << 8);
    header.epoch = h[6];
    header.direction = static_cast<FrameDirection>(h[7]);
    header.first = static_cast<std::uint16_t>(h[8] | h[9] << 8);
    header.count = static_cast<std::uint16_t>(h[10] | h[11] << 8);
    header.time_us = static_cast<std::uint32_t>(h[12] | h[13] << 8 | h[14] << 16) | static_cast<std::uint32_t>(h[15])
                                                                                        << 24;
    const auto payload = from.rest().first(std::min(kMaxPayload, from.rest().size()));
    appendFrame(header, {reinterpret_cast<const char*>(payload.data()), payload.size()}, bytes);
}

/// What comes over a wire: a made message, one that was seen, or mere bytes.
inline void appendArrival(ByteSource& from, Course& course, std::vector<std::uint8_t>& bytes) {
    const std::uint8_t kind = from.byte();
    if (kind < 200) {
        const MessageShape& shape = kShapes[kind % kShapes.size()];
        const FrameHeader header = makeHeader(shape, course, from);
        appendFrame(header, makePayload(shape, from), bytes);
    } else if (kind < 240) {
        appendSeen(from, bytes);
    } else {
        bytes.insert(bytes.end(), from.rest().begin(), from.rest().end());
    }
}

/// Throws where something is not as it must be.
inline void require(bool so, const char* what) {
    if (!so)
        throw std::logic_error(what);
}

}  // namespace skincal::test
