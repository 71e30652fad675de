#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace skincal::test {

/// A fuzzer's bytes as a source of decisions: zeros once they have run out.
class ByteSource {
  public:
    explicit ByteSource(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    [[nodiscard]] bool isOver() const { return bytes_.empty(); }
    [[nodiscard]] std::span<const std::uint8_t> rest() const { return bytes_; }

    std::uint8_t byte() {
        if (bytes_.empty())
            return 0;
        const std::uint8_t first = bytes_.front();
        bytes_ = bytes_.subspan(1);
        return first;
    }
    std::uint32_t below(std::uint32_t limit) { return byte() % limit; }

    /// Mostly small, as numbers, ports and counts are; else about the ends of the types that hold them.
    std::uint64_t number() {
        constexpr std::array<std::uint64_t, 12> kEnds{0x7F,   0x80,    0xFF,       0x100,      0x7FFF,     0xFFFE,
                                                      0xFFFF, 0x10000, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, ~0ULL};
        const std::uint8_t kind = byte();
        if (kind < 192)
            return kind % 16;
        if (kind < 224) {
            const std::uint8_t low = byte();
            return low | byte() << 8;
        }
        return kEnds[kind % kEnds.size()];
    }

    /// The next record: its length, then its bytes.
    ByteSource record() {
        std::size_t length = byte();
        length = std::min(length, bytes_.size());
        const ByteSource made(bytes_.first(length));
        bytes_ = bytes_.subspan(length);
        return made;
    }

  private:
    std::span<const std::uint8_t> bytes_;
};

}  // namespace skincal::test
