#include "core/vision/camera_model.h"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>

#include "core/geometry/random.h"

namespace skincal {
namespace {

CameraModel cameraWith(DistortionModel model, std::vector<double> coefficients) {
    CameraModel camera{1280, 720, 1100, 1105, 640.5, 355.25, model, std::move(coefficients)};
    return camera;
}

std::vector<CameraModel> cameras() {
    return {cameraWith(DistortionModel::PlumbBob, {}),
            cameraWith(DistortionModel::PlumbBob, {-0.12, 0.06, 7e-4, -4e-4, 0.01}),
            cameraWith(DistortionModel::RationalPolynomial, {0.2, -0.1, 1e-3, -5e-4, 0.02, 0.3, -0.05, 0.01}),
            cameraWith(DistortionModel::Equidistant, {0.02, -0.01, 0.004, -0.001})};
}

TEST(CameraModel, ProjectsAsOpenCvDoes) {
    Random random(1, "camera projects");
    for (const CameraModel& camera : cameras()) {
        for (int i = 0; i < 100; ++i) {
            const Vector3d p(random.uniform(-0.4, 0.4), random.uniform(-0.25, 0.25), random.uniform(0.5, 2));
            const auto mine = camera.project(p);
            ASSERT_TRUE(mine);
            std::vector<cv::Point2d> theirs;
            const std::vector<cv::Point3d> points{{p.x(), p.y(), p.z()}};
            if (camera.distortionModel == DistortionModel::Equidistant)
                cv::fisheye::projectPoints(points, theirs, cv::Vec3d(), cv::Vec3d(), camera.matrix(),
                                           camera.distortion);
            else
                cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), camera.matrix(), camera.distortion, theirs);
            EXPECT_NEAR(mine->x(), theirs[0].x, 1e-6) << name(camera.distortionModel);
            EXPECT_NEAR(mine->y(), theirs[0].y, 1e-6) << name(camera.distortionModel);
        }
    }
}

TEST(CameraModel, UnprojectInvertsProject) {
    Random random(2, "camera inverts");
    for (const CameraModel& camera : cameras()) {
        for (int i = 0; i < 200; ++i) {
            const Vector2d pixel(random.uniform(0, 1279), random.uniform(0, 719));
            const Vector2d n = camera.unproject(pixel);
            const auto back = camera.project({n.x(), n.y(), 1});
            ASSERT_TRUE(back);
            EXPECT_LT((*back - pixel).norm(), 1e-6) << name(camera.distortionModel);
        }
    }
}

TEST(CameraModel, NothingBehindTheCameraHasAPixel) {
    const CameraModel camera = cameras()[1];
    EXPECT_FALSE(camera.project({0.1, 0.1, -1}));
    EXPECT_FALSE(camera.project({0, 0, 0}));
    EXPECT_FALSE(camera.project({0, 0, std::numeric_limits<double>::quiet_NaN()}));
}

TEST(CameraModel, ThePictureEndsHalfAPixelBeyondItsLastCentre) {
    const CameraModel camera = cameras()[0];
    EXPECT_TRUE(camera.contains({-0.5, -0.5}));
    EXPECT_TRUE(camera.contains({1279.4, 719.4}));
    EXPECT_FALSE(camera.contains({1279.5, 0}));
    EXPECT_FALSE(camera.contains({0, -0.6}));
}

TEST(CameraModel, DistortionNamesAreThoseOfRos) {
    for (const auto model :
         {DistortionModel::PlumbBob, DistortionModel::RationalPolynomial, DistortionModel::Equidistant})
        EXPECT_EQ(distortionModelFromName(name(model)), model);
    EXPECT_FALSE(distortionModelFromName("fisheye"));
    EXPECT_EQ(coefficientCount(DistortionModel::RationalPolynomial), 8U);
}

}  // namespace
}  // namespace skincal
