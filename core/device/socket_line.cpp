#include "core/device/socket_line.h"

#include <QTimer>

namespace skincal {
namespace {

constexpr int kLastWords = 100;  // ms, for what waits to be sent as it is closed

LineFault faultOf(QAbstractSocket::SocketError error) {
    switch (error) {
        case QAbstractSocket::ConnectionRefusedError:
            return LineFault::Refused;
        case QAbstractSocket::HostNotFoundError:
            return LineFault::UnknownHost;
        case QAbstractSocket::RemoteHostClosedError:
        case QAbstractSocket::NetworkError:
            return LineFault::Ended;
        default:
            return LineFault::Other;
    }
}

}  // namespace

SocketLine::SocketLine(QString host, quint16 port, QObject* parent)
    : Line(parent), host_(std::move(host)), port_(port), socket_(this) {
    connect(&socket_, &QTcpSocket::connected, this, [this] {
        socket_.setSocketOption(QAbstractSocket::LowDelayOption, 1);
        emit opened();
    });
    connect(&socket_, &QTcpSocket::readyRead, this, [this] { emit received(socket_.readAll()); });
    connect(&socket_, &QTcpSocket::errorOccurred, this, [this](QAbstractSocket::SocketError error) {
        // From the event loop: it fires from within connectToHost(), too.
        QTimer::singleShot(0, this, [this, error, detail = socket_.errorString()] {
            close();
            emit failed(faultOf(error), detail);
        });
    });
}

void SocketLine::open() {
    close();
    socket_.connectToHost(host_, port_);
}

void SocketLine::close() {
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
