#include "core/device/protocol/reliable_link.h"

#include <algorithm>
#include <stdexcept>

namespace skincal {
namespace {

constexpr int kWindow = 32;
constexpr std::chrono::microseconds kAckDelay{500};
constexpr std::size_t kAckAfter = 8;
/// So much may wait in the adapter: the line never falls idle between two turns of an event loop.
constexpr std::chrono::microseconds kAhead{4000};

/// How far a is ahead of b, modulo 2^16.
int ahead(std::uint16_t a, std::uint16_t b) {
    return static_cast<std::int16_t>(static_cast<std::uint16_t>(a - b));
}

}  // namespace

ReliableLink::ReliableLink(const ReliableLinkOptions& options, std::uint16_t firstSequence)
    : options_(options), nextSequence_(firstSequence) {
    if (!options.validate())
        throw std::logic_error("link options out of range");
}

void ReliableLink::send(FrameHeader header, std::string payload) {
    header.compatible = FrameHeader::kReliable;
    header.sequence = nextSequence_++;
    queue_.push_back({header, std::move(payload)});
}

void ReliableLink::clear() {
    queue_.clear();
    underWay_ = 0;
}

void ReliableLink::receive(std::span<const std::uint8_t> bytes, Time now, const Sink& sink) {
    decoder_.feed(bytes, [&](const FrameHeader& header, std::string_view payload) {
        if (header.version != FrameHeader::kVersion) {
            sink(header, payload);
        } else if (header.type == FrameType::Ack) {
            acknowledged(header, now);
        } else if (!(header.compatible & FrameHeader::kReliable)) {
            sink(header, payload);
        } else {
            const bool fresh = isNew(header);
            markReceived(header.sequence, now);
            if (fresh)
                sink(header, payload);
        }
    });
}

bool ReliableLink::isNew(const FrameHeader& header) {
    if (!begun_)
        return true;
    const int by = ahead(header.sequence, highest_);
    if (by > 0)
        return true;
    if (by == 0)
        return false;
    if (by >= -kWindow)
        return !(seen_ >> (-by - 1) & 1U);
    // Too old, or from a cell that has started anew.
    if (header.compatible & FrameHeader::kFirst) {
        begun_ = false;
        return true;
    }
    return false;
}

void ReliableLink::markReceived(std::uint16_t sequence, Time now) {
    if (owed_++ == 0)
        ackDue_ = now + kAckDelay;
    if (!begun_) {
        begun_ = true;
        highest_ = sequence;
        seen_ = 0;
        return;
    }
    const int by = ahead(sequence, highest_);
    if (by > 0) {
        const auto wide = (static_cast<std::uint64_t>(seen_) << 1 | 1U) << (by <= kWindow ? by - 1 : 0);
        seen_ = by <= kWindow ? static_cast<std::uint32_t>(wide) : 0;
        highest_ = sequence;
    } else if (by < 0 && by >= -kWindow) {
        seen_ |= 1U << (-by - 1);
    }
}

void ReliableLink::acknowledged(const FrameHeader& ack, Time now) {
    acknowledged_ = true;
    room_ = ack.count;
    std::uint64_t latest = 0;
    const auto hasArrived = [&](const Outgoing& frame) {
        const int behind = ahead(ack.sequence, frame.header.sequence);
        if (frame.tries == 0 || behind < 0 || behind > kWindow || (behind > 0 && !(ack.time_us >> (behind - 1) & 1U)))
            return false;
        latest = std::max(latest, frame.sent);
        return true;
    };
    underWay_ -= static_cast<std::size_t>(std::erase_if(queue_, hasArrived));
    if (room_ == 0)
        return;
    // Nothing overtakes on a wire.
    for (Outgoing& frame : queue_)
        if (frame.tries > 0 && frame.sent < latest)
            frame.due = std::min(frame.due, now);
}

void ReliableLink::sendAck(std::vector<std::uint8_t>& bytes) {
    FrameHeader ack;
    ack.type = FrameType::Ack;
    ack.sequence = highest_;
    ack.count = 255;  // a computer always has room
    ack.time_us = seen_;
    appendFrame(ack, {}, bytes);
    owed_ = 0;
}

/// A frame that has not been sent waits while the window is full or the other side has no room.
bool ReliableLink::mayGo(const Outgoing& frame) const {
    if (frame.tries > 0)
        return true;
    if (underWay_ >= std::min(options_.window, std::max<std::size_t>(room_, 1)))
        return false;
    const auto earliest = std::find_if(queue_.begin(), queue_.end(), [](const Outgoing& q) { return q.tries > 0; });
    return earliest == queue_.end() || ahead(frame.header.sequence, earliest->header.sequence) < kWindow;
}

ReliableLink::Time ReliableLink::timeFor(std::size_t bytes) const {
    return Time(static_cast<Time::rep>(1e6 * static_cast<double>(bytes) / options_.bytesPerSecond));
}

void ReliableLink::sendFrame(Outgoing& frame, Time now, std::vector<std::uint8_t>& bytes) {
    if (!acknowledged_)
        frame.header.compatible |= FrameHeader::kFirst;
    else
        frame.header.compatible &= static_cast<std::uint8_t>(~FrameHeader::kFirst);
    if (frame.header.type == FrameType::TimeMark)
        frame.header.time_us = static_cast<std::uint32_t>((std::max(lineFree_, now) + timeFor(kEmptyFrame)).count());
    const std::size_t before = bytes.size();
    appendFrame(frame.header, frame.payload, bytes);
    lineFree_ = std::max(lineFree_, now) + timeFor(bytes.size() - before);
    sentAgain_ += frame.tries > 0 ? 1 : 0;
    underWay_ += frame.tries == 0 ? 1 : 0;
    frame.due = lineFree_ + options_.timeout * (1 << frame.tries / 4);
    frame.sent = ++sent_;
    ++frame.tries;
}

void ReliableLink::flush(Time now, std::vector<std::uint8_t>& bytes) {
    for (Outgoing& frame : queue_)
        sendFrame(frame, now, bytes);
}

void ReliableLink::poll(Time now, std::vector<std::uint8_t>& bytes) {
    if (owed_ >= kAckAfter || (owed_ > 0 && now >= ackDue_)) {
        const std::size_t before = bytes.size();
        sendAck(bytes);
        lineFree_ = std::max(lineFree_, now) + timeFor(bytes.size() - before);
    }
    for (std::size_t i = 0; i < queue_.size() && lineFree_ <= now + kAhead;) {
        Outgoing& frame = queue_[i];
        if (frame.due > now || !mayGo(frame)) {
            if (frame.tries == 0)
                break;
            ++i;
            continue;
        }
        if (frame.tries >= options_.tries) {
            ++givenUp_;
            --underWay_;
            queue_.erase(queue_.begin() + static_cast<std::ptrdiff_t>(i));
            continue;
        }
        sendFrame(frame, now, bytes);
        ++i;
    }
}

std::optional<ReliableLink::Time> ReliableLink::wakeAt() const {
    std::optional<Time> wake;
    const auto consider = [&](Time when) { wake = wake ? std::min(*wake, when) : when; };
    if (owed_ > 0)
        consider(ackDue_);
    for (const Outgoing& frame : queue_)
        if (mayGo(frame))
            consider(std::max(frame.due, lineFree_ - kAhead));
    return wake;
}

}  // namespace skincal
