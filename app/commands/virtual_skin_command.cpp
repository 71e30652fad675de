#include <QFile>
#include <QSocketNotifier>
#include <QTcpServer>
#include <QTcpSocket>
#include <cstdio>
#include <iostream>
#include <sstream>

#include <fmt/format.h>

#include "app/command_application.h"
#include "app/command_line.h"
#include "core/rig/pseudo_terminal.h"
#include "core/rig/wired_skin.h"

namespace skincal {
namespace {

struct VirtualSkinArguments {
    std::string scenario = "arm";
    std::uint64_t seed = 1;
    std::string link;
    int tcpPort = -1;
    bool stdio = false;
    WireFaults faults;
    double latency_ms = 0;
    bool isTerminal = false;  ///< said so; it is, where nothing else is said
    int baud = 3'000'000;
    std::vector<std::uint32_t> dead;
    std::vector<std::string> cut;
    double resetEvery_s = 0;
};

std::optional<std::size_t> placeOf(const Skin& skin, std::uint32_t id) {
    const auto index = skin.indexById();
    const auto found = index.find(ModuleId(id));
    return found == index.end() ? std::nullopt : std::optional(found->second);
}

/// What is said on standard input while it runs: hands that act on skin and body.
class Commands {
  public:
    Commands(SimulatedRig& rig, WiredSkin& skin, std::function<void(bool)> plug)
        : rig_(rig), skin_(skin), plug_(std::move(plug)) {}

    void obey(const std::string& line) {
        std::istringstream words(line);
        std::string what;
        words >> what;
        if (what.empty())
            return;
        const std::string complaint = obey(what, words);
        fmt::print(stderr, "{}\n", complaint.empty() ? "done: " + line : complaint);
    }

  private:
    std::string obey(const std::string& what, std::istringstream& words) {
        if (what == "quit") {
            QCoreApplication::quit();
        } else if (what == "unplug" || what == "plug") {
            plug_(what == "plug");
        } else if (what == "turn") {
            Vector3d up;
            if (!(words >> up.x() >> up.y() >> up.z()) || up.norm() == 0)
                return "turn X Y Z was expected: the direction of the body that shall point up";
            rig_.turnBody(up);
        } else if (what == "view") {
            std::size_t view = 0;
            if (!(words >> view) || view >= rig_.suggestedViews().size())
                return fmt::format("view N was expected, N from 0 to {}", rig_.suggestedViews().size() - 1);
            rig_.moveCamera(rig_.suggestedViews()[view]);
        } else if (what == "kill" || what == "reset") {
            std::uint32_t id = 0;
            words >> id;
            const auto place = placeOf(rig_.world().skin, id);
            if (!place)
                return what + " MODULE was expected: the id of a module";
            what == "kill" ? skin_.network().kill(*place) : skin_.network().restart(*place);
            skin_.pump();
        } else {
            return "one of these was expected: turn X Y Z, view N, kill MODULE, reset MODULE, unplug, plug, quit";
        }
        return {};
    }

    SimulatedRig& rig_;
    WiredSkin& skin_;
    std::function<void(bool)> plug_;
};

std::string applyFaults(const VirtualSkinArguments& arguments, const Skin& skin, VirtualNetwork& network) {
    for (const std::uint32_t id : arguments.dead) {
        const auto place = placeOf(skin, id);
        if (!place)
            return fmt::format("--dead: {} is no module of this skin", id);
        network.kill(*place);
    }
    for (const std::string& text : arguments.cut) {
        std::uint32_t id = 0;
        int port = 0;
        char colon = 0;
        std::istringstream words(text);
        const bool read = static_cast<bool>(words >> id >> colon >> port) && colon == ':';
        const auto place = placeOf(skin, id);
        if (!read || !place || port < 0 || port >= static_cast<int>(skin.templateOf(*place).ports.size()))
            return fmt::format("--cut: MODULE:PORT was expected, found \"{}\"", text);
        network.cut(*place, port);
    }
    return {};
}

int runVirtualSkin(const VirtualSkinArguments& arguments) {
    const Scenario* scenario = findScenario(arguments.scenario);
    if (scenario == nullptr)
        return badInput("there is no scenario \"" + arguments.scenario + "\"; \"skincal simulate --list\" names them");
    const CommandApplication<QCoreApplication> application;

    SimulatedRig rig(*scenario, arguments.seed);
    WireFaults faults = arguments.faults;
    faults.latency = std::chrono::microseconds(static_cast<int>(1000 * arguments.latency_ms));
    faults.bytesPerSecond = arguments.baud / 10.0;
    WiredSkin skin(rig, faults);
    if (const std::string wrong = applyFaults(arguments, rig.world().skin, skin.network()); !wrong.empty())
        return badInput(wrong);

    PseudoTerminal terminal;
    QTcpServer server;
    QPointer<QTcpSocket> peer;
    const QString link = QString::fromStdString(arguments.link);
    if (arguments.tcpPort >= 0) {
        if (!server.listen(QHostAddress::LocalHost, static_cast<quint16>(arguments.tcpPort)))
            return badInput("can't listen: " + server.errorString().toStdString());
        QObject::connect(&server, &QTcpServer::newConnection, &skin, [&] {
            if (peer)
                peer->deleteLater();  // the newest is the one that is listened to
            peer = server.nextPendingConnection();
            QObject::connect(peer, &QTcpSocket::readyRead, &skin, [&, socket = peer] {
                if (socket)
                    skin.receive(socket->readAll());
            });
        });
    } else if (!arguments.stdio) {
        if (const QString why = terminal.open(link); !why.isEmpty())
            return badInput(why.toStdString());
    }
    QObject::connect(&terminal, &PseudoTerminal::received, &skin, &WiredSkin::receive);
    QObject::connect(&skin, &WiredSkin::sent, &application, [&](const QByteArray& bytes) {
        if (peer)
            peer->write(bytes);
        else if (terminal.isOpen())
            terminal.write(bytes);
        else if (arguments.stdio &&
                 std::fwrite(bytes.constData(), 1, static_cast<std::size_t>(bytes.size()), stdout) > 0)
            std::fflush(stdout);
    });

    QTimer resets;
    Random chance(arguments.seed, "resets");
    QObject::connect(&resets, &QTimer::timeout, &skin, [&] {
        skin.network().restart(chance.index(skin.network().cells()));
        skin.pump();
    });
    if (arguments.resetEvery_s > 0)
        resets.start(static_cast<int>(1000 * arguments.resetEvery_s));

    Commands commands(rig, skin, [&](bool in) {
        if (in && !terminal.isOpen())
            std::ignore = terminal.open(link);
        if (!in) {
            terminal.close();
            if (peer)
                peer->abort();
        }
    });
    QSocketNotifier input(fileno(stdin), QSocketNotifier::Read);
    QByteArray text;
    QObject::connect(&input, &QSocketNotifier::activated, &skin, [&] {
        QByteArray bytes(4096, Qt::Uninitialized);
        const auto count = ::read(fileno(stdin), bytes.data(), static_cast<std::size_t>(bytes.size()));
        if (count <= 0) {
            input.setEnabled(false);
            if (arguments.stdio)
                QCoreApplication::quit();
            return;
        }
        bytes.truncate(count);
        if (arguments.stdio) {
            skin.receive(bytes);
            return;
        }
        text += bytes;
        for (qsizetype end = text.indexOf('\n'); end >= 0; end = text.indexOf('\n')) {
            commands.obey(text.left(end).trimmed().toStdString());
            text.remove(0, end + 1);
        }
    });
    if (!arguments.stdio)
        fmt::print("{}\n", arguments.tcpPort >= 0 ? fmt::format("tcp://localhost:{}", server.serverPort())
                                                  : terminal.name().toStdString());
    std::fflush(stdout);
    QCoreApplication::exec();
    return kDone;
}

}  // namespace

void addVirtualSkinCommand(CommandLine& line) {
    auto arguments = std::make_shared<VirtualSkinArguments>();
    CLI::App* command = line.app.add_subcommand(
        "virtual-skin", "A simulated skin behind a serial port: for trying without hardware, and for tests");
    command->add_option("scenario", arguments->scenario, "What it is: see \"skincal simulate --list\"")
        ->capture_default_str();
    addSeedOption(*command, arguments->seed, "Which of the scenario's worlds");
    auto* pty =
        command->add_flag("--pty", arguments->isTerminal, "On a pseudo-terminal: what it does unless told otherwise");
    auto* link = command->add_option("--link", arguments->link, "Give the pseudo-terminal this name, too");
    auto* tcp = command->add_option("--tcp", arguments->tcpPort, "Listen on this port of this computer; 0: any")
                    ->check(CLI::Range(0, 65535))
                    ->excludes(pty)
                    ->excludes(link);
    command->add_flag("--stdio", arguments->stdio, "Speak on standard input and output, as exec: wants it")
        ->excludes(pty)
        ->excludes(link)
        ->excludes(tcp);
    command->add_option("--baud", arguments->baud, "How fast wires are")
        ->check(CLI::Range(1200, 100'000'000))
        ->capture_default_str();
    command->add_option("--byte-errors", arguments->faults.byteErrors, "Share of bytes with a wrong bit")
        ->check(CLI::Range(0.0, 0.5));
    command->add_option("--lost-frames", arguments->faults.lostFrames, "Share of frames that never arrive")
        ->check(CLI::Range(0.0, 0.9));
    command->add_option("--latency-ms", arguments->latency_ms, "Delay of each wire")->check(CLI::Range(0.0, 200.0));
    command->add_option("--dead", arguments->dead, "Modules that have no power")->delimiter(',');
    command->add_option("--cut", arguments->cut, "MODULE:PORT, wires that are cut")->delimiter(',');
    command
        ->add_option("--reset-every", arguments->resetEvery_s, "Seconds between two modules' losing power for a moment")
        ->check(CLI::NonNegativeNumber);
    command->footer(
        "Prints where it can be reached: a pseudo-terminal, unless --tcp or --stdio is given. It obeys lines on\n"
        "standard input:\n  turn X Y Z, view N, kill MODULE, reset MODULE, unplug, plug, quit.");
    command->callback([&line, arguments] { line.run = [arguments] { return runVirtualSkin(*arguments); }; });
}

}  // namespace skincal
