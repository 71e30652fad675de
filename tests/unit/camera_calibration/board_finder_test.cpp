#include "core/camera_calibration/board_finder.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/unit/camera_calibration/board_painter.h"

namespace skincal {
namespace {

const CameraModel kCamera{640, 480, 560, 562, 322, 236, DistortionModel::PlumbBob, {-0.15, 0.05, 5e-4, -3e-4, 0}};

std::vector<BoardPlan> plans() {
    return {{BoardKind::Chessboard, 8, 5, 0.03, 0, {}},
            {BoardKind::Charuco, 7, 5, 0.03, 0.022, MarkerDictionary::Dict4x4_50}};
}

/// A board that lies in the picture as a whole.
Eigen::Isometry3d wholePose(const BoardPlan& plan, Random& random) {
    for (;;) {
        const Eigen::Isometry3d T_v_b = test::randomPose(kCamera, plan, random, 25);
        bool whole = T_v_b.translation().z() > 0;
        for (const double x : {-0.4, plan.columns + 0.4}) {
            for (const double y : {-0.4, plan.rows + 0.4}) {
                const auto pixel = kCamera.project(T_v_b * Vector3d(x * plan.square, y * plan.square, 0));
                whole = whole && pixel && kCamera.contains(*pixel);
            }
        }
        if (whole)
            return T_v_b;
    }
}

/// Distance to the truth, whichever way round a chessboard was counted.
double meanError(const BoardView& view, const BoardPlan& plan, const Eigen::Isometry3d& T_v_b) {
    double best = 1e9;
    for (const bool turned : {false, true}) {
        if (turned && plan.kind == BoardKind::Charuco)
            break;
        double sum = 0;
        for (const BoardCorner& corner : view.corners) {
            const int id = turned ? plan.cornerCount() - 1 - corner.id : corner.id;
            sum += (*kCamera.project(T_v_b * plan.corner(id)) - corner.pixel).norm();
        }
        best = std::min(best, sum / static_cast<double>(view.corners.size()));
    }
    return best;
}

TEST(FindBoard, CornersAreRightToAFractionOfAPixelWithoutBias) {
    for (const BoardPlan& plan : plans()) {
        Random random(1, "find board");
        Vector2d bias = Vector2d::Zero();
        int found = 0;
        for (std::uint64_t trial = 0; trial < 6; ++trial) {
            const Eigen::Isometry3d T_v_b = wholePose(plan, random);
            test::PaintOptions options;
            options.seed = trial;
            const auto view = findBoard(test::paintBoard(kCamera, plan, T_v_b, options), plan);
            if (!view)
                continue;
            ++found;
            // Between markers there is less of a picture to go by.
            EXPECT_LT(meanError(*view, plan, T_v_b), plan.kind == BoardKind::Chessboard ? 0.1 : 0.15);
            EXPECT_NEAR(view->blur_px, options.blur_px, 0.35);
            if (plan.kind == BoardKind::Charuco) {
                for (const BoardCorner& corner : view->corners)
                    bias += (corner.pixel - *kCamera.project(T_v_b * plan.corner(corner.id))) /
                            static_cast<double>(view->corners.size());
            }
        }
        EXPECT_GE(found, 5);
        EXPECT_LT((bias / found).norm(), 0.03) << "half a pixel would show here";
    }
}

TEST(FindBoard, BlurredBoardsAreRefusedAtAnyDistance) {
    for (const BoardPlan& plan : plans()) {
        for (const double depth : {0.28, 0.36}) {
            const Eigen::Isometry3d T_v_b =
                makeIsometry(so3Exp({0.1, 0.15, 0.1}), {-plan.width() / 2, -plan.height() / 2, depth});
            test::PaintOptions options;
            options.blur_px = 0.8;
            const cv::Mat sharp = test::paintBoard(kCamera, plan, T_v_b, options);
            const auto view = findBoard(sharp, plan);
            ASSERT_TRUE(view) << static_cast<int>(view.error().miss);
            EXPECT_LT(view->blur_px, 1.2);
            // By movement to the side, too: edges along the way stay sharp.
            cv::Mat moved;
            cv::blur(sharp, moved, {8, 1});
            cv::Mat defocused;
            cv::GaussianBlur(sharp, defocused, {}, 2.2);
            for (const cv::Mat& picture : {moved, defocused}) {
                const auto blurred = findBoard(picture, plan);
                ASSERT_FALSE(blurred) << "accepted with " << blurred->blur_px;
                EXPECT_NE(blurred.error().miss, BoardMiss::TooSmall);
            }
        }
    }
}

TEST(FindBoard, MeasuredBlurFollowsTheTrueOne) {
    const BoardPlan plan = plans()[0];
    const Eigen::Isometry3d T_v_b = makeIsometry(so3Exp({0.1, 0.15, 0.1}), {-0.12, -0.07, 0.32});
    BoardFinderOptions any;
    any.maxBlur_px = 100;
    for (const double blur : {0.6, 1.0, 1.5, 2.5}) {
        test::PaintOptions options;
        options.blur_px = blur;
        const auto view = findBoard(test::paintBoard(kCamera, plan, T_v_b, options), plan, any);
        ASSERT_TRUE(view);
        EXPECT_NEAR(view->blur_px, std::sqrt(blur * blur + 0.1), 0.15) << blur;
    }
}

TEST(FindBoard, APartOfACharucoBoardIsEnough) {
    const BoardPlan plan = plans()[1];
    const Eigen::Isometry3d T_v_b = makeIsometry(so3Exp({0.1, 0.15, 0.1}), {-0.24, -0.07, 0.32});
    const auto view = findBoard(test::paintBoard(kCamera, plan, T_v_b), plan);
    ASSERT_TRUE(view);
    EXPECT_LT(view->corners.size(), static_cast<std::size_t>(plan.cornerCount()));
    EXPECT_LT(meanError(*view, plan, T_v_b), 0.1);
}

TEST(FindBoard, SaysWhatIsWrong) {
    const cv::Mat empty(480, 640, CV_8UC3, cv::Scalar(90, 90, 90));
    for (const BoardPlan& plan : plans()) {
        for (const cv::Mat& picture : {empty, cv::Mat(), cv::Mat(3, 3, CV_8UC1, cv::Scalar(1))}) {
            const auto view = findBoard(picture, plan);
            ASSERT_FALSE(view);
            EXPECT_EQ(view.error().miss, BoardMiss::NotSeen);
        }
        const Eigen::Isometry3d T_v_b = makeIsometry(so3Exp({0.1, 0.15, 0.1}), {-0.1, -0.07, 0.32});
        BoardFinderOptions options;
        options.minSquare_px = 80;
        const auto small = findBoard(test::paintBoard(kCamera, plan, T_v_b), plan, options);
        ASSERT_FALSE(small);
        EXPECT_EQ(small.error().miss, BoardMiss::TooSmall);
        EXPECT_LT(small.error().found, 80);
    }
    const Eigen::Isometry3d T_v_b = makeIsometry(Matrix3d::Identity(), {-0.24, -0.07, 0.3});
    BoardFinderOptions options;
    options.minCorners = 23;
    const auto few = findBoard(test::paintBoard(kCamera, plans()[1], T_v_b), plans()[1], options);
    ASSERT_FALSE(few);
    EXPECT_EQ(few.error().miss, BoardMiss::TooFewCorners);
}

TEST(FindBoard, BrokenContractsThrow) {
    EXPECT_THROW((void)findBoard(cv::Mat(480, 640, CV_16UC1, cv::Scalar(1)), BoardPlan{}), std::logic_error);
    EXPECT_THROW((void)findBoard(cv::Mat(480, 640, CV_8UC2, cv::Scalar(1)), BoardPlan{}), std::logic_error);
    EXPECT_THROW((void)findBoard(cv::Mat(), BoardPlan{BoardKind::Chessboard, 1, 1, 1, 1, {}}), std::logic_error);
    EXPECT_THROW((void)findBoard(cv::Mat(), BoardPlan{}, {1, 1, 1}), std::logic_error);
}

}  // namespace
}  // namespace skincal
