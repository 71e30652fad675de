#include "core/device/line_address.h"

#include <gtest/gtest.h>

#include <QSignalSpy>
#include <QTcpServer>

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
                             "exec:", "exec:  ", "/dev/ttyUSB0@", "/dev/ttyUSB0@fast", "/dev/ttyUSB0@-1", "@9600"}) {
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
        QTcpServer server;
        ASSERT_TRUE(server.listen(QHostAddress::LocalHost));
        const int port = server.serverPort();
        server.close();
        const auto [fault, help] = faultOf(QStringLiteral("tcp://127.0.0.1:%1").arg(port));
        EXPECT_EQ(fault, LineFault::Refused);
        EXPECT_TRUE(help.contains(QLatin1String("gateway"))) << help.toStdString();
    }
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
    const LineAddress address = parseLineAddress(QStringLiteral("/dev/null")).value();
    const QString help = lineHelp(LineFault::NoPermission, address, {});
    EXPECT_TRUE(help.contains(QLatin1String("sudo usermod -aG "))) << help.toStdString();
    EXPECT_TRUE(help.contains(QLatin1String("$USER"))) << help.toStdString();
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
