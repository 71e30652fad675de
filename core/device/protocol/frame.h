#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace skincal {

/// What a frame is about: the number behind the message's name in skin.proto.
enum class FrameType : std::uint8_t {
    Ack = 1,
    Hello = 10,
    Explore = 11,
    Explored = 12,
    Subtree = 13,
    Assign = 14,
    Neighbour = 15,
    CellInfo = 16,
    Booted = 17,
    Restarted = 18,
    Report = 20,
    Pattern = 30,
    Mask = 31,
    Words = 32,
    Latched = 33,
    Tally = 34,
    Tallied = 35,
    TimeMark = 40,
    Measure = 50,
    Rest = 51,
    Tactile = 52,
    Stream = 53,
    Refused = 60,
};

enum class FrameDirection : std::uint8_t { Local = 0, Down = 1, Up = 2 };

/// The fixed part of a frame, PROTOCOL.md says what the fields mean. Numbers are little endian on the wire.
struct FrameHeader {
    static constexpr std::uint8_t kVersion = 1;
    static constexpr std::uint8_t kReliable = 1;  ///< bits of `compatible`
    static constexpr std::uint8_t kFirst = 2;

    std::uint8_t version = kVersion;
    std::uint8_t incompatible = 0;
    std::uint8_t compatible = 0;
    FrameType type{};
    std::uint16_t sequence = 0;
    std::uint8_t epoch = 0;
    FrameDirection direction{};
    std::uint16_t first = 0;
    std::uint16_t count = 0;
    std::uint32_t time_us = 0;

    friend bool operator==(const FrameHeader&, const FrameHeader&) = default;
};

constexpr std::size_t kFrameHeaderSize = 16;
constexpr std::size_t kMaxPayload = 234;
constexpr std::size_t kMaxEncodedFrame = 256;  ///< its final zero included
constexpr std::size_t kEmptyFrame = 22;        ///< encoded bytes of a frame without a payload

/// Appends an encoded frame: header, payload and their CRC-32 (as zlib has it), stuffed so that no byte is zero but the
/// one at its end.
/// Throws std::logic_error where the payload is longer than kMaxPayload.
/// Ref: Cheshire and Baker, Consistent Overhead Byte Stuffing, IEEE/ACM Transactions on Networking 7, 1999.
void appendFrame(const FrameHeader& header, std::string_view payload, std::vector<std::uint8_t>& bytes);

/// Cuts a stream of bytes, as it comes, into frames. Damaged ones are dropped and counted; the next zero byte begins
/// anew, so that nothing but the damaged frame is lost (two, where a zero was hit). Memory is bounded by one frame.
class FrameDecoder {
  public:
    /// `payload` is valid during the call only.
    using Sink = std::function<void(const FrameHeader& header, std::string_view payload)>;

    /// Calls `sink` for every frame that ends within these bytes.
    void feed(std::span<const std::uint8_t> bytes, const Sink& sink);

    struct Counts {
        std::uint64_t frames = 0;   ///< whole ones
        std::uint64_t damaged = 0;  ///< neither empty nor whole
        std::uint64_t empty = 0;    ///< zeros that end nothing
        std::uint64_t bytes = 0;
    };
    [[nodiscard]] const Counts& counts() const { return counts_; }

  private:
    void finish(std::span<const std::uint8_t> stuffed, const Sink& sink);

    std::array<std::uint8_t, kMaxEncodedFrame> partial_{};
    std::size_t collected_ = 0;
    bool tooLong_ = false;
    Counts counts_;
};

}  // namespace skincal
