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
/// signals heard across threads, queued; nothing else is shared.
class SkinWorker : public QObject, private SkinListener {
    Q_OBJECT
  public:
    explicit SkinWorker(LineAddress address);
    ~SkinWorker() override;

    /// std::chrono::steady_clock.
    [[nodiscard]] static std::chrono::microseconds now();

  public slots:
    void open();
    void close();
    void explore();
    void prepare(const std::vector<std::vector<skincal::LitCell>>& sets);
    /// @param when  on now()'s clock; at once where there is none
    void light(const std::vector<skincal::LitCell>& lit, quint64 token,
               std::optional<std::chrono::microseconds> when = {});
    /// Lets every cell send as often as the line can carry, but not more often than so.
    void streamRest(bool on);
    void streamTouch(bool on);

  signals:
    void opened(const QString& firmware);
    /// The line is closed by then.
    void failed(const QString& why);
    void cellFound(const skincal::NetworkCell& cell);
    void explored(const skincal::SkinNetwork& network);
    /// A cell has restarted: numbers are void; explored() follows.
    void numbersLost();
    void shown(quint64 token);
    void accelerationCame(const std::vector<skincal::RestReading>& readings, qint64 time_us);
    /// The port that was lost is there again.
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
    void onNotShown(std::uint64_t token, std::size_t shown) override;
    void onAcceleration(const RestReading& reading, Time time) override;
    void onRest(std::span<const RestReading> readings, std::span<const CellNumber> missing) override;
    void onTouch(std::span<const CellTouch> touches, Time time) override;

    [[nodiscard]] std::chrono::milliseconds restPeriod() const;
    void shut();
    void pump();
    void flushStreams();
    void fail(const QString& why);
    void lose(LineFault fault, const QString& detail);
    void watchPort();

    LineAddress address_;
    std::unique_ptr<Line> line_;
    std::unique_ptr<SkinClient> client_;
    QTimer timer_;
    QTimer flush_;
    QTimer watch_;              ///< for a port that was lost
    bool isReturning_ = false;  ///< it was lost, and has not answered since
    bool streamsRest_ = false;
    bool streamsTouch_ = false;
    std::map<CellNumber, RestReading> readings_;
    std::vector<CellTouch> touches_;
    Time readingsAt_{};
    Time readingsDue_{};  ///< one sample has about one reading of everybody
    Time touchesAt_{};
};

}  // namespace skincal
