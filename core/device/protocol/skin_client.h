#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/device/protocol/cell_poll.h"
#include "core/device/protocol/led_patterns.h"
#include "core/device/protocol/light_orders.h"
#include "core/device/protocol/reliable_link.h"
#include "core/device/protocol/skin_listener.h"

namespace skincal {

/// The computer's side of the skin protocol (PROTOCOL.md): bytes in, bytes out, and what it learns to a listener. It
/// knows neither a line nor a clock, so that all of it can be tested in simulated time: whoever owns it hands over what
/// was received, calls poll() by wakeAt() at the latest, and sends what that gives.
///
/// Nothing is taken for granted: cells describe themselves after they were numbered, words of an earlier exploration
/// are not listened to, a pattern counts as shown once as many cells say so as there are, and what does not answer is
/// asked again, then named.
class SkinClient {
  public:
    using Time = std::chrono::microseconds;

    /// @param seed  for where sequence numbers begin; best at random
    SkinClient(SkinListener& listener, const ReliableLinkOptions& link, std::uint32_t seed);

    void receive(std::span<const std::uint8_t> bytes, Time now);
    /// Appends what is to be sent.
    void poll(Time now, std::vector<std::uint8_t>& bytes);
    [[nodiscard]] std::optional<Time> wakeAt() const;

    /// Says hello, again and again: onOpened() or onFault() follows.
    /// @param patience  until nobody is there
    void open(Time now, Time patience = std::chrono::seconds(2));
    /// Gives numbers anew and asks who is there: onCounted(), onCell() again and again, onExplored(); or onFault().
    void explore(Time now);

    /// How many cells the last exploration numbered, 0 before and during one.
    [[nodiscard]] std::size_t cells() const { return cells_; }

    /// Tells cells their words, so that each set is then one broadcast of 30 bytes. Throws std::logic_error for more
    /// than 64 sets.
    void prepare(std::vector<std::vector<LitCell>> sets);
    /// Lights these and no others: onShown() or onNotShown(), unless a newer one overtakes it.
    /// @param lit    by rising number, each once
    /// @param token  handed back
    /// @param when   they are lit then, or at once where cells hear of it later
    void light(const std::vector<LitCell>& lit, std::uint64_t token, Time now, std::optional<Time> when = {});

    /// Averages all accelerometers over so long: onRest().
    void measureRest(std::chrono::milliseconds period, Time now);
    /// onAcceleration() of each cell about every so often; 0: no longer.
    void streamRest(std::chrono::milliseconds period);
    /// onTouch(), likewise.
    /// @param change_pct  leave out who has changed by less, in percent of the range
    void streamTouch(std::chrono::milliseconds period, int change_pct = 0);

    /// LEDs off and streams ended, all that there is to say before a line is closed: said once, whatever the line can
    /// carry. Appends what is to be sent.
    void takeLeave(Time now, std::vector<std::uint8_t>& bytes);

    [[nodiscard]] const ReliableLink& link() const { return link_; }

  private:
    enum class Phase { Closed, Greeting, Open, Flooding, Describing, Explored };

    void take(const FrameHeader& header, std::string_view payload, Time now);
    void takeLocal(const FrameHeader& header, std::string_view payload, Time now);
    void takeFromCell(const FrameHeader& header, std::string_view payload, Time now);
    void takeCellInfo(CellNumber number, std::string_view payload, Time now);
    void takeRest(CellNumber number, std::string_view payload, Time when, Time now);
    void takeTouches(std::string_view payload, Time when);
    void sayHello(Time now);
    void counted(std::size_t cells, Time now);
    /// Some cells are in an exploration than which this one is no newer: once more, with one that is.
    void overtake(std::uint8_t epoch, Time now);
    void describe(Time now);
    void finishExploration();
    void pollCells(int subject, CellPoll& poll, Time now);
    void listen(Time now);
    /// Those that have described themselves.
    [[nodiscard]] std::vector<CellNumber> allCells() const;
    void fail(SkinFault fault);
    /// Everything of the last exploration.
    void forget();

    void sendLocal(FrameType type, std::string payload = {});
    void sendAll(FrameType type, std::string payload = {});
    void send(Message message);
    void sendOutgoing();
    /// The time of a cell's 32-bit clock on ours, given that it is about now.
    [[nodiscard]] static Time unwrap(std::uint32_t time_us, Time now);

    SkinListener& listener_;
    ReliableLink link_;
    Phase phase_ = Phase::Closed;
    Time due_{};       ///< of the phase, where something is waited for
    Time helloDue_{};  ///< while greeting, again
    int attempts_ = 0;
    std::uint8_t epoch_ = 0;
    std::size_t cells_ = 0;

    Time heard_{};  ///< when a frame came last
    Time pinged_{};

    SkinNetwork network_;
    std::vector<bool> described_;  ///< by number
    std::optional<CellPoll> info_;
    int rounds_ = 0;  ///< of asking those whose neighbours contradict them

    LightOrders lights_;
    std::vector<Message> outgoing_;  ///< of lights_, on their way to the link
    std::uint32_t run_ = 0;          ///< of measurements at rest
    std::uint16_t order_ = 0;        ///< of streams

    std::optional<CellPoll> rest_;
    std::vector<RestReading> readings_;
    Time nextMark_{};
    std::vector<CellTouch> touches_;
};

/// Cells of a network that say they hear another which does not hear them, or on another port: their words arrived
/// before their neighbours' did, or somebody is mistaken.
[[nodiscard]] std::vector<CellNumber> contradicted(const SkinNetwork& network);

}  // namespace skincal
