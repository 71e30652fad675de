#pragma once

#include <QTcpSocket>

#include "core/device/line.h"

namespace skincal {

/// A TCP connection to a gateway or a bridge.
class SocketLine : public Line {
    Q_OBJECT
  public:
    SocketLine(QString host, quint16 port, QObject* parent = nullptr);

    void open() override;
    void close() override;
    void write(const QByteArray& bytes) override;
    /// 100 Mbit/s.
    [[nodiscard]] double bytesPerSecond() const override { return 12.5e6; }

  private:
    QString host_;
    quint16 port_;
    QTcpSocket socket_;
};

}  // namespace skincal
