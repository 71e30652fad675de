#pragma once

#include <QTcpSocket>
#include <QTimer>
#include <chrono>

#include "core/device/line.h"

namespace skincal {

/// A TCP connection to a gateway or a bridge.
class SocketLine : public Line {
    Q_OBJECT
  public:
    /// @param patience  until the host counts as out of reach: the system itself waits for minutes
    SocketLine(QString host, quint16 port, std::chrono::milliseconds patience = std::chrono::seconds(5),
               QObject* parent = nullptr);

    void open() override;
    void close() override;
    void write(const QByteArray& bytes) override;
    /// 100 Mbit/s.
    [[nodiscard]] double bytesPerSecond() const override { return 12.5e6; }

  private:
    QString host_;
    quint16 port_;
    QTcpSocket socket_;
    QTimer patience_;
    bool wasOpen_ = false;  ///< since open()
};

}  // namespace skincal
