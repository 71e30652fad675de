#include "core/device/recorded_skin.h"

#include <gtest/gtest.h>

#include <QSignalSpy>
#include <memory>

#include "core/simulation/world.h"
#include "tests/unit/rig/pass.h"

namespace skincal {
namespace {

TEST(RecordedSkin, TellsWhatWasRecordedAndStreamsNothing) {
    const World world = buildWorld(*findScenario("coded"), 1);
    RecordedSkin skin(QStringLiteral("arm.skinrec"), world.skin);
    EXPECT_EQ(skin.name(), QStringLiteral("arm.skinrec"));
    const QSignalSpy opened(&skin, &SkinDevice::opened);
    const QSignalSpy closed(&skin, &SkinDevice::closed);
    const QSignalSpy failed(&skin, &SkinDevice::failed);
    const QSignalSpy found(&skin, &SkinDevice::moduleFound);
    const QSignalSpy explored(&skin, &SkinDevice::explored);
    const QSignalSpy shown(&skin, &SkinDevice::lightShown);
    const QSignalSpy acceleration(&skin, &SkinDevice::accelerationArrived);
    const QSignalSpy tactile(&skin, &SkinDevice::tactileArrived);
    skin.explore();
    skin.light({});
    settle();
    EXPECT_EQ(failed.count(), 1);
    EXPECT_EQ(shown.count(), 0);

    skin.open();
    skin.open();
    EXPECT_EQ(opened.count(), 0) << "never from inside the call";
    settle();
    EXPECT_EQ(opened.count(), 1);
    skin.explore();
    skin.streamAcceleration(true);
    skin.streamTactile(true);
    const auto first = skin.light({});
    const auto second = skin.light({});
    EXPECT_GT(second, first);
    EXPECT_EQ(explored.count() + shown.count(), 0);
    settle();
    ASSERT_EQ(explored.count(), 1);
    EXPECT_EQ(static_cast<std::size_t>(found.count()), world.skin.modules.size());
    EXPECT_EQ(explored.at(0).at(0).value<Skin>().links.size(), world.skin.links.size());
    ASSERT_EQ(shown.count(), 2);
    EXPECT_EQ(shown.at(1).at(0).value<std::uint64_t>(), second);
    EXPECT_EQ(acceleration.count() + tactile.count(), 0);

    skin.explore();
    skin.close();
    skin.close();
    settle();
    EXPECT_EQ(explored.count(), 1) << "closed before it could answer";
    EXPECT_EQ(closed.count(), 1);
}

TEST(RecordedSkin, MayBeDestroyedByWhoHearsOfAModule) {
    const World world = buildWorld(*findScenario("coded"), 1);
    auto skin = std::make_unique<RecordedSkin>(QStringLiteral("arm"), world.skin);
    QObject::connect(skin.get(), &SkinDevice::moduleFound, [&] { skin.reset(); });
    skin->open();
    settle();
    skin->explore();
    settle();
    EXPECT_EQ(skin, nullptr);
}

}  // namespace
}  // namespace skincal
