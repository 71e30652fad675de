#include "core/device/line_address.h"

#include <gtest/gtest.h>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <QDir>
#include <QSignalSpy>
#include <QTcpServer>
#include <QTemporaryDir>
#include <QTemporaryFile>
#include <algorithm>
#include <array>
#include <tuple>

#include "core/device/socket_line.h"
#include "core/rig/pseudo_terminal.h"
#include "tests/wait_for.h"

namespace skincal {
namespace {

using test::waitFor;
using Kind = LineAddress::Kind;

TEST(LineAddress, IsWrittenAsPeopleWriteIt) {
    const auto is = [](const char* text, Kind kind, const char* target, int number) {
        const auto address = parseLineAddress(QString::fromLatin1(text));
        ASSERT_TRUE(address) << text;
        EXPECT_EQ(address->kind, kind) << text;
        EXPECT_EQ(address->target.toStdString(), target) << text;
        EXPECT_EQ(address->number, number) << text;
    };
    is("/dev/ttyUSB0", Kind::Serial, "/dev/ttyUSB0", 3'000'000);
    is(" ttyACM1 ", Kind::Serial, "ttyACM1", 3'000'000);
    is("/dev/ttyUSB0@115200", Kind::Serial, "/dev/ttyUSB0", 115'200);
    is("COM7@921600", Kind::Serial, "COM7", 921'600);
    is("tcp://gateway.local:5760", Kind::Tcp, "gateway.local", 5760);
    is("tcp://[fe80::1]:1", Kind::Tcp, "fe80::1", 1);
    is("exec:python3 bridge.py --robot left", Kind::Program, "python3 bridge.py --robot left", 0);
}

TEST(LineAddress, WhatIsNoneIsRefusedWithWhatWasExpected) {
    for (const char* text : {"", "  ", "tcp://host", "tcp://:5", "tcp://host:0", "tcp://host:70000", "tcp://host:x",
                             "exec:", "exec:  ", "exec:cat 'left open", "/dev/ttyUSB0@", "/dev/ttyUSB0@fast",
                             "/dev/ttyUSB0@-1", "@9600"}) {
        const auto address = parseLineAddress(QString::fromLatin1(text));
        ASSERT_FALSE(address) << text;
        EXPECT_FALSE(address.error().isEmpty()) << text;
    }
}

/// How a line of that address fails.
std::pair<LineFault, QString> faultOf(const QString& text) {
    const LineAddress address = parseLineAddress(text).value();
    const auto line = makeLine(address);
    std::optional<std::pair<LineFault, QString>> fault;
    QObject::connect(line.get(), &Line::failed, line.get(), [&](LineFault what, const QString& detail) {
        fault = {what, lineHelp(what, address, detail)};
    });
    line->open();
    EXPECT_FALSE(fault) << "not from inside the call";
    EXPECT_TRUE(waitFor([&] { return fault.has_value(); }));
    return fault.value_or(std::pair{LineFault::Other, QString()});
}

TEST(Line, EveryWayToFailHasItsReasonAndWhatToDo) {
    {
        const auto [fault, help] = faultOf(QStringLiteral("/dev/ttyNOSUCH"));
        EXPECT_EQ(fault, LineFault::NoSuchPort);
        EXPECT_TRUE(help.contains(QLatin1String("plugged in"))) << help.toStdString();
    }
    {
        const auto [fault, help] = faultOf(QStringLiteral("exec:/no/such/program --at all"));
        EXPECT_EQ(fault, LineFault::NoProgram);
        EXPECT_TRUE(help.contains(QLatin1String("/no/such/program"))) << help.toStdString();
    }
    {
        const auto [fault, help] = faultOf(QStringLiteral("exec:sh -c \"echo no robot here >&2; exit 3\""));
        EXPECT_EQ(fault, LineFault::Ended);
        EXPECT_TRUE(help.contains(QLatin1String("no robot here"))) << help.toStdString();
    }
    {
        const auto [fault, help] = faultOf(QStringLiteral("exec:true"));
        EXPECT_EQ(fault, LineFault::Ended);
        EXPECT_TRUE(help.contains(QLatin1String("exit code 0"))) << help.toStdString();
    }
    {
        QTcpServer server;
        ASSERT_TRUE(server.listen(QHostAddress::LocalHost));
        const int port = server.serverPort();
        server.close();
        const auto [fault, help] = faultOf(QStringLiteral("tcp://127.0.0.1:%1").arg(port));
        EXPECT_EQ(fault, LineFault::Refused);
        EXPECT_TRUE(help.contains(QLatin1String("gateway"))) << help.toStdString();
    }
    {
        // No network leads to a group of hosts.
        const auto [fault, help] = faultOf(QStringLiteral("tcp://224.0.0.1:5000"));
        EXPECT_EQ(fault, LineFault::Unreachable);
        EXPECT_TRUE(help.contains(QLatin1String("can't be reached"))) << help.toStdString();
    }
    {
        const auto [fault, help] = faultOf(QStringLiteral("/dev/null"));
        EXPECT_EQ(fault, LineFault::NoSerialPort);
        EXPECT_TRUE(help.contains(QLatin1String("/dev/null, but it is no serial port"))) << help.toStdString();
    }
}

/// A host that takes no more connections: what is sent to it vanishes.
class Abyss {
  public:
    Abyss() {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof(address);
        auto* place = reinterpret_cast<sockaddr*>(&address);
        listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
        EXPECT_EQ(::bind(listener_, place, size), 0);
        EXPECT_EQ(::listen(listener_, 0), 0);
        EXPECT_EQ(::getsockname(listener_, place, &size), 0);
        port = ntohs(address.sin_port);
        for (int& caller : callers_) {
            caller = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
            std::ignore = ::connect(caller, place, size);
        }
    }
    Abyss(const Abyss&) = delete;
    Abyss& operator=(const Abyss&) = delete;
    ~Abyss() {
        for (const int caller : callers_)
            ::close(caller);
        ::close(listener_);
    }

    quint16 port = 0;

  private:
    int listener_ = -1;
    std::array<int, 4> callers_{};
};

TEST(Line, AHostFromWhichNothingComesBackIsOutOfReachBeforeLong) {
    const Abyss abyss;
    SocketLine line(QStringLiteral("127.0.0.1"), abyss.port, std::chrono::milliseconds(300));
    std::optional<LineFault> fault;
    int faults = 0;
    QObject::connect(&line, &Line::failed, &line, [&](LineFault what) {
        fault = what;
        ++faults;
    });
    line.open();
    ASSERT_TRUE(waitFor([&] { return fault.has_value(); }));
    EXPECT_EQ(fault, LineFault::Unreachable);
    EXPECT_EQ(faults, 1);
    const QString help = lineHelp(*fault, parseLineAddress(QStringLiteral("tcp://10.255.255.1:5000")).value(), {});
    EXPECT_TRUE(help.contains(QLatin1String("can't be reached"))) << help.toStdString();
    EXPECT_FALSE(help.contains(QLatin1String("hung up"))) << help.toStdString();
}

TEST(Line, WhatIsSaidOfOneBeginsWithAWord) {
    // An address with a capital is another one.
    for (const char* text : {"ttyUSB0", "tcp://localhost:5000", "exec:bridge"}) {
        const LineAddress address = parseLineAddress(QString::fromLatin1(text)).value();
        for (const auto fault :
             {LineFault::NoSuchPort, LineFault::NoPermission, LineFault::InUse, LineFault::NoSerialPort,
              LineFault::BaudRefused, LineFault::Refused, LineFault::Unreachable, LineFault::UnknownHost,
              LineFault::NoProgram, LineFault::Ended, LineFault::Other}) {
            const QString word = lineHelp(fault, address, QStringLiteral("so it is")).section(u' ', 0, 0);
            EXPECT_TRUE(std::all_of(word.begin(), word.end(), [](QChar c) { return c.isLower(); }))
                << word.toStdString();
        }
    }
}

TEST(Line, ARefusedBaudRateNamesItAndAnother) {
    const LineAddress address = parseLineAddress(QStringLiteral("/dev/ttyUSB0@12345678")).value();
    const QString help = lineHelp(LineFault::BaudRefused, address, {});
    EXPECT_TRUE(help.contains(QLatin1String("12345678"))) << help.toStdString();
    EXPECT_TRUE(help.contains(QLatin1String("/dev/ttyUSB0@921600"))) << help.toStdString();
}

TEST(Line, AProgramIsQuotedAsInAShell) {
    const auto line =
        makeLine(parseLineAddress(QStringLiteral(R"(exec:printf '%s|' 'a "b' "c 'd" e\ f '$HOME' \'g)")).value());
    QByteArray here;
    QObject::connect(line.get(), &Line::received, line.get(), [&](const QByteArray& b) { here += b; });
    line->open();
    EXPECT_TRUE(waitFor([&] { return here.count('|') == 5; })) << here.toStdString();
    EXPECT_EQ(here, QByteArray(R"(a "b|c 'd|e f|$HOME|'g|)"));
}

TEST(Line, APortThatIsOpenElsewhereIsInUse) {
    PseudoTerminal terminal;
    ASSERT_EQ(terminal.open(), QString());
    const LineAddress address = parseLineAddress(terminal.name()).value();
    const auto first = makeLine(address);
    bool opened = false;
    QObject::connect(first.get(), &Line::opened, first.get(), [&] { opened = true; });
    first->open();
    ASSERT_TRUE(waitFor([&] { return opened; }));
    const auto [fault, help] = faultOf(terminal.name());
    EXPECT_EQ(fault, LineFault::InUse);
    EXPECT_TRUE(help.contains(QLatin1String("fuser"))) << help.toStdString();
}

TEST(Line, NoPermissionNamesTheCommandThatMendsIt) {
    const auto helpFor = [](const QString& path) {
        return lineHelp(LineFault::NoPermission, parseLineAddress(path).value(), {});
    };
    const QString help = helpFor(QStringLiteral("/dev/ttyUSB99"));
    EXPECT_TRUE(help.contains(QLatin1String("sudo usermod -aG dialout $USER"))) << help.toStdString();
    // Nobody shall become a member of root, and where the group may do nothing that would not help.
    EXPECT_TRUE(helpFor(QStringLiteral("/dev/null")).contains(QLatin1String("sudo chmod a+rw /dev/null")));
    QTemporaryFile own;
    ASSERT_TRUE(own.open());
    own.setPermissions(QFileDevice::ReadOwner | QFileDevice::WriteOwner);
    EXPECT_TRUE(helpFor(own.fileName()).contains(QLatin1String("sudo chmod a+rw ")));
}

TEST(Line, LinksThatLieHereAreFoundAndGatewaysAreNoPorts) {
    const QTemporaryDir folder;
    const QString before = QDir::currentPath();
    ASSERT_TRUE(QDir::setCurrent(folder.path()));
    PseudoTerminal terminal;
    EXPECT_EQ(terminal.open(QStringLiteral("skin")), QString());
    EXPECT_EQ(parseLineAddress(QStringLiteral("skin"))->target, QFileInfo(QStringLiteral("skin")).absoluteFilePath());
    EXPECT_EQ(parseLineAddress(QStringLiteral("./skin@9600"))->target,
              QFileInfo(QStringLiteral("./skin")).absoluteFilePath());
    EXPECT_EQ(parseLineAddress(QStringLiteral("ttyUSB0"))->target, QStringLiteral("ttyUSB0"));
    // The name of a port that is there is not taken from it, and of one that is gone it is.
    PseudoTerminal second;
    EXPECT_TRUE(second.open(QStringLiteral("skin")).contains(QLatin1String("another port's name")));
    EXPECT_TRUE(QFileInfo::exists(QStringLiteral("skin")));
    terminal.close();
    ASSERT_TRUE(QFile::link(QStringLiteral("/dev/pts/gone"), QStringLiteral("skin")));
    EXPECT_EQ(second.open(QStringLiteral("skin")), QString());
    second.close();
    ASSERT_TRUE(QDir::setCurrent(before));
    const auto gateway = parseLineAddress(QStringLiteral("localhost:7000"));
    ASSERT_FALSE(gateway);
    EXPECT_TRUE(gateway.error().contains(QLatin1String("tcp://localhost:7000")));
}

TEST(Line, BytesPassBothWaysAndAnUnpluggedOneEnds) {
    PseudoTerminal terminal;
    ASSERT_EQ(terminal.open(), QString());
    const auto line = makeLine(parseLineAddress(terminal.name()).value());
    QByteArray there;
    QByteArray here;
    bool opened = false;
    std::optional<LineFault> fault;
    int faults = 0;
    QObject::connect(&terminal, &PseudoTerminal::received, &terminal, [&](const QByteArray& b) { there += b; });
    QObject::connect(line.get(), &Line::received, line.get(), [&](const QByteArray& b) { here += b; });
    QObject::connect(line.get(), &Line::opened, line.get(), [&] { opened = true; });
    QObject::connect(line.get(), &Line::failed, line.get(), [&](LineFault what) {
        fault = what;
        ++faults;
    });
    line->open();
    ASSERT_TRUE(waitFor([&] { return opened; }));
    QByteArray all;
    for (int i = 0; i < 256; ++i)
        all += static_cast<char>(i);  // none means anything to a terminal
    line->write(all);
    terminal.write(all);
    EXPECT_TRUE(waitFor([&] { return there == all && here == all; }));
    terminal.close();
    EXPECT_TRUE(waitFor([&] { return fault.has_value(); }));
    EXPECT_EQ(fault, LineFault::Ended);
    QCoreApplication::processEvents();
    EXPECT_EQ(faults, 1) << "it storms";
}

TEST(Line, AProgramsInputAndOutputAreALine) {
    const auto line = makeLine(parseLineAddress(QStringLiteral("exec:cat")).value());
    QByteArray here;
    QObject::connect(line.get(), &Line::received, line.get(), [&](const QByteArray& b) { here += b; });
    QObject::connect(line.get(), &Line::opened, line.get(), [&] { line->write(QByteArray("a\0b", 3)); });
    line->open();
    EXPECT_TRUE(waitFor([&] { return here == QByteArray("a\0b", 3); }));
    line->close();
    line->open();
    EXPECT_TRUE(waitFor([&] { return here.size() == 6; })) << "it can be opened again";
}

}  // namespace
}  // namespace skincal
