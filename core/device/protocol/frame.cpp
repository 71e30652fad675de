#include "core/device/protocol/frame.h"

#include <zlib.h>

#include <cstring>
#include <stdexcept>

namespace skincal {
namespace {

std::uint32_t checksum(std::span<const std::uint8_t> bytes) {
    return static_cast<std::uint32_t>(crc32_z(0, bytes.data(), bytes.size()));
}

template <class Integer>
void put(std::uint8_t* to, Integer value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
        to[i] = static_cast<std::uint8_t>(value >> 8 * i);
}

template <class Integer>
Integer get(const std::uint8_t* from) {
    Integer value = 0;
    for (std::size_t i = 0; i < sizeof value; ++i)
        value = static_cast<Integer>(value | static_cast<Integer>(from[i]) << 8 * i);
    return value;
}

/// Returns the length of what was stuffed, 0 where a block points beyond the end.
std::size_t unstuff(std::span<const std::uint8_t> stuffed, std::uint8_t* raw) {
    std::size_t in = 0;
    std::size_t out = 0;
    while (in < stuffed.size()) {
        const std::size_t block = stuffed[in++];
        if (in + block - 1 > stuffed.size())
            return 0;
        std::memcpy(raw + out, stuffed.data() + in, block - 1);
        in += block - 1;
        out += block - 1;
        if (in < stuffed.size() && block < 255)
            raw[out++] = 0;
    }
    return out;
}

}  // namespace

void appendFrame(const FrameHeader& header, std::string_view payload, std::vector<std::uint8_t>& bytes) {
    if (payload.size() > kMaxPayload)
        throw std::logic_error("a frame's payload has at most 234 bytes");
    std::array<std::uint8_t, kFrameHeaderSize + kMaxPayload + 4> raw{};
    raw[0] = header.version;
    raw[1] = header.incompatible;
    raw[2] = header.compatible;
    raw[3] = static_cast<std::uint8_t>(header.type);
    put(&raw[4], header.sequence);
    raw[6] = header.epoch;
    raw[7] = static_cast<std::uint8_t>(header.direction);
    put(&raw[8], header.first);
    put(&raw[10], header.count);
    put(&raw[12], header.time_us);
    if (!payload.empty())
        std::memcpy(raw.data() + kFrameHeaderSize, payload.data(), payload.size());
    const std::size_t checked = kFrameHeaderSize + payload.size();
    put(&raw[checked], checksum({raw.data(), checked}));

    // At most 254 bytes: no block is ever cut.
    std::size_t lead = bytes.size();
    bytes.push_back(0);
    for (std::size_t i = 0; i < checked + 4; ++i) {
        if (raw[i] == 0) {
            bytes[lead] = static_cast<std::uint8_t>(bytes.size() - lead);
            lead = bytes.size();
        }
        bytes.push_back(raw[i]);
    }
    bytes[lead] = static_cast<std::uint8_t>(bytes.size() - lead);
    bytes.push_back(0);
}

void FrameDecoder::feed(std::span<const std::uint8_t> bytes, const Sink& sink) {
    counts_.bytes += bytes.size();
    while (!bytes.empty()) {
        const void* zero = std::memchr(bytes.data(), 0, bytes.size());
        const std::size_t part =
            zero ? static_cast<std::size_t>(static_cast<const std::uint8_t*>(zero) - bytes.data()) : bytes.size();
        if (zero && collected_ == 0 && !tooLong_) {
            finish(bytes.first(part), sink);  // the common case: nothing to copy
        } else {
            const std::size_t fits = std::min(part, partial_.size() - collected_);
            std::memcpy(partial_.data() + collected_, bytes.data(), fits);
            collected_ += fits;
            tooLong_ = tooLong_ || fits < part;
            if (zero) {
                const std::size_t whole = tooLong_ ? kMaxEncodedFrame : collected_;
                collected_ = 0;
                tooLong_ = false;
                finish({partial_.data(), whole}, sink);
            }
        }
        bytes = bytes.subspan(zero ? part + 1 : part);
    }
}

void FrameDecoder::finish(std::span<const std::uint8_t> stuffed, const Sink& sink) {
    if (stuffed.empty()) {
        ++counts_.empty;
        return;
    }
    std::array<std::uint8_t, kMaxEncodedFrame> raw;  // NOLINT: written before it is read, and this is the busiest place
    const std::size_t size = stuffed.size() < kMaxEncodedFrame ? unstuff(stuffed, raw.data()) : 0;
    if (size < kFrameHeaderSize + 4 || get<std::uint32_t>(&raw[size - 4]) != checksum({raw.data(), size - 4})) {
        ++counts_.damaged;
        return;
    }
    ++counts_.frames;
    FrameHeader header;
    header.version = raw[0];
    header.incompatible = raw[1];
    header.compatible = raw[2];
    header.type = static_cast<FrameType>(raw[3]);
    header.sequence = get<std::uint16_t>(&raw[4]);
    header.epoch = raw[6];
    header.direction = static_cast<FrameDirection>(raw[7]);
    header.first = get<std::uint16_t>(&raw[8]);
    header.count = get<std::uint16_t>(&raw[10]);
    header.time_us = get<std::uint32_t>(&raw[12]);
    const char* text = reinterpret_cast<const char*>(raw.data());  // NOLINT: bytes are bytes
    sink(header, {text + kFrameHeaderSize, size - kFrameHeaderSize - 4});
}

}  // namespace skincal
