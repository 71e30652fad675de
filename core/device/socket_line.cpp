#include "core/device/socket_line.h"

namespace skincal {
namespace {

constexpr int kLastWords = 100;  // ms, for what waits to be sent as it is closed

/// @param wasOpen  until then
LineFault faultOf(QAbstractSocket::SocketError error, bool wasOpen) {
    switch (error) {
        case QAbstractSocket::ConnectionRefusedError:
            return LineFault::Refused;
        case QAbstractSocket::HostNotFoundError:
            return LineFault::UnknownHost;
        case QAbstractSocket::RemoteHostClosedError:
        case QAbstractSocket::NetworkError:
        case QAbstractSocket::SocketTimeoutError:
            return wasOpen ? LineFault::Ended : LineFault::Unreachable;
        default:
            return LineFault::Other;
    }
}

}  // namespace

SocketLine::SocketLine(QString host, quint16 port, std::chrono::milliseconds patience, QObject* parent)
    : Line(parent), host_(std::move(host)), port_(port), socket_(this), patience_(this) {
    patience_.setSingleShot(true);
    patience_.setInterval(patience);
    connect(&patience_, &QTimer::timeout, this, [this] {
        close();
        emit failed(LineFault::Unreachable, {});
    });
    connect(&socket_, &QTcpSocket::connected, this, [this] {
        patience_.stop();
        wasOpen_ = true;
        socket_.setSocketOption(QAbstractSocket::LowDelayOption, 1);
        emit opened();
    });
    connect(&socket_, &QTcpSocket::readyRead, this, [this] { emit received(socket_.readAll()); });
    connect(&socket_, &QTcpSocket::errorOccurred, this, [this](QAbstractSocket::SocketError error) {
        patience_.stop();
        // From the event loop: it fires from within connectToHost(), too.
        QTimer::singleShot(0, this, [this, fault = faultOf(error, wasOpen_), detail = socket_.errorString()] {
            close();
            emit failed(fault, detail);
        });
    });
}

void SocketLine::open() {
    close();
    patience_.start();
    socket_.connectToHost(host_, port_);
}

void SocketLine::close() {
    patience_.stop();
    wasOpen_ = false;
    const QSignalBlocker quiet(socket_);
    if (socket_.state() == QAbstractSocket::ConnectedState) {
        socket_.disconnectFromHost();  // once everything is sent
        if (socket_.state() != QAbstractSocket::UnconnectedState)
            socket_.waitForDisconnected(kLastWords);
    }
    socket_.abort();
}

void SocketLine::write(const QByteArray& bytes) {
    if (socket_.state() == QAbstractSocket::ConnectedState)
        socket_.write(bytes);
}

}  // namespace skincal
