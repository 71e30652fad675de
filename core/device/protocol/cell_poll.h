#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "core/device/protocol/skin_listener.h"

namespace skincal {

struct CellRange {
    CellNumber first = 0;
    CellNumber count = 0;
    friend bool operator==(const CellRange&, const CellRange&) = default;
};

/// Asks each of very many cells for one answer, so many at a time that neither line nor cells overflow, and asks those
/// again that did not answer, alone. Pure bookkeeping: says whom to ask, is told who answered.
class CellPoll {
  public:
    using Time = std::chrono::microseconds;
    static constexpr std::size_t kAtOnce = 192;
    static constexpr std::size_t kRange = 32;  ///< cells per request
    static constexpr Time kMostPatience{4'000'000};
    static constexpr std::size_t kMostWaiting = 16;  ///< frames that wait to be sent, of which no more are made
    static constexpr int kRounds = 8;                ///< without any answer, until those left are given up

    /// @param patience  without an answer, until who has not answered is asked again; grows where that was too soon
    CellPoll(std::vector<CellNumber> cells, Time patience, Time now);

    /// Whom to ask now.
    [[nodiscard]] std::vector<CellRange> poll(Time now);
    /// Returns whether that answer was waited for.
    bool answered(CellNumber cell, Time now);
    /// All have answered, or are given up.
    [[nodiscard]] bool isOver() const { return open_ == 0 || rounds_ > kRounds; }
    [[nodiscard]] std::vector<CellNumber> missing() const;
    [[nodiscard]] Time wakeAt() const { return asked_ == 0 ? Time{} : lastNews_ + patience_; }

  private:
    enum class State : std::uint8_t { None, Open, Asked, Answered };

    std::vector<State> state_;       ///< by number
    std::vector<CellNumber> cells_;  ///< by rising number
    std::size_t open_ = 0;           ///< not answered
    std::size_t asked_ = 0;          ///< of those
    std::size_t next_ = 0;           ///< in cells_: all before have been asked in this round
    int rounds_ = 0;
    Time patience_;
    Time lastNews_;
};

}  // namespace skincal
