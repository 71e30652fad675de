#include <gtest/gtest.h>

#include <QSignalSpy>

#include "tests/ui/presenters/desk.h"
#include "tests/unit/skin/grids.h"
#include "ui/texts/sentences.h"

namespace skincal {
namespace {

using test::Desk;
using test::looseModules;
using test::waitFor;
using Phase = Connection::Phase;

TEST(ConnectPresenter, LeadsFromADeviceToANetwork) {
    Desk desk;
    EXPECT_EQ(desk.connection.state().phase, Phase::Disconnected);
    ASSERT_TRUE(desk.connectSkin());
    EXPECT_EQ(desk.connection.state().phase, Phase::Connected);
    EXPECT_EQ(desk.connection.found().size(), desk.rig.world().skin.modules.size());
    EXPECT_EQ(desk.session().measured().skin.links.size(), desk.rig.world().skin.links.size());
    EXPECT_GT(desk.connection.links().rowCount(), 0);
    // Explored again it is the same skin, and what was measured stays.
    ASSERT_TRUE(desk.capturePoses(1));
    desk.connection.connectSkin();
    EXPECT_EQ(desk.connection.state().phase, Phase::Exploring);
    EXPECT_FALSE(desk.workbench.isSkinReady());
    ASSERT_TRUE(waitFor([&] { return desk.workbench.isSkinReady(); }));
    EXPECT_EQ(posesOf(desk.session().measured(), {}).size(), 1U);
    EXPECT_EQ(desk.connection.found().size(), desk.rig.world().skin.modules.size());
}

TEST(ConnectPresenter, MayBeDisconnectedAtAnyMoment) {
    for (std::size_t modules = 0; modules <= 14; modules += 7) {
        Desk desk;
        desk.connection.connectSkin();
        ASSERT_TRUE(waitFor([&] { return desk.connection.found().size() >= modules; }));
        desk.connection.disconnectSkin();
        EXPECT_EQ(desk.connection.state().phase, Phase::Disconnected);
        EXPECT_FALSE(desk.workbench.isSkinReady());
        // The echo of the first connection does not end the second.
        ASSERT_TRUE(desk.connectSkin());
        EXPECT_EQ(desk.connection.found().size(), desk.rig.world().skin.modules.size());
    }
}

TEST(ConnectPresenter, SaysThatTheSkinWasUnplugged) {
    for (const bool whileExploring : {true, false}) {
        Desk desk;
        desk.connection.connectSkin();
        ASSERT_TRUE(waitFor(
            [&] { return whileExploring ? desk.connection.found().size() > 3 : desk.workbench.isSkinReady(); }));
        desk.rig.pullSkin();
        ASSERT_TRUE(waitFor([&] { return desk.connection.state().phase == Phase::Lost; }));
        EXPECT_EQ(desk.connection.state().fault, Connection::Fault::Failed);
        EXPECT_EQ(desk.connection.why(), "The skin was unplugged") << "in the device's own words";
        EXPECT_FALSE(desk.workbench.isSkinReady());
        EXPECT_EQ(desk.problems.problemAt(0).severity, Problem::Severity::Error);
        desk.connection.connectSkin();
        ASSERT_TRUE(waitFor([&] { return desk.connection.state().phase == Phase::Lost; }));
        EXPECT_FALSE(desk.connection.why().isEmpty());
        desk.rig.plugSkin();
        ASSERT_TRUE(desk.connectSkin());
    }
}

TEST(ConnectPresenter, ModulesThatVanishOrComeMeanwhileAreNamedAndNothingIsLost) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    ASSERT_TRUE(desk.capturePoses(1));
    const auto says = [&](const QString& text) {
        for (int row = 0; row < desk.problems.rowCount(); ++row)
            if (desk.problems.problemAt(row).text.contains(text))
                return true;
        return false;
    };
    const Skin whole = desk.session().measured().skin;
    Skin smaller = whole;
    const ModuleId dead = smaller.modules.back().id;
    smaller.modules.pop_back();
    std::erase_if(smaller.links, [&](const Link& link) { return link.a == dead || link.b == dead; });
    emit desk.workbench.skin()->explored(smaller);
    EXPECT_EQ(desk.connection.gone(), std::vector{dead});
    EXPECT_TRUE(says(QStringLiteral("do not answer any more: %1.").arg(dead.value)) ||
                says(QStringLiteral("does not answer any more: %1.").arg(dead.value)));
    EXPECT_EQ(desk.session().measured().skin.modules.size(), whole.modules.size()) << "what was measured stays";
    EXPECT_TRUE(desk.workbench.isSkinReady());
    Skin larger = whole;
    larger.modules.push_back(whole.modules.front());
    larger.modules.back().id = ModuleId(4711);
    emit desk.workbench.skin()->explored(larger);
    EXPECT_TRUE(desk.connection.gone().empty());
    EXPECT_EQ(desk.connection.strangers(), 1U);
    EXPECT_TRUE(says(QStringLiteral("Connect again to take")));
    emit desk.workbench.skin()->lightMissed({dead});
    EXPECT_TRUE(says(QStringLiteral("did not show the last light it was told to: %1").arg(dead.value)) ||
                says(QStringLiteral("did not show the last light they were told to: %1").arg(dead.value)));
    emit desk.workbench.skin()->lightShown(1);
    EXPECT_FALSE(says(QStringLiteral("did not show")));
    ASSERT_TRUE(desk.connectSkin());
    EXPECT_EQ(desk.connection.strangers(), 0U);
}

TEST(ConnectPresenter, ConnectsAgainOnceTheSkinIsBack) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    ASSERT_TRUE(desk.capturePoses(1));
    desk.rig.pullSkin();
    ASSERT_TRUE(waitFor([&] { return desk.connection.state().phase == Phase::Lost; }));
    desk.rig.plugSkin();
    emit desk.workbench.skin()->cameBack();
    ASSERT_TRUE(waitFor([&] { return desk.workbench.isSkinReady(); }));
    EXPECT_EQ(posesOf(desk.session().measured(), {}).size(), 1U) << "it is the same session";
    // The operator's word counts: what he has disconnected stays so.
    desk.connection.disconnectSkin();
    emit desk.workbench.skin()->cameBack();
    EXPECT_EQ(desk.connection.state().phase, Phase::Disconnected);
}

TEST(ConnectPresenter, HasASentenceForEveryFault) {
    using Fault = Connection::Fault;
    EXPECT_TRUE(sentenceOf({Phase::Connected, 5}, "late words").isEmpty());
    std::set<QString> sentences;
    for (const Fault fault : {Fault::Failed, Fault::Closed, Fault::NoAnswer, Fault::NoModules, Fault::Silent})
        sentences.insert(sentenceOf({Phase::Lost, 0, fault}, {}));
    EXPECT_EQ(sentences.size(), 5U);
    EXPECT_FALSE(sentences.contains(QString()));
    EXPECT_EQ(sentenceOf({Phase::Lost, 0, Fault::Failed}, "no such port"), "No such port");
    for (const char* name : {"tcp://127.0.0.1:5760 is gone", "ttyUSB0 is gone", "gateway.local: it is gone"})
        EXPECT_EQ(sentenceOf({Phase::Lost, 0, Fault::Failed}, name), name) << "with a capital it is another address";
    EXPECT_EQ(saidAlone(Sentence::saying("{} is empty", std::string("lens.yaml"))), "lens.yaml is empty");
    EXPECT_EQ(saidAlone(Sentence::saying("module {} doesn't answer", 3)), "Module 3 doesn't answer");
    EXPECT_TRUE(sentenceOf({Phase::Lost, 1, Fault::Silent}, {}).contains("after 1 module had"));
    EXPECT_TRUE(sentenceOf({Phase::Lost, 2, Fault::Silent}, {}).contains("after 2 modules had"));
}

TEST(ConnectPresenter, AnotherDeviceBeginsAnew) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    desk.connection.chooseDevice(1);
    EXPECT_EQ(desk.connection.state().phase, Phase::Disconnected);
    EXPECT_FALSE(desk.workbench.isSkinReady());
    EXPECT_TRUE(desk.connection.found().empty());
    ASSERT_TRUE(desk.connectSkin());
}

TEST(ConnectPresenter, BlinksOnAndOffAndLeavesTheLedDark) {
    Desk desk;
    const ModuleId module = desk.rig.world().skin.modules.front().id;
    std::vector<bool> steps;
    QObject::connect(&desk.connection, &ConnectPresenter::blinking, &desk.connection, [&](ModuleId who, bool on) {
        EXPECT_EQ(who, module);
        EXPECT_EQ(desk.isDark(), !on);
        steps.push_back(on);
    });
    desk.connection.blink(module);
    EXPECT_TRUE(steps.empty()) << "there is no skin yet";
    ASSERT_TRUE(desk.connectSkin());
    desk.connection.blink(module);
    ASSERT_TRUE(waitFor([&] { return steps.size() == 8; }));
    for (std::size_t i = 0; i < steps.size(); ++i)
        EXPECT_EQ(steps[i], i % 2 == 0);
    EXPECT_TRUE(desk.isDark());
}

TEST(WiringFaults, NamesWhatIsWrongAndNothingElse) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed)
        EXPECT_TRUE(wiringFaults(buildWorld(*findScenario("cylinder"), seed).skin).empty());
    const ModuleTemplate hexagon = paperHexagon();
    Skin skin = looseModules(hexagon, 4);
    const auto id = [&](std::size_t u) { return skin.modules[u].id; };
    const auto linked = [&](std::size_t a, int a_port, std::size_t b, int b_port) {
        return Link{id(a), a_port, id(b), b_port, std::nullopt};
    };
    skin.links = {linked(0, 0, 1, 0), linked(1, 0, 0, 0), linked(1, 1, 2, 1)};
    auto faults = wiringFaults(skin);
    ASSERT_EQ(faults.size(), 1U) << "a link that both ends report is one link";
    EXPECT_EQ(faults[0].kind, WiringFault::Kind::NoLink);
    EXPECT_EQ(faults[0].modules, std::vector<ModuleId>{id(3)});
    skin.links.push_back(linked(3, 2, 1, 1));
    faults = wiringFaults(skin);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].kind, WiringFault::Kind::DoublyWired);
    EXPECT_EQ(faults[0].modules, (std::vector<ModuleId>{id(1), id(2), id(3)}));
    skin.links.back() = linked(3, 2, 2, 0);
    skin.links.push_back(linked(3, 1, 3, 0));
    faults = wiringFaults(skin);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_EQ(faults[0].kind, WiringFault::Kind::SelfLink);
    EXPECT_TRUE(wiringFaults(looseModules(hexagon, 1)).empty()) << "one module alone needs no link";
}

}  // namespace
}  // namespace skincal
