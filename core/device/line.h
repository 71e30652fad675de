#pragma once

#include <QByteArray>
#include <QObject>
#include <QString>

namespace skincal {

/// Why a line could not be opened, or ended. What people can do about it is lineHelp()'s to say.
enum class LineFault {
    NoSuchPort,
    NoPermission,
    InUse,
    NoSerialPort,  ///< there is such a file, and it is another thing
    BaudRefused,
    Refused,      ///< nobody listens at that address
    Unreachable,  ///< no way leads there, or nothing comes back from there
    UnknownHost,
    NoProgram,  ///< there is no such program, or it may not be run
    Ended,      ///< unplugged, hung up, or the program ended
    Other,
};

/// A line on which bytes come and go: a serial port, a socket, a program's input and output. Asynchronous, for one
/// thread. Bytes may be delayed, damaged or lost; that is the protocol's business.
class Line : public QObject {
    Q_OBJECT
  public:
    using QObject::QObject;

    /// opened() or failed() follows.
    virtual void open() = 0;
    /// At once, without a signal. Nothing comes after it.
    virtual void close() = 0;
    /// Of a line that is not open: nothing.
    virtual void write(const QByteArray& bytes) = 0;
    /// What it carries, for pacing; never more than that is in its queue for long.
    [[nodiscard]] virtual double bytesPerSecond() const = 0;

  signals:
    void opened();
    void received(const QByteArray& bytes);
    /// Once; it is closed by then.
    /// @param detail  what the system said
    void failed(skincal::LineFault fault, const QString& detail);
};

}  // namespace skincal
