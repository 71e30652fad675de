#include "core/device/line_address.h"

#include <QCoreApplication>
#include <QFileInfo>
#include <QRegularExpression>

#include "core/device/program_line.h"
#include "core/device/serial_line.h"
#include "core/device/socket_line.h"
#include "core/device/split_command.h"

namespace skincal {
namespace {

struct LineWords {
    Q_DECLARE_TR_FUNCTIONS(LineWords)
};

std::optional<int> positive(QStringView text, int most) {
    bool fine = false;
    const int value = text.toInt(&fine);
    return fine && value > 0 && value <= most ? std::optional(value) : std::nullopt;
}

tl::expected<LineAddress, QString> parseTcp(const QString& text) {
    const QString rest = text.mid(6);
    const qsizetype colon = rest.lastIndexOf(u':');
    const auto port = colon > 0 ? positive(QStringView(rest).mid(colon + 1), 65535) : std::nullopt;
    if (!port)
        return tl::unexpected(
            LineWords::tr("\"%1\" is no address: tcp://host:port was expected, port from 1 to 65535").arg(text));
    QString host = rest.left(colon);
    if (host.startsWith(u'[') && host.endsWith(u']'))
        host = host.mid(1, host.size() - 2);  // IPv6
    return LineAddress{LineAddress::Kind::Tcp, host, *port, text};
}

/// Names without a path are those of ports in /dev, but for links that lie here.
QString inFull(const QString& port) {
    const QFileInfo here(port);
    return here.isRelative() && here.exists() ? here.absoluteFilePath() : port;
}

tl::expected<LineAddress, QString> parseSerial(const QString& text) {
    const qsizetype at = text.lastIndexOf(u'@');
    const QString port = inFull(text.left(at));
    if (at < 0) {
        static const QRegularExpression gateway(QStringLiteral("^[\\w.-]+:\\d+$"));
        if (gateway.match(text).hasMatch() && !QFileInfo::exists(port))
            return tl::unexpected(LineWords::tr("\"%1\" is no port; of a gateway it is tcp://%1").arg(text));
        return LineAddress{LineAddress::Kind::Serial, port, LineAddress::kBaud, text};
    }
    constexpr int kMostBaud = 50'000'000;
    const auto baud = positive(QStringView(text).mid(at + 1), kMostBaud);
    if (!baud || at == 0)
        return tl::unexpected(
            LineWords::tr("\"%1\" is no port: port@baud was expected, baud from 1 to %2").arg(text).arg(kMostBaud));
    return LineAddress{LineAddress::Kind::Serial, port, *baud, text};
}

QString permissionHelp(const LineAddress& address) {
    const QFileInfo port(SerialLine::fullPath(address.target));
    const QString group = port.group();
    const bool doesGroupHelp = port.permission(QFileDevice::ReadGroup | QFileDevice::WriteGroup);
    if (!group.isEmpty() && (!doesGroupHelp || group == QLatin1String("root")))
        return LineWords::tr("you may not open %1: \"sudo chmod a+rw %2\", until it is plugged in anew")
            .arg(address.target, port.filePath());
    return LineWords::tr("you may not open %1: \"sudo usermod -aG %2 $USER\", then log out and in again")
        .arg(address.target, group.isEmpty() ? QStringLiteral("dialout") : group);
}

}  // namespace

tl::expected<LineAddress, QString> parseLineAddress(const QString& text) {
    const QString trimmed = text.trimmed();
    if (trimmed.isEmpty())
        return tl::unexpected(LineWords::tr("a serial port, tcp://host:port or exec:command was expected"));
    if (trimmed.startsWith(QLatin1String("tcp://")))
        return parseTcp(trimmed);
    if (trimmed.startsWith(QLatin1String("exec:"))) {
        const QString command = trimmed.mid(5).trimmed();
        if (command.isEmpty())
            return tl::unexpected(LineWords::tr("\"%1\" names no program").arg(trimmed));
        if (const auto words = splitCommand(command); !words)
            return tl::unexpected(LineWords::tr("the command of \"%1\" can't be read: %2").arg(trimmed, words.error()));
        return LineAddress{LineAddress::Kind::Program, command, 0, trimmed};
    }
    return parseSerial(trimmed);
}

std::unique_ptr<Line> makeLine(const LineAddress& address) {
    switch (address.kind) {
        case LineAddress::Kind::Tcp:
            return std::make_unique<SocketLine>(address.target, static_cast<quint16>(address.number));
        case LineAddress::Kind::Program:
            return std::make_unique<ProgramLine>(address.target);
        case LineAddress::Kind::Serial:
            break;
    }
    return std::make_unique<SerialLine>(address.target, address.number);
}

QString lineHelp(LineFault fault, const LineAddress& address, const QString& detail) {
    switch (fault) {
        case LineFault::NoSuchPort:
            return LineWords::tr("there is no port %1: is the adapter plugged in?").arg(address.target);
        case LineFault::NoPermission:
            return permissionHelp(address);
        case LineFault::InUse:
            return LineWords::tr("another program has %1 open: \"fuser -v %2\" names it")
                .arg(address.target, SerialLine::fullPath(address.target));
        case LineFault::NoSerialPort:
            return LineWords::tr(
                       "there is %1, but it is no serial port: adapters are called /dev/ttyUSB0, /dev/ttyACM0")
                .arg(SerialLine::fullPath(address.target));
        case LineFault::BaudRefused:
            return LineWords::tr("the port %1 refuses %2 baud: try the speed of the skin's adapter, %1@%3 say")
                .arg(address.target)
                .arg(address.number)
                .arg(address.number == 921'600 ? 115'200 : 921'600);
        case LineFault::Refused:
            return LineWords::tr("nobody listens at %1: is the gateway running?").arg(address.text);
        case LineFault::Unreachable:
            return LineWords::tr(
                       "the gateway at %1 can't be reached: is that its address, and is this computer in its network?")
                .arg(address.text);
        case LineFault::UnknownHost:
            return LineWords::tr("there is no host \"%1\"").arg(address.target);
        case LineFault::NoProgram:
            return LineWords::tr("the program \"%1\" could not be started: %2").arg(address.target, detail);
        case LineFault::Ended:
            switch (address.kind) {
                case LineAddress::Kind::Serial:
                    return LineWords::tr("the port %1 was unplugged").arg(address.target);
                case LineAddress::Kind::Tcp:
                    return LineWords::tr("the gateway at %1 hung up").arg(address.text);
                case LineAddress::Kind::Program:
                    return LineWords::tr("the program \"%1\" ended%2")
                        .arg(address.target, detail.isEmpty() ? QString() : QStringLiteral(": ") + detail);
            }
            break;
        case LineFault::Other:
            break;
    }
    return LineWords::tr("the line to %1 failed: %2").arg(address.text, detail);
}

}  // namespace skincal
