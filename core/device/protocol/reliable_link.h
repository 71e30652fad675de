#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/device/protocol/frame.h"

namespace skincal {

struct ReliableLinkOptions {
    std::chrono::microseconds timeout{30'000};  ///< until a frame that was not acknowledged is sent again
    int tries = 16;
    std::size_t window = 24;  ///< frames sent and not acknowledged, at most; below 32
    double bytesPerSecond = 300'000;

    [[nodiscard]] bool validate() const {
        return timeout.count() > 0 && tries > 0 && window > 0 && window < 32 && bytesPerSecond > 0;
    }
};

/// The computer's end of its link to the first cell: what is reliable is sent again until it is acknowledged, what
/// comes twice is taken once. Frames may overtake each other. It knows no clock: whoever owns it says what time it is.
/// The wait doubles with every fourth try; what was sent before something that arrived is known to be lost at once.
class ReliableLink {
  public:
    using Time = std::chrono::microseconds;
    using Sink = FrameDecoder::Sink;

    /// @param firstSequence  best at random: the other side may remember what was sent before
    /// Throws std::logic_error where options are out of range.
    explicit ReliableLink(const ReliableLinkOptions& options, std::uint16_t firstSequence);

    /// Queues a frame; sequence and link flags are set here, the time of a TimeMark whenever it is sent.
    void send(FrameHeader header, std::string payload);
    /// Forgets everything that was queued and not acknowledged.
    void clear();

    /// Calls `sink` for what is new. Acks are dealt with here.
    void receive(std::span<const std::uint8_t> bytes, Time now, const Sink& sink);

    /// Appends what is to be sent now, not more than the line carries by then.
    void poll(Time now, std::vector<std::uint8_t>& bytes);
    /// Appends all that waits, each once, whatever the line carries and the other side has room for: the last words
    /// before a line is closed.
    void flush(Time now, std::vector<std::uint8_t>& bytes);
    /// When to poll again at the latest; nothing where nothing waits.
    [[nodiscard]] std::optional<Time> wakeAt() const;

    /// Frames given up on so far: nobody acknowledged them.
    [[nodiscard]] std::uint64_t givenUp() const { return givenUp_; }
    [[nodiscard]] std::uint64_t sentAgain() const { return sentAgain_; }
    /// Queued and not acknowledged yet.
    [[nodiscard]] std::size_t waiting() const { return queue_.size(); }
    [[nodiscard]] const FrameDecoder::Counts& received() const { return decoder_.counts(); }

  private:
    struct Outgoing {
        FrameHeader header;
        std::string payload;
        int tries = 0;
        std::uint64_t sent = 0;  ///< as the so manieth frame, the last time
        Time due{};
    };

    [[nodiscard]] bool isNew(const FrameHeader& header);
    void markReceived(std::uint16_t sequence, Time now);
    void acknowledged(const FrameHeader& ack, Time now);
    void sendAck(std::vector<std::uint8_t>& bytes);
    void sendFrame(Outgoing& frame, Time now, std::vector<std::uint8_t>& bytes);
    [[nodiscard]] Time timeFor(std::size_t bytes) const;
    [[nodiscard]] bool mayGo(const Outgoing& frame) const;

    ReliableLinkOptions options_;
    FrameDecoder decoder_;
    std::deque<Outgoing> queue_;
    std::size_t underWay_ = 0;
    std::uint16_t nextSequence_;
    bool acknowledged_ = false;  ///< anything, ever
    std::size_t room_ = 4;       ///< that the other side says it has
    Time lineFree_{};
    std::uint64_t sent_ = 0;

    bool begun_ = false;
    std::uint16_t highest_ = 0;
    std::uint32_t seen_ = 0;  ///< bit i: highest_ - 1 - i has come
    std::size_t owed_ = 0;    ///< frames that came since the last ack
    Time ackDue_{};
    std::uint64_t givenUp_ = 0;
    std::uint64_t sentAgain_ = 0;
};

}  // namespace skincal
