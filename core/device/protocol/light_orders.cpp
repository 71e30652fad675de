#include "core/device/protocol/light_orders.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/device/protocol/wire_parse.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

void append(std::vector<Message> more, std::vector<Message>& to) {
    std::move(more.begin(), more.end(), std::back_inserter(to));
}

constexpr LightOrders::Time kTally = 300ms;  // and for each cell:
constexpr LightOrders::Time kTallyEach = 40us;
constexpr LightOrders::Time kPatience = 250ms;
constexpr int kTallies = 4;

}  // namespace

LightOrders::LightOrders(SkinListener& listener, std::uint32_t seed)
    : listener_(listener),
      wordSet_(seed),
      pattern_(static_cast<std::uint16_t>(seed >> 8)),
      query_(static_cast<std::uint16_t>(seed >> 16)) {}

void LightOrders::begin(std::vector<CellNumber> cells, std::size_t count) {
    described_ = std::move(cells);
    cells_ = count;
    wordsTold_ = words_.empty();
}

void LightOrders::forget() {
    cells_ = 0;
    shown_.reset();
    latched_.reset();
}

void LightOrders::prepare(std::vector<std::vector<LitCell>> sets) {
    words_ = LedWords(std::move(sets), ++wordSet_);
    wordsTold_ = false;
}

void LightOrders::tellWords(Messages& send) {
    append(words_.messages(cells_), send);
    wordsTold_ = true;
}

void LightOrders::light(const std::vector<LitCell>& lit, std::uint64_t token, Time now, std::optional<Time> when,
                        Messages& send) {
    if (!wordsTold_)
        tellWords(send);
    shown_ = Shown{token, lit, ++pattern_, 0, 0, now, when};
    latched_.reset();
    showAgain(now, send);
}

void LightOrders::darken(Messages& send) {
    shown_.reset();
    latched_.reset();
    append(patternMessages({}, cells_, ++pattern_, words_), send);
}

void LightOrders::showAgain(Time now, Messages& send) {
    if (shown_->tries == kTallies) {
        dark_.clear();
        latched_.emplace(described_, kPatience, now);
        return;
    }
    // From the second time on, everything anew: masks and words may have been lost on the way.
    if (shown_->tries > 0 && words_.find(shown_->lit))
        tellWords(send);
    // What is over is at once; and 0 means that, too.
    const bool isLater = shown_->when && *shown_->when > now;
    for (Message& message : patternMessages(shown_->lit, cells_, shown_->number, words_)) {
        if (isLater && message.header.type == FrameType::Pattern)
            message.header.time_us = std::max(1U, static_cast<std::uint32_t>(shown_->when->count()));
        send.push_back(std::move(message));
    }
    ++shown_->tries;
    shown_->due =
        (isLater ? *shown_->when : now) + (kTally + static_cast<Time::rep>(cells_) * kTallyEach) * shown_->tries;
    send.push_back(tally());
}

Message LightOrders::tally() {
    shown_->query = ++query_;
    wire::Tally query;
    query.set_query(shown_->query);
    query.set_pattern(shown_->number);
    Message message;
    message.header.type = FrameType::Tally;
    message.header.direction = FrameDirection::Down;
    message.header.first = 1;
    message.header.count = static_cast<std::uint16_t>(cells_);
    message.payload = query.SerializeAsString();
    return message;
}

void LightOrders::takeTallied(std::string_view payload, Time now, Messages& send) {
    const auto answer = parseWire<wire::Tallied>(payload);
    if (!answer || !shown_ || latched_ || answer->query() != shown_->query)
        return;
    if (answer->cells() == cells_)
        listener_.onShown(std::exchange(shown_, std::nullopt)->token);
    else
        showAgain(now, send);
}

void LightOrders::takeLatched(CellNumber number, std::string_view payload, Time now) {
    const auto latched = parseWire<wire::Latched>(payload);
    if (!latched || !latched_ || !latched_->answered(number, now))
        return;
    const auto behind = static_cast<std::uint16_t>(latched->newest() - shown_->number);
    if (behind >= 64 || (latched->shown() >> behind & 1U) == 0)
        dark_.push_back(number);
}

void LightOrders::pollLatched(Time now, std::size_t waiting, Messages& send) {
    if (!latched_->isOver()) {
        if (waiting > CellPoll::kMostWaiting)
            return;
        for (const CellRange& range : latched_->poll(now))
            send.push_back(reportMessage(wire::LATCHED, 0, range));
        return;
    }
    const std::vector<CellNumber> silent = std::exchange(latched_, std::nullopt)->missing();
    const std::uint64_t token = std::exchange(shown_, std::nullopt)->token;
    dark_.insert(dark_.end(), silent.begin(), silent.end());
    std::sort(dark_.begin(), dark_.end());
    listener_.onNotShown(token, dark_);
}

void LightOrders::poll(Time now, std::size_t waiting, Messages& send) {
    if (shown_ && !latched_ && now >= shown_->due)
        showAgain(now, send);
    if (latched_)
        pollLatched(now, waiting, send);
}

std::optional<LightOrders::Time> LightOrders::wakeAt() const {
    if (latched_)
        return latched_->wakeAt();
    return shown_ ? std::optional(shown_->due) : std::nullopt;
}

}  // namespace skincal
