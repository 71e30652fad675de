// "skincal virtual-skin", each way in which it can be reached and all that it is told, and "skincal explore" at the
// other end of the line.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <pty.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <QDir>
#include <QFileInfo>
#include <QProcess>
#include <QTemporaryDir>
#include <csignal>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "core/formats/camera_file.h"
#include "core/formats/recording.h"
#include "core/simulation/world.h"
#include "core/virtual_skin/virtual_network.h"
#include "tests/acceptance/program.h"
#include "tests/wait_for.h"

namespace skincal::test {
namespace {

using testing::HasSubstr;

constexpr auto kScenario = "arm";

const Skin& theSkin() {
    static const World world = buildWorld(*findScenario(kScenario), 1);
    return world.skin;
}

std::map<ModuleId, std::size_t> linksOfEach() {
    std::map<ModuleId, std::size_t> links;
    for (const Link& link : theSkin().links) {
        ++links[link.a];
        ++links[link.b];
    }
    return links;
}

/// One that the others do without.
ModuleId aLeaf() {
    for (const auto& [module, links] : linksOfEach())
        if (links == 1 && module != placeForComputer(theSkin()).value().module)
            return module;
    throw std::logic_error("there is none");
}

/// Of modules that hang together without it: each has another one.
Link aLinkOfARing() {
    auto links = linksOfEach();
    for (const Link& link : theSkin().links)
        if (links[link.a] > 2 && links[link.b] > 2)
            return link;
    throw std::logic_error("there is none");
}

std::string exploredBy(const std::string& address) {
    return "explore --json '" + address + "'";
}

nlohmann::json explore(const std::string& address) {
    const Outcome outcome = run(exploredBy(address));
    EXPECT_EQ(outcome.code, 0) << outcome.error;
    return nlohmann::json::parse(outcome.output, nullptr, false);
}

void expectTheWhole(const nlohmann::json& skin) {
    ASSERT_TRUE(skin.is_object());
    EXPECT_EQ(skin["modules"].size(), theSkin().modules.size());
    EXPECT_EQ(skin["links"].size(), theSkin().links.size());
    EXPECT_EQ(skin["host_links"].size(), 1U);
    EXPECT_TRUE(skin["silent_cells"].empty());
}

/// The program, running until it is told to quit.
class VirtualSkin {
  public:
    explicit VirtualSkin(const QStringList& arguments) {
        program_.start(QStringLiteral(SKINCAL_PROGRAM), QStringList{"virtual-skin", kScenario} + arguments);
        EXPECT_TRUE(waitFor([&] { return program_.canReadLine() || program_.state() == QProcess::NotRunning; }));
        address = program_.readLine().trimmed().toStdString();
        EXPECT_FALSE(address.empty()) << program_.readAllStandardError().toStdString();
    }
    ~VirtualSkin() {
        if (program_.state() == QProcess::NotRunning)
            return;
        program_.kill();
        program_.waitForFinished();
    }

    /// What it says to that.
    std::string tell(const QByteArray& order) {
        program_.write(order + '\n');
        QByteArray answer;
        EXPECT_TRUE(waitFor([&] {
            answer += program_.readAllStandardError();
            return answer.endsWith('\n') || program_.state() == QProcess::NotRunning;
        }));
        return answer.trimmed().toStdString();
    }
    /// Its exit code.
    int quit() {
        program_.write("quit\n");
        EXPECT_TRUE(waitFor([&] { return program_.state() == QProcess::NotRunning; }));
        return program_.exitStatus() == QProcess::NormalExit ? program_.exitCode() : -1;
    }

    std::string address;

  private:
    QProcess program_;
};

TEST(VirtualSkinCommand, IsReachedThroughAPseudoTerminal) {
    const QTemporaryDir folder;
    const QString link = QDir(folder.path()).filePath(QStringLiteral("skin"));
    VirtualSkin skin({"--link", link});
    EXPECT_EQ(skin.address, link.toStdString());
    expectTheWhole(explore(skin.address));
    EXPECT_EQ(skin.quit(), 0);
}

TEST(VirtualSkinCommand, IsReachedThroughTcp) {
    VirtualSkin skin({"--tcp", "0"});
    EXPECT_THAT(skin.address, HasSubstr("tcp://localhost:"));
    const nlohmann::json first = explore(skin.address);
    expectTheWhole(first);
    EXPECT_EQ(explore(skin.address), first) << "whoever comes next";
    EXPECT_EQ(skin.quit(), 0);
}

TEST(VirtualSkinCommand, IsReachedThroughItsInputAndOutput) {
    expectTheWhole(explore(std::string("exec:") + SKINCAL_PROGRAM + " virtual-skin " + kScenario + " --stdio"));
}

TEST(VirtualSkinCommand, ADeadModuleIsMissedAndACutWireToo) {
    const std::string program = std::string("exec:") + SKINCAL_PROGRAM + " virtual-skin " + kScenario + " --stdio ";
    const nlohmann::json without = explore(program + "--dead " + std::to_string(aLeaf().value));
    EXPECT_EQ(without["modules"].size(), theSkin().modules.size() - 1);
    EXPECT_EQ(without["links"].size(), theSkin().links.size() - 1);
    const Link link = aLinkOfARing();
    const nlohmann::json cut =
        explore(program + "--cut " + std::to_string(link.a.value) + ":" + std::to_string(link.a_port));
    EXPECT_EQ(cut["modules"].size(), theSkin().modules.size());
    EXPECT_EQ(cut["links"].size(), theSkin().links.size() - 1);
    for (const std::string nonsense : {"--dead 4711", "--cut 4711:0", "--cut 1", "--cut 1:99"}) {
        const Outcome outcome = run(std::string("virtual-skin ") + kScenario + " --stdio " + nonsense);
        EXPECT_EQ(outcome.code, 2) << nonsense;
        EXPECT_THAT(outcome.error, HasSubstr(nonsense.substr(0, 5))) << nonsense;
    }
}

TEST(VirtualSkinCommand, ModulesThatRestartAgainAndAgainAreFoundAllTheSame) {
    VirtualSkin skin({"--tcp", "0", "--reset-every", "0.3"});
    for (int time = 0; time < 3; ++time)
        expectTheWhole(explore(skin.address));
}

TEST(VirtualSkinCommand, DoesWhatItIsToldOnItsInput) {
    const QTemporaryDir folder;
    VirtualSkin skin({"--link", QDir(folder.path()).filePath(QStringLiteral("skin"))});
    const std::string leaf = std::to_string(aLeaf().value);
    for (const std::string& order : {std::string("turn 0 0 1"), std::string("view 0"), "reset " + leaf})
        EXPECT_EQ(skin.tell(order.c_str()), "done: " + order);
    expectTheWhole(explore(skin.address));

    EXPECT_EQ(skin.tell("unplug"), "done: unplug");
    const Outcome unplugged = run(exploredBy(skin.address));
    EXPECT_EQ(unplugged.code, 2);
    EXPECT_THAT(unplugged.error, HasSubstr("is the adapter plugged in?"));
    EXPECT_EQ(skin.tell("plug"), "done: plug");
    expectTheWhole(explore(skin.address));

    EXPECT_EQ(skin.tell(("kill " + leaf).c_str()), "done: kill " + leaf);
    EXPECT_EQ(explore(skin.address)["modules"].size(), theSkin().modules.size() - 1);

    EXPECT_THAT(skin.tell("turn 0 0 0"), HasSubstr("turn X Y Z was expected"));
    EXPECT_THAT(skin.tell("view 4711"), HasSubstr("view N was expected"));
    EXPECT_THAT(skin.tell("kill 4711"), HasSubstr("kill MODULE was expected"));
    EXPECT_THAT(skin.tell("dance"), HasSubstr("one of these was expected"));
    EXPECT_EQ(skin.quit(), 0);
}

TEST(VirtualSkinCommand, ARunGoesOnOnceAGatewayThatWasKilledIsThereAgain) {
    const QTemporaryDir folder;
    const auto at = [&](const char* name) { return QDir(folder.path()).filePath(QLatin1String(name)); };
    ASSERT_TRUE(writeCameraModel(at("lens.yaml").toStdString(), findScenario(kScenario)->camera));
    auto skin = std::make_unique<VirtualSkin>(QStringList{"--tcp", "0"});
    const QString address = QString::fromStdString(skin->address);
    const QString port = address.section(u':', -1);
    QProcess program;
    program.setProcessChannelMode(QProcess::MergedChannels);
    program.start(QStringLiteral(SKINCAL_PROGRAM),
                  {"run", "--device", address, "--intrinsics", at("lens.yaml"), "-o", at("w.skinrec"), "--poses", "2",
                   "--views", "0", "--on-pose", "true"});
    QByteArray output;
    const auto saidSoon = [&](const char* text) {
        return waitFor([&] {
                   output += program.readAll();
                   return output.contains(text) || program.state() == QProcess::NotRunning;
               }) &&
               output.contains(text);
    };
    ASSERT_TRUE(saidSoon("Pose 2 of 2")) << output.toStdString();
    skin.reset();
    ASSERT_TRUE(saidSoon("Waiting until it is there again")) << output.toStdString();
    skin = std::make_unique<VirtualSkin>(QStringList{"--tcp", port});
    ASSERT_TRUE(saidSoon("The skin is there again")) << output.toStdString();
    EXPECT_EQ(skin->tell("turn 1 0 0"), "done: turn 1 0 0");
    ASSERT_TRUE(waitFor([&] { return program.state() == QProcess::NotRunning; }));
    output += program.readAll();
    EXPECT_NE(program.exitCode(), 2) << output.toStdString();
    EXPECT_EQ(output.count("Waiting until"), 1) << output.toStdString();
    const auto recording = readRecording(at("w.skinrec").toStdString());
    ASSERT_TRUE(recording) << output.toStdString();
    EXPECT_EQ(recording->gravity.size(), 2 * theSkin().modules.size());
}

/// A terminal's foreground is a shell that only waits; what runs in its background reads from a keyboard that is not
/// its own.
class Backgrounded {
  public:
    explicit Backgrounded(const std::string& link) {
        session_ = ::forkpty(&keyboard_, nullptr, nullptr, nullptr);
        if (session_ != 0)
            return;
        if (::fork() == 0) {
            ::setpgid(0, 0);
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            ::execl(SKINCAL_PROGRAM, SKINCAL_PROGRAM, "virtual-skin", kScenario, "--link", link.c_str(), nullptr);
            ::_exit(1);
        }
        while (true)
            ::pause();
    }
    ~Backgrounded() {
        ::kill(session_, SIGKILL);
        ::waitpid(session_, nullptr, 0);
        ::close(keyboard_);
    }
    Backgrounded(const Backgrounded&) = delete;
    Backgrounded& operator=(const Backgrounded&) = delete;

    void type(const std::string& text) const {
        ASSERT_EQ(::write(keyboard_, text.data(), text.size()), ssize_t(text.size()));
    }

  private:
    int keyboard_ = -1;
    pid_t session_ = -1;
};

TEST(VirtualSkinCommand, GoesOnInTheBackgroundOfAShellWhateverIsTyped) {
    const QTemporaryDir folder;
    const std::string link = folder.filePath(QStringLiteral("skin")).toStdString();
    const Backgrounded skin(link);
    skin.type("skincal explore\n");
    ASSERT_TRUE(waitFor([&] { return QFileInfo::exists(QString::fromStdString(link)); }));
    skin.type("and another line\n");
    const Outcome outcome = run("explore " + link);
    EXPECT_EQ(outcome.code, 0) << outcome.error;
}

}  // namespace
}  // namespace skincal::test
