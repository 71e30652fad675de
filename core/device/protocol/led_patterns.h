#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/device/protocol/frame.h"
#include "core/device/protocol/skin_listener.h"

namespace skincal {

/// A cell to light: bits 1 red, 2 green, 4 blue, 7 white.
struct LitCell {
    CellNumber cell = 0;
    std::uint8_t colour = 7;
    friend bool operator==(const LitCell&, const LitCell&) = default;
};

/// What is to be sent, but for what the link adds.
struct Message {
    FrameHeader header;
    std::string payload;
};

/// Words of all cells for a scan, known to the cells before it begins: bit k of a cell's word says whether it is lit in
/// set k. Cells that are in no set have none.
class LedWords {
  public:
    LedWords() = default;
    /// @param sets    at most 64, else std::logic_error; only white ones have a place in words
    /// @param number  tells these words from earlier ones
    explicit LedWords(std::vector<std::vector<LitCell>> sets, std::uint32_t number = 1);

    [[nodiscard]] std::uint32_t number() const { return number_; }
    [[nodiscard]] bool empty() const { return sets_.empty(); }
    /// Which set this is.
    [[nodiscard]] std::optional<std::size_t> find(const std::vector<LitCell>& lit) const;
    [[nodiscard]] std::uint64_t word(CellNumber cell) const { return cell < words_.size() ? words_[cell] : 0; }
    /// Tells the cells 1 to `cells` their words.
    [[nodiscard]] std::vector<Message> messages(std::size_t cells) const;

  private:
    std::vector<std::vector<LitCell>> sets_;  ///< each by rising number
    std::vector<std::uint64_t> words_;        ///< by number
    std::uint32_t number_ = 0;
};

/// Lights these and darkens all others of the cells 1 to `cells`: one broadcast where nobody, everybody, one cell or
/// a set of `words` is lit; else a bit per cell (four where colours differ) before it.
/// @param lit  by rising number, each once
[[nodiscard]] std::vector<Message> patternMessages(const std::vector<LitCell>& lit, std::size_t cells,
                                                   std::uint16_t number, const LedWords& words);

}  // namespace skincal
