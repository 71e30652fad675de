#include "core/device/skin_worker.h"

#include <QFileInfo>
#include <QRandomGenerator>
#include <algorithm>

#include "core/device/serial_line.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

constexpr auto kFlush = 20ms;
/// For the first answer: opening the port restarts many a board, whose boot loader waits two seconds for an upload; a
/// program may have to wait for a driver of its own.
constexpr SkinClient::Time kBoot = 5s;
constexpr SkinClient::Time kProgramStart = 15s;
constexpr auto kWatch = 500ms;
/// Where the port is there and does not serve: another program may have it. Sockets and programs can only be tried.
constexpr auto kWatchAgain = 3s;
/// Cells that restart so often, with no more than so long in between, do so because of what they are told to do.
constexpr int kMostRestarts = 10;
constexpr SkinClient::Time kPeace = 20s;
constexpr auto kRestPeriod = 100ms;
/// Of what the line carries, for streams: the rest is for lights and questions.
constexpr double kStreamShare = 0.7;
constexpr double kRestBytes = 66;  ///< of a Rest frame, with its share of an acknowledgement

QString wordsFor(SkinFault fault, const LineAddress& address) {
    switch (fault) {
        case SkinFault::NoAnswer:
            return SkinWorker::tr("nothing answers at %1: is the skin powered, and is this its port?")
                .arg(address.text);
        case SkinFault::Garbled:
            return address.kind == LineAddress::Kind::Serial
                       ? SkinWorker::tr(
                             "what comes from %1 can't be read at %2 baud: another speed (%1@115200), or no skin")
                             .arg(address.target)
                             .arg(address.number)
                       : SkinWorker::tr("what comes from %1 is not the skin protocol").arg(address.text);
        case SkinFault::OtherVersion:
            return SkinWorker::tr(
                       "the skin at %1 speaks another version of the protocol: update its firmware, or this "
                       "program")
                .arg(address.text);
        case SkinFault::Stalled:
            return SkinWorker::tr("the skin at %1 answers, but its cells don't").arg(address.text);
        case SkinFault::Silenced:
            return SkinWorker::tr("the skin at %1 no longer answers").arg(address.text);
    }
    return {};
}

}  // namespace

SkinWorker::SkinWorker(LineAddress address) : address_(std::move(address)), timer_(this), flush_(this), watch_(this) {
    timer_.setSingleShot(true);
    timer_.setTimerType(Qt::PreciseTimer);
    connect(&timer_, &QTimer::timeout, this, &SkinWorker::pump);
    connect(&watch_, &QTimer::timeout, this, &SkinWorker::lookForPort);
    flush_.setInterval(kFlush);
    connect(&flush_, &QTimer::timeout, this, &SkinWorker::flushStreams);
}

SkinWorker::~SkinWorker() {
    shut();
}

SkinWorker::Time SkinWorker::now() {
    return std::chrono::duration_cast<Time>(std::chrono::steady_clock::now().time_since_epoch());
}

void SkinWorker::open(quint64 opening) {
    shut();
    opening_ = opening;
    hasAnswered_ = false;
    restarts_ = 0;
    line_ = makeLine(address_);
    connect(line_.get(), &Line::opened, this, [this] {
        ReliableLinkOptions options;
        options.bytesPerSecond = line_->bytesPerSecond();
        // Three of the longest frames and what an adapter and a busy computer hold back.
        options.timeout = Time(static_cast<Time::rep>(3e6 * kMaxEncodedFrame / options.bytesPerSecond)) + 20ms;
        SkinListener& listener = *this;
        client_ = std::make_unique<SkinClient>(listener, options, QRandomGenerator::global()->generate());
        client_->open(now(), address_.kind == LineAddress::Kind::Program ? kProgramStart : kBoot);
        pump();
    });
    connect(line_.get(), &Line::received, this, [this](const QByteArray& bytes) {
        if (!client_)
            return;
        const auto* raw = reinterpret_cast<const std::uint8_t*>(bytes.constData());
        client_->receive({raw, static_cast<std::size_t>(bytes.size())}, now());
        pump();
    });
    connect(line_.get(), &Line::failed, this, &SkinWorker::lose);
    line_->open();
}

void SkinWorker::close() {
    isReturning_ = false;
    shut();
}

void SkinWorker::shut() {
    if (client_ && line_) {
        std::vector<std::uint8_t> bytes;
        client_->takeLeave(now(), bytes);
        line_->write({reinterpret_cast<const char*>(bytes.data()), static_cast<qsizetype>(bytes.size())});
    }
    timer_.stop();
    flush_.stop();
    watch_.stop();
    client_.reset();
    if (line_) {
        line_->disconnect(this);
        line_->close();
        line_->setParent(this);  // a thread that ends deletes nothing later
        line_.release()->deleteLater();
    }
    streamsRest_ = false;
    streamsTouch_ = false;
    isExploreDue_ = false;
    forgetNumbers();
}

void SkinWorker::forgetNumbers() {
    ++exploration_;
    readings_.clear();
    touches_.clear();
}

void SkinWorker::lose(LineFault fault, const QString& detail) {
    // Whatever ends a line that was open: systems have many words for a plug that was pulled. But a program that ends,
    // or a gateway that hangs up, before it has said a word will do so again.
    const bool wasOpen = client_ != nullptr && (hasAnswered_ || address_.kind == LineAddress::Kind::Serial);
    fail(lineHelp(fault, address_, detail));
    const bool isAgain = isReturning_;
    isReturning_ = isAgain || wasOpen;
    if (isReturning_)
        watchPort(isAgain && fault != LineFault::Ended ? kWatchAgain : kWatch);
}

void SkinWorker::watchPort(std::chrono::milliseconds interval) {
    watch_.start(address_.kind == LineAddress::Kind::Serial ? interval : kWatchAgain);
}

void SkinWorker::lookForPort() {
    // Readable, too: udev sets permissions a moment after the port is there.
    const QFileInfo port(SerialLine::fullPath(address_.target));
    if (address_.kind == LineAddress::Kind::Serial && (!port.isReadable() || !port.isWritable()))
        return;
    watch_.stop();
    emit cameBack();
}

void SkinWorker::fail(const QString& why) {
    shut();
    emit failed(why, opening_);
}

void SkinWorker::pump() {
    if (!client_ || !line_)
        return;
    std::vector<std::uint8_t> bytes;
    client_->poll(now(), bytes);
    if (!client_)  // a fault closed it
        return;
    if (!bytes.empty())
        line_->write({reinterpret_cast<const char*>(bytes.data()), static_cast<qsizetype>(bytes.size())});
    if (const auto wake = client_->wakeAt()) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(std::max(*wake - now(), Time(0)));
        timer_.start(left);
    } else {
        timer_.stop();
    }
}

void SkinWorker::explore() {
    isExploreDue_ = false;
    if (!client_)
        return;
    forgetNumbers();
    client_->explore(now());
    pump();
}

void SkinWorker::prepare(const std::vector<std::vector<LitCell>>& sets) {
    if (client_)
        client_->prepare(sets);
}

void SkinWorker::light(const std::vector<LitCell>& lit, quint64 token, quint64 exploration,
                       std::optional<std::chrono::microseconds> when) {
    if (!client_ || exploration != exploration_)
        return;
    client_->light(lit, token, now(), when);
    pump();
}

std::chrono::milliseconds SkinWorker::restPeriod() const {
    const double busy = static_cast<double>(client_->cells()) * kRestBytes / (line_->bytesPerSecond() * kStreamShare);
    return std::max(std::chrono::milliseconds(kRestPeriod), std::chrono::milliseconds(static_cast<int>(1000 * busy)));
}

void SkinWorker::streamRest(bool on) {
    streamsRest_ = on;
    readings_.clear();
    if (!client_)
        return;
    client_->streamRest(on ? restPeriod() : 0ms);
    if (on)
        flush_.start();
    pump();
}

void SkinWorker::streamTouch(bool on) {
    streamsTouch_ = on;
    if (!client_)
        return;
    // 22 bytes around the samples of up to six cells.
    const double busy = static_cast<double>(client_->cells()) * 26 / (line_->bytesPerSecond() * kStreamShare);
    const auto period = std::max(10ms, std::chrono::milliseconds(static_cast<int>(1000 * busy)));
    client_->streamTouch(on ? period : 0ms);
    if (on)
        flush_.start();
    pump();
}

void SkinWorker::flushStreams() {
    if (!client_)
        return;
    if (!readings_.empty() && now() >= readingsDue_) {
        readingsDue_ = now() + restPeriod();
        std::vector<RestReading> readings;
        for (const auto& [cell, reading] : readings_)
            readings.push_back(reading);
        readings_.clear();
        emit accelerationCame(readings, readingsAt_.count());
    }
    if (!touches_.empty())
        emit touchCame(std::exchange(touches_, {}), touchesAt_.count());
    if (!streamsRest_ && !streamsTouch_)
        flush_.stop();
}

void SkinWorker::onOpened(const std::string& firmware) {
    hasAnswered_ = true;
    isReturning_ = false;
    emit opened(QString::fromStdString(firmware), opening_);
}

void SkinWorker::onFault(SkinFault fault) {
    // From the event loop: the client is in the middle of something.
    QTimer::singleShot(0, this, [this, fault] {
        if (!client_)
            return;
        fail(wordsFor(fault, address_));
        // A skin that fell silent may have been left without power for a moment.
        isReturning_ = isReturning_ || fault == SkinFault::Silenced;
        // Plugged in again, it may take its time to start, or be pulled in the middle of that.
        if (isReturning_)
            watchPort(kWatch);
    });
}

void SkinWorker::onCounted(std::size_t /*cells*/) {}

void SkinWorker::onCell(const NetworkCell& cell) {
    emit cellFound(cell);
}

void SkinWorker::onExplored(const SkinNetwork& network) {
    emit explored(network, exploration_);
    QTimer::singleShot(0, this, [this] {
        if (streamsRest_)
            streamRest(true);
        if (streamsTouch_)
            streamTouch(true);
    });
}

void SkinWorker::onRestarted() {
    forgetNumbers();
    emit numbersLost();
    if (std::exchange(isExploreDue_, true))
        return;  // a patch whose power comes back restarts cell by cell
    restarts_ = now() < restarted_ + kPeace ? restarts_ + 1 : 1;
    restarted_ = now();
    const bool isEnough = restarts_ > kMostRestarts;
    QTimer::singleShot(0, this, [this, isEnough] {
        if (!isExploreDue_)
            return;
        if (isEnough)
            fail(tr("cells of the skin at %1 restart again and again: is their power supply strong enough for all "
                    "LEDs?")
                     .arg(address_.text));
        else
            explore();
    });
}

void SkinWorker::onShown(std::uint64_t token) {
    emit shown(token);
}

void SkinWorker::onNotShown(std::uint64_t /*token*/, std::span<const CellNumber> dark) {
    emit notShown({dark.begin(), dark.end()});
    // Whoever waits for the light has a timeout. Cells that don't answer any more have to be looked for.
    forgetNumbers();
    emit numbersLost();
    QTimer::singleShot(0, this, &SkinWorker::explore);
}

void SkinWorker::onAcceleration(const RestReading& reading, Time time) {
    readings_[reading.cell] = reading;
    readingsAt_ = time;
}

void SkinWorker::onRest(std::span<const RestReading> /*readings*/, std::span<const CellNumber> /*missing*/) {}

void SkinWorker::onTouch(std::span<const CellTouch> touches, Time time) {
    touches_.insert(touches_.end(), touches.begin(), touches.end());
    touchesAt_ = time;
}

}  // namespace skincal
