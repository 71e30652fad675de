#include "core/device/protocol/led_patterns.h"

#include <algorithm>
#include <stdexcept>

#include "core/device/protocol/skin.pb.h"

namespace skincal {
namespace {

constexpr std::size_t kBlock = 180;  ///< bytes of masks or words per frame

Message down(FrameType type, std::size_t first, std::size_t count, const google::protobuf::MessageLite& message) {
    Message made;
    made.header.type = type;
    made.header.direction = FrameDirection::Down;
    made.header.first = static_cast<std::uint16_t>(first);
    made.header.count = static_cast<std::uint16_t>(count);
    made.payload = message.SerializeAsString();
    return made;
}

Message broadcast(const wire::Pattern& pattern, std::size_t cells) {
    return down(FrameType::Pattern, 1, cells, pattern);
}

std::uint32_t rgb(std::uint8_t colour) {
    if (colour == 7)
        return 0;  // white goes without saying
    return (colour & 1U ? 0xFF0000U : 0) | (colour & 2U ? 0xFF00U : 0) | (colour & 4U ? 0xFFU : 0);
}

bool isOneColour(const std::vector<LitCell>& lit) {
    return std::all_of(lit.begin(), lit.end(), [&](const LitCell& l) { return l.colour == lit.front().colour; });
}

void appendMasks(const std::vector<LitCell>& lit, std::size_t cells, std::uint16_t number,
                 std::vector<Message>& messages) {
    const std::uint32_t bits = isOneColour(lit) ? 1 : 4;
    const std::size_t perFrame = kBlock * 8 / bits;
    auto next = lit.begin();
    for (std::size_t first = 1; first <= cells; first += perFrame) {
        const std::size_t count = std::min(perFrame, cells + 1 - first);
        std::string block((count * bits + 7) / 8, '\0');
        for (; next != lit.end() && next->cell < first + count; ++next) {
            const std::size_t at = (next->cell - first) * bits;
            const unsigned value = bits == 1 ? 1U : next->colour;
            block[at / 8] = static_cast<char>(static_cast<std::uint8_t>(block[at / 8]) | value << at % 8);
        }
        wire::Mask mask;
        mask.set_number(number);
        mask.set_bits_each(bits);
        mask.set_lit(std::move(block));
        messages.push_back(down(FrameType::Mask, first, count, mask));
    }
}

}  // namespace

LedWords::LedWords(std::vector<std::vector<LitCell>> sets, std::uint32_t number)
    : sets_(std::move(sets)), number_(number) {
    if (sets_.size() > 64)
        throw std::logic_error("a word has at most 64 bits");
    for (std::size_t k = 0; k < sets_.size(); ++k)
        for (const LitCell& lit : sets_[k]) {
            if (lit.cell >= words_.size())
                words_.resize(lit.cell + std::size_t{1}, 0);
            words_[lit.cell] |= std::uint64_t{1} << k;
        }
}

std::optional<std::size_t> LedWords::find(const std::vector<LitCell>& lit) const {
    if (lit.empty() || lit.front().colour != 7 || !isOneColour(lit))
        return std::nullopt;
    const auto set = std::find(sets_.begin(), sets_.end(), lit);
    return set == sets_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(set - sets_.begin()));
}

std::vector<Message> LedWords::messages(std::size_t cells) const {
    const std::size_t bytes = (sets_.size() + 7) / 8;
    std::vector<Message> messages;
    if (bytes == 0)
        return messages;
    const std::size_t perFrame = kBlock / bytes;
    for (std::size_t first = 1; first <= cells; first += perFrame) {
        const std::size_t count = std::min(perFrame, cells + 1 - first);
        wire::Words words;
        words.set_bytes_each(static_cast<std::uint32_t>(bytes));
        words.set_set(number_);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t b = 0; b < bytes; ++b)
                words.mutable_words()->push_back(
                    static_cast<char>(word(static_cast<CellNumber>(first + i)) >> 8 * b & 0xFF));
        messages.push_back(down(FrameType::Words, first, count, words));
    }
    return messages;
}

std::vector<Message> patternMessages(const std::vector<LitCell>& lit, std::size_t cells, std::uint16_t number,
                                     const LedWords& words) {
    std::vector<Message> messages;
    wire::Pattern pattern;
    pattern.set_number(number);
    if (!lit.empty() && isOneColour(lit))
        pattern.set_colour(rgb(lit.front().colour));
    if (lit.empty()) {
        pattern.set_source(wire::NONE);
    } else if (lit.size() == cells && isOneColour(lit)) {
        pattern.set_source(wire::ALL);
    } else if (lit.size() == 1) {
        pattern.set_source(wire::CELL);
        pattern.set_argument(lit.front().cell);
    } else if (const auto bit = words.find(lit)) {
        pattern.set_source(wire::WORD);
        pattern.set_argument(static_cast<std::uint32_t>(*bit));
        pattern.set_set(words.number());
    } else {
        pattern.set_source(wire::MASK);
        appendMasks(lit, cells, number, messages);
    }
    messages.push_back(broadcast(pattern, cells));
    return messages;
}

}  // namespace skincal
