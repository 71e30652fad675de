#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>
#include <map>
#include <memory>
#include <optional>

#include "core/device/line_address.h"
#include "core/device/protocol/skin_client.h"
#include "core/device/skin_device.h"

namespace skincal {

/// What runs on the thread of a ProtocolSkin: the line, the protocol's client and its timer. Slots are called and
/// signals heard across threads, queued; nothing else is shared. What is still under way when things have changed is
/// told by its number: of an opening that has ended, or by an exploration whose numbers are void.
class SkinWorker : public QObject, private SkinListener {
    Q_OBJECT
  public:
    explicit SkinWorker(LineAddress address);
    ~SkinWorker() override;

    /// std::chrono::steady_clock.
    [[nodiscard]] static std::chrono::microseconds now();

  public slots:
    /// @param opening  handed back with what comes of it
    void open(quint64 opening);
    void close();
    void explore();
    void prepare(const std::vector<std::vector<skincal::LitCell>>& sets);
    /// @param exploration  that gave the numbers; of another one it is dropped
    /// @param when         on now()'s clock; at once where there is none
    void light(const std::vector<skincal::LitCell>& lit, quint64 token, quint64 exploration,
               std::optional<std::chrono::microseconds> when = {});
    /// Lets every cell send as often as the line can carry, but not more often than so.
    void streamRest(bool on);
    void streamTouch(bool on);

  signals:
    void opened(const QString& firmware, quint64 opening);
    /// The line is closed by then.
    void failed(const QString& why, quint64 opening);
    void cellFound(const skincal::NetworkCell& cell);
    void explored(const skincal::SkinNetwork& network, quint64 exploration);
    /// A cell has restarted: numbers are void; explored() follows.
    void numbersLost();
    void shown(quint64 token);
    /// Cells that don't vouch for having shown what they were told; numbersLost() follows.
    void notShown(const std::vector<skincal::CellNumber>& dark);
    void accelerationCame(const std::vector<skincal::RestReading>& readings, qint64 time_us);
    /// What was lost is there again, or is worth another try.
    void cameBack();
    void touchCame(const std::vector<skincal::CellTouch>& touches, qint64 time_us);

  private:
    using Time = SkinClient::Time;

    void onOpened(const std::string& firmware) override;
    void onFault(SkinFault fault) override;
    void onCounted(std::size_t cells) override;
    void onCell(const NetworkCell& cell) override;
    void onExplored(const SkinNetwork& network) override;
    void onRestarted() override;
    void onShown(std::uint64_t token) override;
    void onNotShown(std::uint64_t token, std::span<const CellNumber> dark) override;
    void onAcceleration(const RestReading& reading, Time time) override;
    void onRest(std::span<const RestReading> readings, std::span<const CellNumber> missing) override;
    void onTouch(std::span<const CellTouch> touches, Time time) override;

    [[nodiscard]] std::chrono::milliseconds restPeriod() const;
    void shut();
    /// Numbers are void, and what was said by them.
    void forgetNumbers();
    void pump();
    void flushStreams();
    void fail(const QString& why);
    void lose(LineFault fault, const QString& detail);
    void watchPort(std::chrono::milliseconds interval);
    void lookForPort();

    LineAddress address_;
    quint64 opening_ = 0;
    quint64 exploration_ = 0;
    std::unique_ptr<Line> line_;
    std::unique_ptr<SkinClient> client_;
    QTimer timer_;
    QTimer flush_;
    QTimer watch_;              ///< for a port that was lost
    bool hasAnswered_ = false;  ///< since it was opened
    bool isReturning_ = false;  ///< it was lost, and has not answered since
    bool isExploreDue_ = false;
    int restarts_ = 0;  ///< times in a row that cells have restarted soon after they had before
    Time restarted_{};
    bool streamsRest_ = false;
    bool streamsTouch_ = false;
    std::map<CellNumber, RestReading> readings_;
    std::vector<CellTouch> touches_;
    Time readingsAt_{};
    Time readingsDue_{};  ///< one sample has about one reading of everybody
    Time touchesAt_{};
};

}  // namespace skincal
