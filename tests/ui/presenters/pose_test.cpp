#include <gtest/gtest.h>

#include <QSignalSpy>

#include "core/geometry/random.h"
#include "tests/ui/presenters/desk.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;
using test::Desk;
using test::waitFor;
using Phase = PoseCapture::Phase;

TEST(PosePresenter, CapturesByItselfAtRestAndOnlyThen) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    int captured = 0;
    QObject::connect(&desk.pose, &PosePresenter::captured, &desk.pose, [&](int pose) {
        EXPECT_EQ(pose, captured++);
        EXPECT_TRUE(desk.rig.isBodyAtRest());
    });
    desk.pose.setActive(true);
    ASSERT_TRUE(waitFor([&] { return captured == 1; }));
    EXPECT_EQ(desk.pose.restDone(), 1);
    // The same pose is not captured twice.
    pass(desk.rig.clock(), 3s);
    EXPECT_EQ(captured, 1);
    EXPECT_EQ(desk.pose.state().phase, Phase::Captured);
    for (int next = 2; next <= 4; ++next) {
        const auto target = desk.pose.target();
        ASSERT_TRUE(target);
        desk.pose.turnToTarget();
        pass(desk.rig.clock(), 300ms);
        EXPECT_EQ(desk.pose.state().phase, Phase::Moving);
        EXPECT_GT(desk.pose.movement().value_or(0), desk.pose.restsBelow());
        EXPECT_EQ(captured, next - 1);
        ASSERT_TRUE(waitFor([&] { return captured == next; }));
        EXPECT_EQ(desk.pose.covered().size(), static_cast<std::size_t>(next));
        EXPECT_LT(std::acos(std::min(1.0, desk.pose.covered().back().dot(*target))), 10 * kDegree)
            << "the hands turned it to where it should go";
    }
}

TEST(PosePresenter, HandsDoNotReachForASkinThatIsNotTheirs) {
    Desk desk;
    EXPECT_TRUE(desk.pose.hasHands()) << "who has no skin yet may connect theirs";
    ASSERT_TRUE(desk.connectSkin());
    EXPECT_TRUE(desk.pose.hasHands());
    desk.pose.setActive(true);
    ASSERT_TRUE(waitFor([&] { return desk.pose.target().has_value(); }));
    Skin other = desk.rig.world().skin;
    for (SkinModule& module : other.modules)
        module.id.value += 100'000;
    other.links.clear();
    other.hostLinks.clear();
    desk.session().adoptSkin(other);
    EXPECT_FALSE(desk.pose.hasHands());
    EXPECT_FALSE(desk.views.hasHands());
    desk.pose.turnToTarget();
    desk.views.moveCamera();
    EXPECT_TRUE(desk.rig.isBodyAtRest());
}

TEST(PosePresenter, RefusesToCaptureABodyThatMoves) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    desk.pose.setAutomatic(false);
    const QSignalSpy refused(&desk.pose, &PosePresenter::refused);
    const QSignalSpy captured(&desk.pose, &PosePresenter::captured);
    desk.pose.captureNow();
    EXPECT_EQ(captured.count(), 0) << "nobody watches";
    desk.pose.setActive(true);
    pass(desk.rig.clock(), 3s);
    EXPECT_EQ(captured.count(), 0) << "not by itself";
    desk.pose.captureNow();
    EXPECT_EQ(captured.count(), 1);
    desk.rig.turnBody(Vector3d(1, 0, 0));
    pass(desk.rig.clock(), 500ms);
    desk.pose.captureNow();
    EXPECT_EQ(refused.count(), 1);
    EXPECT_EQ(captured.count(), 1);
    pass(desk.rig.clock(), 4s);
    desk.pose.captureNow();
    EXPECT_EQ(captured.count(), 2);
}

TEST(PosePresenter, IsSilentWhereNobodyLooks) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    const QSignalSpy sampled(&desk.pose, &PosePresenter::sampled);
    pass(desk.rig.clock(), 1s);
    EXPECT_EQ(sampled.count(), 0);
    desk.pose.setActive(true);
    pass(desk.rig.clock(), 1s);
    EXPECT_GT(sampled.count(), 10);
    EXPECT_LE(sampled.count(), 31);
    desk.pose.setActive(false);
    EXPECT_EQ(desk.pose.state().phase, Phase::Off);
    EXPECT_FALSE(desk.pose.up());
    const qsizetype before = sampled.count();
    pass(desk.rig.clock(), 1s);
    EXPECT_EQ(sampled.count(), before);
}

TEST(PosePresenter, GoesOnAfterTheSkinWasUnplugged) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    ASSERT_TRUE(desk.capturePoses(1));
    desk.pose.setActive(true);
    pass(desk.rig.clock(), 1s);
    desk.rig.pullSkin();
    ASSERT_TRUE(waitFor([&] { return !desk.workbench.isSkinReady(); }));
    EXPECT_EQ(desk.pose.state().phase, Phase::Off);
    desk.rig.plugSkin();
    ASSERT_TRUE(desk.connectSkin());
    EXPECT_NE(desk.pose.state().phase, Phase::Off);
    ASSERT_TRUE(desk.capturePoses(2));
}

TEST(PosePresenter, DroppedPosesLeaveTheForecast) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    ASSERT_TRUE(desk.capturePoses(4));
    const auto forecast = desk.pose.forecast();
    const auto covered = desk.pose.covered();
    ASSERT_EQ(forecast.size(), 4U);
    EXPECT_FALSE(forecast.front()) << "one pose fixes nothing";
    ASSERT_TRUE(forecast[2] && forecast[3]);
    EXPECT_LT(*forecast[3], *forecast[2]);
    desk.pose.poses().setDropped(3, true);
    EXPECT_TRUE(desk.pose.poses().isDropped(3));
    ASSERT_EQ(desk.pose.forecast().size(), 3U);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(desk.pose.forecast()[i], forecast[i]);
    EXPECT_EQ(desk.pose.covered(), std::vector<Vector3d>(covered.begin(), covered.begin() + 3));
    desk.session().undoStack().undo();
    EXPECT_EQ(desk.pose.forecast(), forecast);
}

TEST(PosePresenter, ACaptureThatIsUndoneIsNotMadeAgainUntilTheBodyMoves) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    desk.pose.setActive(true);
    const auto poses = [&] { return posesOf(desk.session().measured(), desk.session().decisions()).size(); };
    ASSERT_TRUE(waitFor([&] { return poses() == 1; }));
    EXPECT_EQ(desk.session().undoStack().undoText(), "Capture pose 1");
    desk.session().undoStack().undo();
    EXPECT_EQ(poses(), 0U);
    pass(desk.rig.clock(), 4s);
    EXPECT_EQ(poses(), 0U);
    // Looking elsewhere meanwhile moves nothing.
    desk.pose.setActive(false);
    desk.pose.setActive(true);
    pass(desk.rig.clock(), 4s);
    EXPECT_EQ(poses(), 0U);
    ASSERT_TRUE(desk.session().undoStack().canRedo());
    desk.session().undoStack().redo();
    EXPECT_EQ(poses(), 1U);
    desk.session().undoStack().undo();
    desk.rig.turnBody(Vector3d(1, 0, 0));
    ASSERT_TRUE(waitFor([&] { return poses() == 1; })) << "another pose is captured as ever";
    // One that is dropped is captured again at once: whoever drops it wants a better one.
    desk.pose.poses().setDropped(1, true);
    ASSERT_TRUE(waitFor([&] { return poses() == 1; }));
}

TEST(PosePresenter, SaysWhenPosesSuffice) {
    Desk desk;
    EXPECT_EQ(desk.pose.verdict(), PoseVerdict::None);
    EXPECT_EQ(desk.pose.verdictText(), "");
    ASSERT_TRUE(desk.connectSkin());
    ASSERT_TRUE(desk.capturePoses(2));
    EXPECT_EQ(desk.pose.verdict(), PoseVerdict::TooFew);
    ASSERT_TRUE(desk.capturePoses(5));
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    EXPECT_LT(*desk.pose.forecast().back(), PosePresenter::kGoodEdge);
    EXPECT_EQ(desk.pose.verdict(), PoseVerdict::Enough);
    EXPECT_TRUE(desk.pose.verdictText().startsWith("Enough"));
    for (int row = 2; row < 5; ++row)
        desk.pose.poses().setDropped(row, true);
    EXPECT_EQ(desk.pose.verdict(), PoseVerdict::TooFew);
    EXPECT_TRUE(desk.pose.verdictText().startsWith("Not enough"));
}

TEST(PosePresenter, PosesThatAreAlikeAreNotEnough) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    // As one who hardly turns the body would hold it.
    Random random(1);
    for (int pose = 0; pose < 5; ++pose) {
        std::vector<GravityReading> readings;
        for (const SkinModule& module : desk.session().measured().skin.modules) {
            Vector3d g = Vector3d(0.05 * pose, 0.02 * pose * pose, 1).normalized() * 9.81;
            readings.push_back({0, module.id, g + 0.01 * random.normal3(), std::nullopt, std::nullopt});
        }
        desk.session().addPose(std::move(readings));
    }
    EXPECT_NE(desk.pose.verdict(), PoseVerdict::Enough);
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    EXPECT_NE(desk.pose.verdict(), PoseVerdict::Enough);
}

TEST(PoseModel, KeepsItsRowsWhileThePosesAreTheSame) {
    Desk desk;
    ASSERT_TRUE(desk.connectSkin());
    ASSERT_TRUE(desk.capturePoses(3));
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    PoseModel& poses = desk.pose.poses();
    const QSignalSpy reset(&poses, &QAbstractItemModel::modelReset);
    const QSignalSpy changed(&poses, &QAbstractItemModel::dataChanged);
    poses.setDropped(1, true);
    desk.session().undoStack().undo();
    ASSERT_TRUE(waitFor([&] { return desk.isSolved(); }));
    EXPECT_EQ(reset.count(), 0);
    EXPECT_GE(changed.count(), 2);
    ASSERT_TRUE(desk.capturePoses(4));
    EXPECT_EQ(reset.count(), 1);
    EXPECT_EQ(poses.rowCount(), 4);
}

TEST(FarthestDirection, IsFartherFromAllThanAnyOther) {
    EXPECT_FALSE(farthestDirection({}));
    const auto nearest = [](const Vector3d& direction, const std::vector<Vector3d>& covered) {
        double angle = 4;
        for (const Vector3d& other : covered) {
            const double between = std::acos(std::clamp(direction.dot(other), -1.0, 1.0));
            angle = std::min({angle, between, 210 * kDegree - between});
        }
        return angle;
    };
    const auto second = farthestDirection({Vector3d::UnitZ()});
    EXPECT_LT(std::abs(second->z()), 0.5) << "across, not upside down: that would leave the turn about gravity open";
    Random random(1);
    for (int i = 0; i < 200; ++i) {
        std::vector<Vector3d> covered;
        for (std::size_t n = 0; n <= random.index(12); ++n)
            covered.push_back(random.direction());
        const auto best = farthestDirection(covered);
        ASSERT_TRUE(best);
        EXPECT_NEAR(best->norm(), 1, 1e-12);
        EXPECT_EQ(*best, *farthestDirection(covered));
        for (int k = 0; k < 50; ++k)
            EXPECT_GT(nearest(*best, covered) + 15 * kDegree, nearest(random.direction(), covered));
    }
}

}  // namespace
}  // namespace skincal
