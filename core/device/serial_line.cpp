#include "core/device/serial_line.h"

#include <QFile>
#include <QFileInfo>
#include <QSerialPort>
#include <QTimer>

#ifdef Q_OS_UNIX
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#endif

namespace skincal {
namespace {

constexpr int kLastWords = 100;  // ms, for what waits to be sent as it is closed

LineFault faultOf(QSerialPort::SerialPortError error, const QString& path) {
    switch (error) {
        case QSerialPort::DeviceNotFoundError:
            return LineFault::NoSuchPort;
        case QSerialPort::PermissionError:
            // Qt says the same of a port that is locked and of one that isn't ours.
            return QFileInfo(path).isReadable() && QFileInfo(path).isWritable() ? LineFault::InUse
                                                                                : LineFault::NoPermission;
        case QSerialPort::ResourceError:
        case QSerialPort::ReadError:
        case QSerialPort::WriteError:
            return LineFault::Ended;
        default:
            return LineFault::Other;
    }
}

/// Whether there is a file of that name that can be opened and is another thing: a directory, "/dev/null".
bool isOtherThing([[maybe_unused]] const QString& path) {
#ifdef Q_OS_UNIX
    const int file = ::open(QFile::encodeName(path).constData(), O_RDONLY | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (file < 0)
        return false;
    // Of a port that is just being unplugged it says something else.
    const bool isOther = ::isatty(file) == 0 && errno == ENOTTY;
    ::close(file);
    return isOther;
#else
    return false;
#endif
}

/// Why it could not be opened, where the system's answer says little: "Inappropriate ioctl for device".
LineFault lookedInto(LineFault fault, const QString& path) {
    if (fault != LineFault::Other && fault != LineFault::Ended)
        return fault;
    if (isOtherThing(path))
        return LineFault::NoSerialPort;
    if (fault == LineFault::Ended)
        return fault;
    QSerialPort usual(path);
    usual.setParity(QSerialPort::NoParity);
    usual.setBaudRate(QSerialPort::Baud9600);
    return usual.open(QIODevice::ReadWrite) ? LineFault::BaudRefused : fault;
}

}  // namespace

SerialLine::SerialLine(QString port, int baud, QObject* parent) : Line(parent), name_(std::move(port)), baud_(baud) {}

SerialLine::~SerialLine() {
    close();
}

QString SerialLine::fullPath(const QString& port) {
#ifdef Q_OS_UNIX
    return port.startsWith(u'/') ? port : QStringLiteral("/dev/") + port;
#else
    return port;
#endif
}

void SerialLine::open() {
    close();
    port_ = std::make_unique<QSerialPort>(fullPath(name_));
    port_->setParity(QSerialPort::NoParity);  // before opening, or pseudo-terminals refuse it
    port_->setDataBits(QSerialPort::Data8);
    port_->setStopBits(QSerialPort::OneStop);
    port_->setFlowControl(QSerialPort::NoFlowControl);
    const QString path = fullPath(name_);
    const bool isOpen = QFileInfo::exists(path) && port_->setBaudRate(baud_) && port_->open(QIODevice::ReadWrite);
    if (!isOpen) {
        const auto error = QFileInfo::exists(path) ? port_->error() : QSerialPort::DeviceNotFoundError;
        const QString detail = port_->errorString();
        port_->close();
        const LineFault fault = lookedInto(faultOf(error, path), path);
        QTimer::singleShot(0, this, [this, fault, detail] { fail(fault, detail); });
        return;
    }
    port_->clear();  // what a device sent before anybody listened
    connect(port_.get(), &QSerialPort::readyRead, this, [this] {
        const QByteArray bytes = port_->readAll();
        emit received(bytes);
    });
    connect(port_.get(), &QSerialPort::errorOccurred, this, [this](QSerialPort::SerialPortError error) {
        // Setting DTR is what pseudo-terminals can't: no harm.
        if (error == QSerialPort::NoError || error == QSerialPort::UnsupportedOperationError || !port_)
            return;
        // Once: it storms until the port is closed, which may not happen from within its own signal.
        port_->disconnect(this);
        const QString detail = port_->errorString();
        QTimer::singleShot(0, port_.get(), [this, error, detail] { fail(faultOf(error, fullPath(name_)), detail); });
    });
    QTimer::singleShot(0, port_.get(), [this] { emit opened(); });
}

void SerialLine::close() {
    if (!port_)
        return;
    port_->disconnect(this);
    if (port_->isOpen() && port_->bytesToWrite() > 0)
        port_->waitForBytesWritten(kLastWords);
    port_->close();
    port_->setParent(this);  // a thread that ends deletes nothing later
    port_.release()->deleteLater();
}

void SerialLine::write(const QByteArray& bytes) {
    if (port_ && port_->isOpen())
        port_->write(bytes);
}

void SerialLine::fail(LineFault fault, const QString& detail) {
    close();
    emit failed(fault, detail);
}

}  // namespace skincal
