#include "core/camera_calibration/board_collector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/unit/camera_calibration/board_painter.h"

namespace skincal {
namespace {

const CameraModel kCamera{640, 480, 640, 640, 320, 240, DistortionModel::PlumbBob, {}};
const BoardPlan kPlan{BoardKind::Chessboard, 9, 6, 0.03, 0, {}};

BoardView viewAt(const Vector3d& middle, const Vector3d& turn, cv::Size size = {640, 480}) {
    Random random(1, "view");
    const Matrix3d R = so3Exp(turn);
    const Vector3d offset = R * Vector3d(kPlan.width() / 2, kPlan.height() / 2, 0);
    BoardView view = test::seeBoard(kCamera, kPlan, makeIsometry(R, middle - offset), random, 0);
    view.size = size;
    return view;
}

bool wants(const BoardCollector& collector, BoardWish wish) {
    const auto missing = collector.missing();
    return std::any_of(missing.begin(), missing.end(), [&](const MissingView& m) { return m.wish == wish; });
}

TEST(BoardCollector, PlacementTellsSidesDistanceAndAngles) {
    EXPECT_NEAR(placementOf(viewAt({0, 0, 0.5}, Vector3d::Zero()), kPlan).x, 0.5, 0.01);
    EXPECT_LT(placementOf(viewAt({-0.1, 0, 0.5}, Vector3d::Zero()), kPlan).x, 0.2);
    EXPECT_GT(placementOf(viewAt({0, 0.1, 0.5}, Vector3d::Zero()), kPlan).y, 0.8);
    EXPECT_GT(placementOf(viewAt({0, 0, 0.4}, Vector3d::Zero()), kPlan).size,
              placementOf(viewAt({0, 0, 0.8}, Vector3d::Zero()), kPlan).size);
    for (const double angle : {-30.0, -10.0, 10.0, 30.0}) {
        const double radians = angle * std::numbers::pi / 180;
        // About y by the left-hand side towards the camera: the right side goes away.
        EXPECT_NEAR(placementOf(viewAt({0, 0, 0.6}, {0, -radians, 0}), kPlan).turn_deg, angle, 1);
        EXPECT_NEAR(placementOf(viewAt({0, 0, 0.6}, {radians, 0, 0}), kPlan).tilt_deg, angle, 1);
    }
}

TEST(BoardCollector, OnlyBoardsHeldStillAreKept) {
    BoardCollector collector(kPlan);
    EXPECT_EQ(collector.offer(viewAt({0, 0, 0.5}, Vector3d::Zero())), OfferOutcome::Moving) << "nothing before it";
    EXPECT_EQ(collector.offer(viewAt({0.02, 0, 0.5}, Vector3d::Zero())), OfferOutcome::Moving);
    EXPECT_EQ(collector.offer(viewAt({0.0205, 0, 0.5}, Vector3d::Zero())), OfferOutcome::Kept);
    EXPECT_EQ(collector.offer(viewAt({0.0205, 0, 0.5}, Vector3d::Zero())), OfferOutcome::Redundant);
    EXPECT_EQ(collector.views().size(), 1U);
}

TEST(BoardCollector, RedundantViewsAndOtherSizesAreNotKept) {
    Random random(3, "redundant");
    BoardCollectorOptions options;
    options.mustBeStill = false;
    BoardCollector collector(kPlan, options);
    EXPECT_EQ(collector.offer(viewAt({0, 0, 0.5}, Vector3d::Zero())), OfferOutcome::Kept);
    for (int i = 0; i < 50; ++i) {
        const Vector3d middle(random.uniform(-0.005, 0.005), random.uniform(-0.005, 0.005), 0.5);
        EXPECT_EQ(collector.offer(viewAt(middle, 0.02 * random.normal3())), OfferOutcome::Redundant);
    }
    EXPECT_EQ(collector.offer(viewAt({0, 0, 0.5}, Vector3d::Zero(), {1280, 960})), OfferOutcome::OtherSize);
    EXPECT_EQ(collector.offer(viewAt({0, 0, 0.5}, {0.5, 0, 0})), OfferOutcome::Kept);
    EXPECT_EQ(collector.offer(viewAt({0, 0, 1.3}, Vector3d::Zero())), OfferOutcome::Kept);
    collector.remove(1);
    EXPECT_EQ(collector.views().size(), 2U);
    EXPECT_EQ(collector.placements().size(), 2U);
    EXPECT_THROW(collector.remove(2), std::logic_error);
    // What the operator takes back is not asked what it adds.
    const BoardView near = collector.views().front();
    collector.takeBack(near);
    EXPECT_EQ(collector.views().size(), 3U);
    EXPECT_EQ(collector.placements().size(), 3U);
    collector.takeBack(viewAt({0, 0, 0.5}, Vector3d::Zero(), {1280, 960}));
    EXPECT_EQ(collector.views().size(), 3U) << "of another size";
}

TEST(BoardCollector, EachWishIsFulfilledByTheViewThatItAsksFor) {
    BoardCollectorOptions options;
    options.mustBeStill = false;
    BoardCollector collector(kPlan, options);
    EXPECT_EQ(collector.missing().size(), 10U);
    EXPECT_EQ(collector.progress(), 0);
    const auto fulfils = [&](BoardWish wish, const Vector3d& middle, const Vector3d& turn) {
        EXPECT_TRUE(wants(collector, wish)) << static_cast<int>(wish);
        EXPECT_EQ(collector.offer(viewAt(middle, turn)), OfferOutcome::Kept);
        EXPECT_FALSE(wants(collector, wish)) << static_cast<int>(wish);
    };
    fulfils(BoardWish::LeftEdge, {-0.12, 0, 0.5}, Vector3d::Zero());
    fulfils(BoardWish::RightEdge, {0.12, 0, 0.5}, Vector3d::Zero());
    fulfils(BoardWish::TopEdge, {0, -0.12, 0.5}, Vector3d::Zero());
    fulfils(BoardWish::BottomEdge, {0, 0.12, 0.5}, Vector3d::Zero());
    fulfils(BoardWish::Turn, {0, 0, 0.5}, {0, 0.5, 0});
    fulfils(BoardWish::Tilt, {0, 0, 0.5}, {-0.5, 0, 0});
    fulfils(BoardWish::Nearer, {0, 0, 0.31}, Vector3d::Zero());
    fulfils(BoardWish::Farther, {0, 0, 0.8}, Vector3d::Zero());
}

TEST(BoardCollector, CoverageAndProgressOnlyGrowUntilNothingIsMissing) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        Random random(seed, "coverage");
        BoardCollectorOptions options;
        options.mustBeStill = false;
        BoardCollector collector(kPlan, options);
        double covered = 0;
        double progress = 0;
        int offered = 0;
        for (; offered < 3000 && !collector.missing().empty(); ++offered) {
            const Vector3d middle(random.uniform(-0.2, 0.2), random.uniform(-0.15, 0.15), random.uniform(0.3, 0.9));
            const BoardView view = viewAt(middle, 0.4 * random.normal3());
            if (view.corners.size() != static_cast<std::size_t>(kPlan.cornerCount()))
                continue;
            collector.offer(view);
            EXPECT_GE(collector.coveredShare(), covered);
            EXPECT_GE(collector.progress(), progress - 1e-12);
            covered = collector.coveredShare();
            progress = collector.progress();
        }
        EXPECT_TRUE(collector.missing().empty());
        EXPECT_EQ(collector.progress(), 1);
        EXPECT_LT(collector.views().size(), 40U) << "most of what was offered was redundant";
        const auto cells = collector.coverage();
        EXPECT_EQ(cells.size(), 48U);
    }
}

TEST(BoardCollector, BrokenContractsThrow) {
    EXPECT_THROW(BoardCollector(BoardPlan{BoardKind::Chessboard, 0, 0, 0, 0, {}}), std::logic_error);
    BoardCollectorOptions options;
    options.gridRows = 0;
    EXPECT_THROW(BoardCollector(kPlan, options), std::logic_error);
    EXPECT_THROW((void)placementOf(BoardView{}, kPlan), std::logic_error);
}

}  // namespace
}  // namespace skincal
