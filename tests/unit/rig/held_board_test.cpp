#include "core/rig/held_board.h"

#include <gtest/gtest.h>

#include <QSignalSpy>
#include <opencv2/imgproc.hpp>

#include "core/camera_calibration/board_collector.h"
#include "core/camera_calibration/board_finder.h"
#include "core/camera_calibration/calibrate_camera.h"
#include "core/rig/board_painter.h"
#include "core/rig/simulated_camera.h"
#include "tests/unit/rig/pass.h"

namespace skincal {
namespace {

using namespace std::chrono_literals;

std::vector<BoardPlan> plans() {
    BoardPlan chess;
    chess.kind = BoardKind::Chessboard;
    BoardPlan upright;
    upright.columns = 5;
    upright.rows = 8;
    upright.square = 0.04;
    upright.marker = 0.03;
    return {BoardPlan{}, chess, upright};
}

/// Before a grey wall.
cv::Mat pictureOf(const HeldLayer& layer, const CameraModel& camera) {
    cv::Mat picture(camera.height, camera.width, CV_32F, cv::Scalar(70));
    cv::Mat part = picture(cv::Rect(layer.corner, layer.cover.size()));
    part = part.mul(1 - layer.cover) + layer.light;
    picture.convertTo(picture, CV_8U);
    return picture;
}

/// Mean square of how much pixels beside each other differ, fine noise smoothed away: a smear spreads a step over
/// several and leaves less of that.
double sharpnessOf(const cv::Mat& picture) {
    cv::Mat smooth, dx, dy;
    cv::GaussianBlur(picture, smooth, {}, 1);
    smooth.convertTo(smooth, CV_32F);
    cv::Sobel(smooth, dx, CV_32F, 1, 0);
    cv::Sobel(smooth, dy, CV_32F, 0, 1);
    return (dx.dot(dx) + dy.dot(dy)) / static_cast<double>(picture.total());
}

TEST(HeldBoard, StaysInThePictureAndStillInEveryPlace) {
    const CameraModel camera = simulatedWebcam();
    for (const BoardPlan& plan : plans()) {
        const HeldBoard::Time start = 7s;
        const HeldBoard board(plan, camera, start);
        EXPECT_EQ(board.pose(0s).matrix(), board.pose(start).matrix());
        for (std::size_t place = 0; place < 2 * board.places(); ++place) {
            const auto begin = start + static_cast<int>(place) * (HeldBoard::kStill + HeldBoard::kMove);
            EXPECT_EQ(board.pose(begin).matrix(), board.pose(begin + HeldBoard::kStill).matrix());
            EXPECT_TRUE(board.isStill(begin + HeldBoard::kStill));
            EXPECT_FALSE(board.isStill(begin + HeldBoard::kStill + 1ms));
            EXPECT_TRUE(isRigid(board.pose(begin + HeldBoard::kStill + 200ms)));
            const double m = HeldBoard::kPaper * plan.square;
            for (const double x : {-m, plan.width() + m}) {
                for (const double y : {-m, plan.height() + m}) {
                    const auto pixel = camera.project(board.pose(begin) * Vector3d(x, y, 0));
                    ASSERT_TRUE(pixel);
                    EXPECT_TRUE(camera.contains(*pixel)) << place << ": " << pixel->transpose();
                }
            }
        }
    }
    BoardPlan none;
    none.columns = 1;
    EXPECT_THROW(HeldBoard(none, camera, 0s), std::logic_error);
}

TEST(HeldBoard, ItsPlacesAreAllThatACollectorAsksFor) {
    const CameraModel camera = simulatedWebcam();
    for (const BoardPlan& plan : plans()) {
        const HeldBoard board(plan, camera, 0s);
        BoardCollectorOptions options;
        options.mustBeStill = false;
        BoardCollector collector(plan, options);
        for (std::size_t place = 0; place < board.places(); ++place) {
            BoardView view;
            view.size = {camera.width, camera.height};
            const Isometry3d T_v_b = board.pose(static_cast<int>(place) * (HeldBoard::kStill + HeldBoard::kMove));
            for (int id = 0; id < plan.cornerCount(); ++id)
                view.corners.push_back({id, *camera.project(T_v_b * plan.corner(id))});
            collector.offer(view);
        }
        for (const MissingView& missing : collector.missing())
            ADD_FAILURE() << "wish " << static_cast<int>(missing.wish) << ": " << missing.have << " of "
                          << missing.need;
        EXPECT_GE(collector.views().size(), 12U);
    }
}

TEST(BoardPainter, CornersAreWhereTheCameraModelHasThem) {
    const CameraModel camera = simulatedWebcam();
    BoardPainter painter(camera, 0.9);
    for (const BoardPlan& plan : plans()) {
        const HeldBoard board(plan, camera, 0s);
        for (std::size_t place = 0; place < board.places(); ++place) {
            const Isometry3d T_v_b = board.pose(static_cast<int>(place) * (HeldBoard::kStill + HeldBoard::kMove));
            const auto view = findBoard(pictureOf(painter.paint(plan, std::vector{T_v_b}), camera), plan);
            ASSERT_TRUE(view) << place << ": " << static_cast<int>(view.error().miss);
            double sum = 0;
            for (const BoardCorner& corner : view->corners) {
                double least = 1e9;
                // A chessboard's corners may be counted from either end.
                for (const int id : {corner.id, plan.cornerCount() - 1 - corner.id})
                    least = std::min(least, (corner.pixel - *camera.project(T_v_b * plan.corner(id))).squaredNorm());
                sum += least;
            }
            EXPECT_LT(std::sqrt(sum / static_cast<double>(view->corners.size())), 0.1) << place;
            EXPECT_LT(view->blur_px, 1.3);
        }
    }
    EXPECT_THROW((void)painter.paint({}, std::vector<Isometry3d>(2)), std::logic_error);
}

TEST(BoardPainter, TheLensFollowsFromThePictures) {
    const CameraModel camera = simulatedWebcam();
    BoardPainter painter(camera, 0.9);
    for (const BoardPlan& plan : plans()) {
        const HeldBoard board(plan, camera, 0s);
        std::vector<BoardView> views;
        for (std::size_t place = 0; place < board.places(); ++place) {
            const Isometry3d T_v_b = board.pose(static_cast<int>(place) * (HeldBoard::kStill + HeldBoard::kMove));
            views.push_back(findBoard(pictureOf(painter.paint(plan, std::vector{T_v_b}), camera), plan).value());
        }
        const auto result = calibrateCamera(views, plan);
        ASSERT_TRUE(result);
        const CameraModel& k = result->camera;
        const IntrinsicsSigma& s = *result->sigma;
        EXPECT_LT(result->rms_px, 0.1);
        constexpr double kSigmas = 3;
        EXPECT_NEAR(k.fx, camera.fx, kSigmas * s.fx);
        EXPECT_NEAR(k.fy, camera.fy, kSigmas * s.fy);
        EXPECT_NEAR(k.cx, camera.cx, kSigmas * s.cx);
        EXPECT_NEAR(k.cy, camera.cy, kSigmas * s.cy);
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_NEAR(k.distortion[i], camera.distortion[i], kSigmas * s.distortion[i]);
    }
}

TEST(SimulatedCamera, ShowsTheBoardThatIsHeldAndSmearsItWhileItMoves) {
    SimulatedRig rig(*findScenario("coded"), 4);
    rig.setSpeed(0);
    SimulatedCamera camera(rig);
    std::vector<CameraFrame> frames;
    QObject::connect(&camera, &FrameSource::frameArrived, &camera,
                     [&](const CameraFrame& frame) { frames.push_back(frame); });
    camera.start();
    pass(rig.clock(), 50ms);
    const BoardPlan plan;
    EXPECT_FALSE(findBoard(frames.back().image, plan));
    rig.holdBoard(plan);
    pass(rig.clock(), HeldBoard::kStill);
    const auto still = findBoard(frames.back().image, plan);
    ASSERT_TRUE(still);
    EXPECT_EQ(still->corners.size(), static_cast<std::size_t>(plan.cornerCount()));
    // Half-way from the middle to a corner it is not found; its edges are softer than in both places.
    pass(rig.clock(), 4 * (HeldBoard::kStill + HeldBoard::kMove));
    const double before = sharpnessOf(frames.back().image);
    pass(rig.clock(), HeldBoard::kMove / 2);
    const double during = sharpnessOf(frames.back().image);
    pass(rig.clock(), HeldBoard::kMove / 2 + HeldBoard::kStill);
    const double after = sharpnessOf(frames.back().image);
    EXPECT_LT(during, 0.5 * std::min(before, after));
    rig.putBoardAway();
    pass(rig.clock(), 50ms);
    EXPECT_FALSE(findBoard(frames.back().image, plan));
}

}  // namespace
}  // namespace skincal
