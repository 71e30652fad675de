#include "core/device/protocol/skin_client.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/device/protocol/wire_parse.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

constexpr SkinClient::Time kFlood = 10s;
constexpr SkinClient::Time kPatience = 250ms;
constexpr SkinClient::Time kMarkEvery = 10s;
/// Of silence, until the first cell is asked for a sign of life, and until it counts as gone.
constexpr SkinClient::Time kQuiet = 250ms;
/// Whoever boots hears nothing: hello is said again for as long as somebody may come.
constexpr SkinClient::Time kHelloAgain = 500ms;
constexpr SkinClient::Time kSilent = 900ms;
constexpr int kExplorations = 3;
constexpr int kContradictions = 4;

/// What cells send wrong is counted and dropped; the library's remarks on it would only fill the error output.
void silenceProtobuf() {
    static const auto before = google::protobuf::SetLogHandler(nullptr);
    static_cast<void>(before);
}

std::string hex(std::string_view bytes) {
    std::string text;
    for (const char byte : bytes)
        fmt::format_to(std::back_inserter(text), "{:02x}", static_cast<std::uint8_t>(byte));
    return text;
}

}  // namespace

SkinClient::SkinClient(SkinListener& listener, const ReliableLinkOptions& link, std::uint32_t seed)
    : listener_(listener), link_(link, static_cast<std::uint16_t>(seed)), lights_(listener, seed), run_(seed) {
    silenceProtobuf();
}

void SkinClient::send(Message message) {
    message.header.epoch = epoch_;
    link_.send(message.header, std::move(message.payload));
}

void SkinClient::sendOutgoing() {
    for (Message& message : outgoing_)
        send(std::move(message));
    outgoing_.clear();
}

void SkinClient::sendLocal(FrameType type, std::string payload) {
    Message message;
    message.header.type = type;
    message.payload = std::move(payload);
    send(std::move(message));
}

void SkinClient::sendAll(FrameType type, std::string payload) {
    Message message;
    message.header.type = type;
    message.header.direction = FrameDirection::Down;
    message.header.first = 1;
    message.header.count = static_cast<std::uint16_t>(cells_);
    message.payload = std::move(payload);
    send(std::move(message));
}

void SkinClient::fail(SkinFault fault) {
    phase_ = phase_ == Phase::Greeting ? Phase::Closed : Phase::Open;
    forget();
    listener_.onFault(fault);
}

void SkinClient::forget() {
    cells_ = 0;
    info_.reset();
    rest_.reset();
    lights_.forget();
    link_.clear();
}

void SkinClient::open(Time now, Time patience) {
    phase_ = Phase::Greeting;
    due_ = now + patience;
    sayHello(now);
}

void SkinClient::sayHello(Time now) {
    link_.clear();
    helloDue_ = now + kHelloAgain;
    wire::Hello hello;
    hello.set_oldest_version(FrameHeader::kVersion);
    hello.set_newest_version(FrameHeader::kVersion);
    hello.set_schema(SKINCAL_SCHEMA_HASH);
    hello.set_name("SkinCal");
    hello.set_please_answer(true);
    sendLocal(FrameType::Hello, hello.SerializeAsString());
}

void SkinClient::explore(Time now) {
    if (phase_ == Phase::Closed || phase_ == Phase::Greeting)
        return;
    if (phase_ != Phase::Flooding && phase_ != Phase::Describing)
        attempts_ = 0;
    forget();
    epoch_ = static_cast<std::uint8_t>(epoch_ == 255 ? 1 : epoch_ + 1);
    phase_ = Phase::Flooding;
    due_ = now + kFlood;
    sendLocal(FrameType::Explore);
}

void SkinClient::receive(std::span<const std::uint8_t> bytes, Time now) {
    const std::uint64_t before = link_.received().frames;
    link_.receive(bytes, now, [&](const FrameHeader& header, std::string_view payload) { take(header, payload, now); });
    if (link_.received().frames != before)
        heard_ = now;
}

void SkinClient::take(const FrameHeader& header, std::string_view payload, Time now) {
    if (header.version != FrameHeader::kVersion) {
        if (phase_ == Phase::Greeting)
            fail(SkinFault::OtherVersion);
        return;
    }
    if (header.incompatible != 0)
        return;
    if (header.direction == FrameDirection::Local)
        takeLocal(header, payload, now);
    else if (header.direction == FrameDirection::Up && header.epoch == epoch_ && header.first >= 1 &&
             header.first <= cells_)
        takeFromCell(header, payload, now);
}

void SkinClient::takeLocal(const FrameHeader& header, std::string_view payload, Time now) {
    switch (header.type) {
        case FrameType::Hello: {
            const auto hello = parseWire<wire::Hello>(payload);
            if (phase_ != Phase::Greeting || !hello || hello->please_answer())
                return;
            if (hello->oldest_version() > FrameHeader::kVersion || hello->newest_version() < FrameHeader::kVersion) {
                fail(SkinFault::OtherVersion);
                return;
            }
            phase_ = Phase::Open;
            heard_ = now;
            epoch_ = header.epoch;  // of an earlier session: ours are newer
            listener_.onOpened(hello->name());
            return;
        }
        case FrameType::Refused: {
            const auto refused = parseWire<wire::Refused>(payload);
            if (phase_ == Phase::Greeting && refused && refused->reason() == wire::Refused::OTHER_VERSION)
                fail(SkinFault::OtherVersion);
            return;
        }
        case FrameType::Subtree:
            if (const auto subtree = parseWire<wire::Subtree>(payload);
                subtree && header.epoch == epoch_ && phase_ == Phase::Flooding) {
                const auto newest = static_cast<std::uint8_t>(subtree->newest_epoch());
                if (newest != 0)
                    overtake(newest, now);
                else
                    counted(subtree->cells(), now);
            }
            return;
        case FrameType::Explored:
            // It took us for somebody who came late: some other computer explores, or an old frame was about.
            if (const auto explored = parseWire<wire::Explored>(payload);
                explored && header.epoch == epoch_ && phase_ == Phase::Flooding && !explored->child())
                due_ = now;
            return;
        case FrameType::Tallied:
            if (header.epoch != epoch_)
                return;
            lights_.takeTallied(payload, now, outgoing_);
            sendOutgoing();
            return;
        case FrameType::Booted:
            if (phase_ == Phase::Describing || phase_ == Phase::Explored) {
                phase_ = Phase::Open;
                forget();
            }
            if (phase_ == Phase::Greeting)
                sayHello(now);  // the last one came too early
            else if (phase_ != Phase::Closed)
                listener_.onRestarted();
            return;
        default:
            return;
    }
}

void SkinClient::overtake(std::uint8_t epoch, Time now) {
    epoch_ = epoch;
    if (++attempts_ < kExplorations)
        explore(now);
    else
        fail(SkinFault::Stalled);
}

void SkinClient::counted(std::size_t cells, Time now) {
    if (cells == 0 || cells > 0xFFFE)
        return;
    cells_ = cells;
    network_ = {};
    described_.assign(cells + 1, false);
    network_.cells.resize(cells);
    rounds_ = 0;
    wire::Assign assign;
    assign.set_first(1);
    sendLocal(FrameType::Assign, assign.SerializeAsString());
    sendLocal(FrameType::Neighbour, wire::Neighbour().SerializeAsString());
    sendAll(FrameType::TimeMark);
    nextMark_ = now + kMarkEvery;
    std::vector<CellNumber> all(cells);
    for (std::size_t i = 0; i < cells; ++i)
        all[i] = static_cast<CellNumber>(i + 1);
    info_.emplace(std::move(all), kPatience, now);
    phase_ = Phase::Describing;
    listener_.onCounted(cells);
}

void SkinClient::takeFromCell(const FrameHeader& header, std::string_view payload, Time now) {
    switch (header.type) {
        case FrameType::CellInfo:
            takeCellInfo(header.first, payload, now);
            return;
        case FrameType::Rest:
            takeRest(header.first, payload, unwrap(header.time_us, now), now);
            return;
        case FrameType::Latched:
            lights_.takeLatched(header.first, payload, now);
            return;
        case FrameType::Tactile:
            takeTouches(payload, unwrap(header.time_us, now));
            return;
        case FrameType::Restarted:
            listener_.onRestarted();
            return;
        default:
            return;
    }
}

void SkinClient::takeCellInfo(CellNumber number, std::string_view payload, Time now) {
    const auto info = parseWire<wire::CellInfo>(payload);
    if (phase_ != Phase::Describing || !info || info->unique_id().size() != 12)
        return;
    NetworkCell cell;
    cell.number = number;
    cell.uniqueId = hex(info->unique_id());
    cell.type = info->type();
    cell.ports = static_cast<int>(std::min<std::uint32_t>(info->ports(), 255));
    cell.firmware = info->firmware();
    for (const auto& heard : info->heard())
        if (heard.port() < static_cast<std::uint32_t>(cell.ports) && heard.cell() <= cells_ &&
            heard.neighbour_port() < 256)
            cell.heard.push_back({static_cast<int>(heard.port()), static_cast<CellNumber>(heard.cell()),
                                  static_cast<int>(heard.neighbour_port())});
    const bool known = described_[number];
    described_[number] = true;
    network_.cells[number - std::size_t{1}] = cell;
    if (info_)
        info_->answered(number, now);
    if (!known)
        listener_.onCell(cell);
}

void SkinClient::describe(Time now) {
    if (!info_)
        return;
    if (!info_->isOver()) {
        pollCells(wire::CELL_INFO, *info_, now);
        return;
    }
    // Those that are missing have had their chances; of those that are there, some may have spoken too early.
    std::vector<CellNumber> again;
    if (rounds_++ < kContradictions) {
        SkinNetwork described = network_;
        std::erase_if(described.cells, [&](const NetworkCell& cell) { return !described_[cell.number]; });
        again = contradicted(described);
        std::erase_if(again, [&](CellNumber cell) { return !described_[cell]; });
    }
    if (again.empty())
        finishExploration();
    else
        info_.emplace(std::move(again), kPatience, now);
}

void SkinClient::finishExploration() {
    info_.reset();
    for (std::size_t number = 1; number <= cells_; ++number)
        if (!described_[number])
            network_.missing.push_back(static_cast<CellNumber>(number));
    std::erase_if(network_.cells, [&](const NetworkCell& cell) { return cell.number == 0; });
    phase_ = Phase::Explored;
    lights_.begin(allCells(), cells_);
    listener_.onExplored(network_);
}

void SkinClient::pollCells(int subject, CellPoll& poll, Time now) {
    if (link_.waiting() > CellPoll::kMostWaiting)
        return;
    for (const CellRange& range : poll.poll(now))
        send(reportMessage(static_cast<wire::Subject>(subject), run_, range));
}

void SkinClient::prepare(std::vector<std::vector<LitCell>> sets) {
    lights_.prepare(std::move(sets));
}

void SkinClient::light(const std::vector<LitCell>& lit, std::uint64_t token, Time now, std::optional<Time> when) {
    if (phase_ != Phase::Explored)
        return;
    lights_.light(lit, token, now, when, outgoing_);
    sendOutgoing();
}

std::vector<CellNumber> SkinClient::allCells() const {
    std::vector<CellNumber> all;
    for (const NetworkCell& cell : network_.cells)
        all.push_back(cell.number);
    return all;
}

void SkinClient::measureRest(std::chrono::milliseconds period, Time now) {
    if (phase_ != Phase::Explored)
        return;
    wire::Measure measure;
    measure.set_period_ms(static_cast<std::uint32_t>(period.count()));
    measure.set_run(++run_);
    sendAll(FrameType::Measure, measure.SerializeAsString());
    readings_.clear();
    rest_.emplace(allCells(), kPatience + period, now);
}

void SkinClient::streamRest(std::chrono::milliseconds period) {
    wire::Stream stream;
    stream.set_subject(wire::REST);
    stream.set_period_ms(static_cast<std::uint32_t>(period.count()));
    stream.set_order(++order_);
    if (phase_ == Phase::Explored)
        sendAll(FrameType::Stream, stream.SerializeAsString());
}

void SkinClient::streamTouch(std::chrono::milliseconds period, int change_pct) {
    wire::Stream stream;
    stream.set_subject(wire::TACTILE);
    stream.set_period_ms(static_cast<std::uint32_t>(period.count()));
    stream.set_change_pct(static_cast<std::uint32_t>(change_pct));
    stream.set_order(++order_);
    if (phase_ == Phase::Explored)
        sendAll(FrameType::Stream, stream.SerializeAsString());
}

void SkinClient::takeRest(CellNumber number, std::string_view payload, Time when, Time now) {
    const auto rest = parseWire<wire::Rest>(payload);
    if (phase_ != Phase::Explored || !rest || rest->count() == 0 || rest->mean_size() != 3 ||
        rest->variance_size() != 3)
        return;
    RestReading reading{number, rest->count(), {}, {}, static_cast<double>(rest->temperature())};
    for (int i = 0; i < 3; ++i) {
        reading.mean[i] = static_cast<double>(rest->mean(i));
        reading.variance[i] = static_cast<double>(rest->variance(i));
    }
    if (!reading.mean.allFinite() || !reading.variance.allFinite())
        return;
    if (rest->run() == 0)
        listener_.onAcceleration(reading, when);
    else if (rest_ && rest->run() == run_ && rest_->answered(number, now))
        readings_.push_back(reading);
}

void SkinClient::takeTouches(std::string_view payload, Time when) {
    // Tag and length of the one field; cells write no others, and this is the busiest message there is.
    if (payload.size() < 2 || payload[0] != 0x0A)
        return;
    std::size_t at = 1;
    std::size_t length = static_cast<std::uint8_t>(payload[at++]);
    if (length >= 128 && at < payload.size())
        length = (length & 0x7F) | static_cast<std::size_t>(static_cast<std::uint8_t>(payload[at++])) << 7;
    if (length != payload.size() - at || length % 20 != 0)
        return;
    touches_.clear();
    for (; at < payload.size(); at += 20) {
        const auto u16 = [&](std::size_t i) {
            return static_cast<std::uint16_t>(static_cast<std::uint8_t>(payload[at + i]) |
                                              static_cast<std::uint8_t>(payload[at + i + 1]) << 8);
        };
        const auto s16 = [&](std::size_t i) { return static_cast<float>(static_cast<std::int16_t>(u16(i))); };
        CellTouch touch;
        touch.cell = u16(0);
        if (touch.cell == 0 || touch.cell > cells_)
            continue;
        touch.proximity = static_cast<float>(u16(2)) / 65535.0F;
        for (std::size_t i = 0; i < 3; ++i) {
            touch.force[i] = static_cast<float>(u16(4 + 2 * i)) / 1000.0F;
            touch.acceleration[i] = s16(12 + 2 * i) / 100.0F;
        }
        touch.temperature = s16(10) / 100.0F;
        touches_.push_back(touch);
    }
    listener_.onTouch(touches_, when);
}

void SkinClient::listen(Time now) {
    if (phase_ == Phase::Closed || phase_ == Phase::Greeting)
        return;
    if (now >= heard_ + kSilent) {
        fail(SkinFault::Silenced);
        heard_ = now;
    } else if (now >= std::max(heard_, pinged_) + kQuiet) {
        pinged_ = now;
        wire::Hello hello;  // without a question: its acknowledgement will do
        hello.set_oldest_version(FrameHeader::kVersion);
        hello.set_newest_version(FrameHeader::kVersion);
        sendLocal(FrameType::Hello, hello.SerializeAsString());
    }
}

void SkinClient::poll(Time now, std::vector<std::uint8_t>& bytes) {
    listen(now);
    switch (phase_) {
        case Phase::Greeting:
            if (now >= due_) {
                const auto& received = link_.received();
                fail(received.frames == 0 && received.bytes > received.empty ? SkinFault::Garbled
                                                                             : SkinFault::NoAnswer);
            } else if (now >= helloDue_) {
                sayHello(now);
            }
            break;
        case Phase::Flooding:
            if (now >= due_) {
                if (++attempts_ < kExplorations)
                    explore(now);
                else
                    fail(SkinFault::Stalled);
            }
            break;
        case Phase::Describing:
            describe(now);
            break;
        case Phase::Explored:
            lights_.poll(now, link_.waiting(), outgoing_);
            sendOutgoing();
            if (rest_ && !rest_->isOver())
                pollCells(wire::REST, *rest_, now);
            if (rest_ && rest_->isOver()) {
                const std::vector<CellNumber> missing = std::exchange(rest_, std::nullopt)->missing();
                listener_.onRest(readings_, missing);
            }
            if (now >= nextMark_) {
                sendAll(FrameType::TimeMark);
                nextMark_ = now + kMarkEvery;
            }
            break;
        case Phase::Closed:
        case Phase::Open:
            break;
    }
    link_.poll(now, bytes);
}

void SkinClient::takeLeave(Time now, std::vector<std::uint8_t>& bytes) {
    if (phase_ != Phase::Explored)
        return;
    link_.clear();
    streamRest(std::chrono::milliseconds(0));
    streamTouch(std::chrono::milliseconds(0));
    lights_.darken(outgoing_);
    sendOutgoing();
    link_.flush(now, bytes);
    phase_ = Phase::Closed;
}

std::optional<SkinClient::Time> SkinClient::wakeAt() const {
    std::optional<Time> wake = link_.wakeAt();
    const auto consider = [&](Time when) { wake = wake ? std::min(*wake, when) : when; };
    if (phase_ == Phase::Greeting || phase_ == Phase::Flooding)
        consider(due_);
    if (phase_ == Phase::Greeting)
        consider(helloDue_);
    if (phase_ != Phase::Closed && phase_ != Phase::Greeting)
        consider(std::min(std::max(heard_, pinged_) + kQuiet, heard_ + kSilent));
    if (phase_ == Phase::Describing && info_)
        consider(info_->wakeAt());
    if (phase_ == Phase::Explored) {
        consider(nextMark_);
        if (const auto lights = lights_.wakeAt())
            consider(*lights);
        if (rest_)
            consider(rest_->wakeAt());
    }
    return wake;
}

SkinClient::Time SkinClient::unwrap(std::uint32_t time_us, Time now) {
    const auto behind = static_cast<std::int32_t>(static_cast<std::uint32_t>(now.count()) - time_us);
    return now - Time(behind);
}

std::vector<CellNumber> contradicted(const SkinNetwork& network) {
    std::vector<const NetworkCell*> byNumber;
    for (const NetworkCell& cell : network.cells) {
        if (cell.number >= byNumber.size())
            byNumber.resize(cell.number + std::size_t{1}, nullptr);
        byNumber[cell.number] = &cell;
    }
    std::vector<CellNumber> found;
    for (const NetworkCell& cell : network.cells)
        for (const NetworkCell::Heard& heard : cell.heard) {
            if (heard.cell == 0 || heard.cell >= byNumber.size() || byNumber[heard.cell] == nullptr)
                continue;
            const auto& theirs = byNumber[heard.cell]->heard;
            const bool agrees = std::any_of(theirs.begin(), theirs.end(), [&](const NetworkCell::Heard& back) {
                return back.cell == cell.number && back.port == heard.port_there && back.port_there == heard.port;
            });
            if (!agrees) {
                found.push_back(cell.number);
                found.push_back(heard.cell);
            }
        }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

}  // namespace skincal
