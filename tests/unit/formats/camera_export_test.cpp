#include "core/formats/camera_export.h"

#include <gtest/gtest.h>

#include "core/formats/camera_file.h"
#include "core/geometry/random.h"

namespace skincal {
namespace {

CameraModel randomCamera(Random& random, DistortionModel model) {
    CameraModel camera;
    camera.width = 640 + static_cast<int>(random.index(1300));
    camera.height = 480 + static_cast<int>(random.index(700));
    camera.fx = random.uniform(0.5, 2) * camera.width;
    camera.fy = random.uniform(0.5, 2) * camera.width;
    camera.cx = random.uniform(0.4, 0.6) * camera.width;
    camera.cy = random.uniform(0.4, 0.6) * camera.height;
    camera.distortionModel = model;
    for (std::size_t i = 0; i < coefficientCount(model); ++i)
        camera.distortion.push_back(0.1 * random.normal());
    return camera;
}

void expectSame(const CameraModel& a, const CameraModel& b) {
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.fx, b.fx);
    EXPECT_EQ(a.fy, b.fy);
    EXPECT_EQ(a.cx, b.cx);
    EXPECT_EQ(a.cy, b.cy);
    EXPECT_EQ(a.distortionModel, b.distortionModel);
    EXPECT_EQ(a.distortion, b.distortion);
}

TEST(CameraExport, WhatIsWrittenReadsBackToTheSameBits) {
    Random random(1, "camera export");
    for (int i = 0; i < 100; ++i) {
        for (const auto model :
             {DistortionModel::PlumbBob, DistortionModel::RationalPolynomial, DistortionModel::Equidistant}) {
            CameraModel camera = randomCamera(random, model);
            for (const auto kind : {CameraFileKind::Ros, CameraFileKind::OpenCv, CameraFileKind::Kalibr}) {
                if (kind == CameraFileKind::Kalibr && model == DistortionModel::PlumbBob)
                    camera.distortion[4] = 0;
                const auto text = exportCamera(camera, kind);
                if (kind == CameraFileKind::Kalibr && model == DistortionModel::RationalPolynomial) {
                    EXPECT_FALSE(text);
                    continue;
                }
                ASSERT_TRUE(text);
                const auto back = parseCameraModel(*text, "camera.yaml");
                ASSERT_TRUE(back) << back.error().message() << *text;
                expectSame(*back, camera);
            }
        }
    }
}

TEST(CameraExport, ALensWithoutDistortionHasNoneAfterwards) {
    Random random(2, "camera export");
    CameraModel camera = randomCamera(random, DistortionModel::PlumbBob);
    camera.distortion.clear();
    for (const auto kind : {CameraFileKind::Ros, CameraFileKind::OpenCv, CameraFileKind::Kalibr}) {
        const auto back = parseCameraModel(*exportCamera(camera, kind), "camera.yaml");
        ASSERT_TRUE(back) << back.error().message();
        EXPECT_EQ(back->unproject({17, 23}), camera.unproject({17, 23}));
    }
}

TEST(CameraExport, KalibrHasNoRoomForAThirdRadialTerm) {
    Random random(3, "camera export");
    const CameraModel camera = randomCamera(random, DistortionModel::PlumbBob);
    EXPECT_FALSE(exportCamera(camera, CameraFileKind::Kalibr));
}

}  // namespace
}  // namespace skincal
