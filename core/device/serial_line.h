#pragma once

#include <memory>

#include "core/device/line.h"

class QSerialPort;

namespace skincal {

/// A serial port: 8 data bits, no parity, one stop bit, no flow control; any name that the system knows, pseudo-
/// terminals included.
class SerialLine : public Line {
    Q_OBJECT
  public:
    SerialLine(QString port, int baud, QObject* parent = nullptr);
    ~SerialLine() override;

    void open() override;
    void close() override;
    void write(const QByteArray& bytes) override;
    [[nodiscard]] double bytesPerSecond() const override { return baud_ / 10.0; }

    /// "/dev/ttyUSB0" for "ttyUSB0".
    [[nodiscard]] static QString fullPath(const QString& port);

  private:
    void fail(LineFault fault, const QString& detail);

    QString name_;
    int baud_;
    std::unique_ptr<QSerialPort> port_;
};

}  // namespace skincal
