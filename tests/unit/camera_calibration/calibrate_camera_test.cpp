#include "core/camera_calibration/calibrate_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/camera_calibration/board_finder.h"
#include "tests/unit/camera_calibration/board_painter.h"

namespace skincal {
namespace {

const BoardPlan kPlan{BoardKind::Charuco, 10, 7, 0.025, 0.018, MarkerDictionary::Dict5x5_100};

CameraModel randomCamera(std::uint64_t seed, DistortionModel model) {
    Random random(seed, "calibrated camera");
    CameraModel camera;
    camera.width = 1280;
    camera.height = 720;
    camera.fx = random.uniform(800, 1500);
    camera.fy = camera.fx * random.uniform(0.98, 1.02);
    camera.cx = 640 + random.uniform(-30, 30);
    camera.cy = 360 + random.uniform(-30, 30);
    camera.distortionModel = model;
    if (model == DistortionModel::Equidistant)
        camera.distortion = {random.uniform(-0.03, 0.03), random.uniform(-0.01, 0.01), 0.002, -0.001};
    else
        camera.distortion = {random.uniform(-0.3, 0.1), random.uniform(0, 0.1), random.uniform(-1e-3, 1e-3),
                             random.uniform(-1e-3, 1e-3), 0};
    return camera;
}

std::vector<BoardView> randomViews(const CameraModel& camera, std::uint64_t seed, std::size_t count, double sigma_px,
                                   double maxTilt_deg = 35) {
    Random random(seed, "calibration views");
    std::vector<BoardView> views;
    while (views.size() < count) {
        BoardView view =
            test::seeBoard(camera, kPlan, test::randomPose(camera, kPlan, random, maxTilt_deg), random, sigma_px);
        if (view.corners.size() >= 20)
            views.push_back(std::move(view));
    }
    return views;
}

/// Errors over their own sigmas, of the parameters that were estimated.
std::vector<double> normalisedErrors(const CameraCalibration& result, const CameraModel& truth) {
    const IntrinsicsSigma& sigma = result.sigma.value();
    std::vector<double> errors{(result.camera.fx - truth.fx) / sigma.fx, (result.camera.fy - truth.fy) / sigma.fy,
                               (result.camera.cx - truth.cx) / sigma.cx, (result.camera.cy - truth.cy) / sigma.cy};
    for (std::size_t i = 0; i < truth.distortion.size(); ++i) {
        if (sigma.distortion[i] > 0)
            errors.push_back((result.camera.distortion[i] - truth.distortion[i]) / sigma.distortion[i]);
        else
            EXPECT_EQ(result.camera.distortion[i], 0);
    }
    return errors;
}

TEST(CalibrateCamera, ErrorsAreAsLargeAsTheirSigmasSay) {
    for (const DistortionModel model : {DistortionModel::PlumbBob, DistortionModel::Equidistant}) {
        double squares = 0;
        double count = 0;
        for (std::uint64_t seed = 0; seed < 12; ++seed) {
            const CameraModel truth = randomCamera(seed, model);
            CameraCalibrationOptions options;
            options.model = model;
            const auto result = calibrateCamera(randomViews(truth, seed, 14, 0.2), kPlan, options);
            ASSERT_TRUE(result) << result.error().message();
            EXPECT_TRUE(result->rejected.empty());
            EXPECT_NEAR(result->rms_px, 0.2 * std::sqrt(2.0), 0.03);
            for (const double error : normalisedErrors(*result, truth)) {
                EXPECT_LT(std::abs(error), 4) << name(model) << " " << seed;
                squares += error * error;
                ++count;
            }
        }
        EXPECT_NEAR(squares / count, 1, 0.4) << name(model);
    }
}

TEST(CalibrateCamera, WithoutNoiseItIsExact) {
    for (const DistortionModel model : {DistortionModel::PlumbBob, DistortionModel::Equidistant}) {
        const CameraModel truth = randomCamera(3, model);
        CameraCalibrationOptions options;
        options.model = model;
        const auto result = calibrateCamera(randomViews(truth, 3, 12, 0), kPlan, options);
        ASSERT_TRUE(result) << result.error().message();
        EXPECT_NEAR(result->camera.fx, truth.fx, 1e-4);
        EXPECT_NEAR(result->camera.cy, truth.cy, 1e-4);
        EXPECT_LT(result->rms_px, 1e-5);
        EXPECT_EQ(result->trust, CalibrationTrust::Good)
            << (result->reasons.empty() ? -1 : static_cast<int>(result->reasons[0].kind));
    }
}

TEST(CalibrateCamera, BoardsThatDisagreeAreNamed) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
        const CameraModel truth = randomCamera(seed, DistortionModel::PlumbBob);
        std::vector<BoardView> views = randomViews(truth, seed, 14, 0.2);
        Random random(seed, "outliers");
        // A bent board and one whose corners were taken for their neighbours.
        for (BoardCorner& corner : views[4].corners)
            corner.pixel.y() += 4 * std::sin(0.02 * corner.pixel.x());
        for (BoardCorner& corner : views[9].corners)
            corner.pixel += 10 * Vector2d(random.normal(), random.normal());
        const auto result = calibrateCamera(views, kPlan);
        ASSERT_TRUE(result) << result.error().message();
        EXPECT_EQ(result->rejected, (std::vector<std::size_t>{4, 9}));
        EXPECT_FALSE(result->boards[4].used);
        EXPECT_GT(result->boards[4].rms_px, 1);
        EXPECT_LT(result->boards[0].rms_px, 0.5);
        EXPECT_EQ(result->boards[9].residuals.size(), views[9].corners.size());
        for (const double error : normalisedErrors(*result, truth))
            EXPECT_LT(std::abs(error), 4);
    }
}

TEST(CalibrateCamera, PaintedBoardsFoundAndCalibrated) {
    CameraModel truth{640, 480, 560, 562, 322, 236, DistortionModel::PlumbBob, {-0.15, 0.05, 5e-4, -3e-4, 0}};
    const BoardPlan plan{BoardKind::Charuco, 7, 5, 0.03, 0.022, MarkerDictionary::Dict4x4_50};
    Random random(7, "painted");
    std::vector<BoardView> views;
    for (std::uint64_t i = 0; i < 25 && views.size() < 12; ++i) {
        test::PaintOptions paint;
        paint.seed = i;
        paint.samples = 3;
        const auto view = findBoard(test::paintBoard(truth, plan, test::randomPose(truth, plan, random), paint), plan);
        if (view)
            views.push_back(*view);
    }
    ASSERT_EQ(views.size(), 12U);
    const auto result = calibrateCamera(views, plan);
    ASSERT_TRUE(result) << result.error().message();
    EXPECT_LT(result->rms_px, 0.2);
    for (const double error : normalisedErrors(*result, truth))
        EXPECT_LT(std::abs(error), 4);
}

bool hasReason(const CameraCalibration& result, CalibrationReason::Kind kind) {
    return std::any_of(result.reasons.begin(), result.reasons.end(), [&](const auto& r) { return r.kind == kind; });
}

TEST(CalibrateCamera, BoardsThatAllFaceTheCameraAreNotTrusted) {
    const CameraModel truth = randomCamera(1, DistortionModel::PlumbBob);
    const auto result = calibrateCamera(randomViews(truth, 1, 14, 0.2, 1), kPlan);
    if (!result) {
        EXPECT_EQ(result.error().code, ErrorCode::NotConverged);
        return;
    }
    EXPECT_EQ(result->trust, CalibrationTrust::NotToBeTrusted);
    EXPECT_TRUE(hasReason(*result, CalibrationReason::Kind::LittleTilt));
}

TEST(CalibrateCamera, FewBoardsInOneCornerAreNotTrusted) {
    const CameraModel truth = randomCamera(1, DistortionModel::PlumbBob);
    std::vector<BoardView> views = randomViews(truth, 1, 4, 0.2);
    const auto result = calibrateCamera(views, kPlan);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->trust, CalibrationTrust::NotToBeTrusted);
    EXPECT_EQ(result->reasons.front().trust, CalibrationTrust::NotToBeTrusted);
    EXPECT_TRUE(hasReason(*result, CalibrationReason::Kind::FewBoards));
}

TEST(CalibrateCamera, EveryReasonHasItsMeasure) {
    const CameraModel truth = randomCamera(2, DistortionModel::PlumbBob);
    const std::vector<BoardView> views = randomViews(truth, 2, 14, 0.2);
    const auto good = calibrateCamera(views, kPlan);
    ASSERT_TRUE(good);
    using Kind = CalibrationReason::Kind;
    const auto spoilt = [&](Kind kind, auto change) {
        CameraCalibration result = *good;
        change(result);
        judgeCalibration(views, result);
        EXPECT_TRUE(hasReason(result, kind)) << static_cast<int>(kind);
        EXPECT_NE(result.trust, CalibrationTrust::Good);
        EXPECT_TRUE(std::is_sorted(result.reasons.begin(), result.reasons.end(),
                                   [](const auto& a, const auto& b) { return a.trust > b.trust; }));
    };
    spoilt(Kind::LargeResiduals, [](CameraCalibration& c) { c.rms_px = 0.7; });
    spoilt(Kind::FocalUncertain, [](CameraCalibration& c) { c.sigma->fy = 30; });
    spoilt(Kind::CentreUncertain, [](CameraCalibration& c) { c.sigma->cx = 30; });
    spoilt(Kind::NotDetermined, [](CameraCalibration& c) { c.sigma.reset(); });
    spoilt(Kind::ManyRejected, [](CameraCalibration& c) { c.rejected = {0, 1, 2, 3}; });
    spoilt(Kind::FoldsBack, [](CameraCalibration& c) { c.camera.distortion = {-2, 0, 0, 0, 0}; });
    std::vector<BoardView> heaped = views;
    for (BoardView& view : heaped) {
        for (BoardCorner& corner : view.corners)
            corner.pixel = {100, 100};
    }
    CameraCalibration result = *good;
    judgeCalibration(heaped, result);
    EXPECT_TRUE(hasReason(result, Kind::PoorCoverage));
    EXPECT_EQ(result.trust, CalibrationTrust::NotToBeTrusted);
}

TEST(CalibrateCamera, WhatCannotBeCalibratedIsRefused) {
    const CameraModel truth = randomCamera(1, DistortionModel::PlumbBob);
    const std::vector<BoardView> good = randomViews(truth, 1, 6, 0.2);
    const auto fails = [&](ErrorCode code, auto change) {
        std::vector<BoardView> views = good;
        change(views);
        const auto result = calibrateCamera(views, kPlan);
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, code) << result.error().message();
    };
    fails(ErrorCode::TooFewPoses, [](auto& v) { v.resize(2); });
    fails(ErrorCode::TooFewPoses, [](auto& v) { v.clear(); });
    fails(ErrorCode::TooFewPoints, [](auto& v) { v[1].corners.resize(5); });
    fails(ErrorCode::SizeMismatch, [](auto& v) { v[1].size = {640, 480}; });
    fails(ErrorCode::NotFinite, [](auto& v) { v[1].corners[0].pixel.x() = std::nan(""); });
    EXPECT_THROW((void)calibrateCamera(good, BoardPlan{BoardKind::Chessboard, 0, 0, 0, 0, {}}), std::logic_error);
    CameraCalibrationOptions options;
    options.minBoards = 1;
    EXPECT_THROW((void)calibrateCamera(good, kPlan, options), std::logic_error);
}

TEST(CalibrateCamera, StopsWhenAskedTo) {
    const std::vector<BoardView> views = randomViews(randomCamera(1, DistortionModel::PlumbBob), 1, 8, 0.2);
    for (int allowed = 0; allowed < 4; ++allowed) {
        int asked = 0;
        RunContext context;
        context.isCancelled = [&] { return ++asked > allowed; };
        const auto result = calibrateCamera(views, kPlan, {}, context);
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, ErrorCode::Cancelled);
    }
}

}  // namespace
}  // namespace skincal
