#pragma once

#include <chrono>
#include <optional>
#include <string_view>
#include <vector>

#include "core/device/protocol/cell_poll.h"
#include "core/device/protocol/led_patterns.h"
#include "core/device/protocol/skin_listener.h"

namespace skincal {

/// What LEDs are told, until every cell vouches for it (PROTOCOL.md, section 4): words before a scan, a pattern, a
/// tally of those that have shown it. Where tallies do not add up, the pattern is told again; in the end each cell is
/// asked by itself, and those that are dark are named. A part of SkinClient, which sends what its functions append to
/// `send`, and calls poll() while the network is explored.
class LightOrders {
  public:
    using Time = std::chrono::microseconds;
    using Messages = std::vector<Message>;

    /// @param seed  for where numbers begin
    LightOrders(SkinListener& listener, std::uint32_t seed);

    /// Cells have numbers: `count` of them, of which those in `cells` have described themselves. They know nothing.
    void begin(std::vector<CellNumber> cells, std::size_t count);
    /// Numbers are void. What was prepared stays, for the next.
    void forget();

    /// As in SkinClient.
    void prepare(std::vector<std::vector<LitCell>> sets);
    void light(const std::vector<LitCell>& lit, std::uint64_t token, Time now, std::optional<Time> when,
               Messages& send);
    /// All off, said once, whatever comes of it.
    void darken(Messages& send);

    void takeTallied(std::string_view payload, Time now, Messages& send);
    void takeLatched(CellNumber number, std::string_view payload, Time now);
    /// @param waiting  frames that wait to be sent: cells are asked where there are few
    void poll(Time now, std::size_t waiting, Messages& send);
    [[nodiscard]] std::optional<Time> wakeAt() const;

  private:
    struct Shown {
        std::uint64_t token = 0;
        std::vector<LitCell> lit;
        std::uint16_t number = 0;
        std::uint16_t query = 0;
        int tries = 0;
        Time due{};
        std::optional<Time> when{};
    };

    void tellWords(Messages& send);
    void showAgain(Time now, Messages& send);
    void pollLatched(Time now, std::size_t waiting, Messages& send);
    [[nodiscard]] Message tally();

    SkinListener& listener_;
    std::vector<CellNumber> described_;
    std::size_t cells_ = 0;
    LedWords words_;
    bool wordsTold_ = true;
    std::uint32_t wordSet_ = 0;
    std::optional<Shown> shown_;
    std::optional<CellPoll> latched_;  ///< whoever is asked for what it showed
    std::vector<CellNumber> dark_;     ///< of those that answered
    std::uint16_t pattern_ = 0;
    std::uint16_t query_ = 0;
};

}  // namespace skincal
