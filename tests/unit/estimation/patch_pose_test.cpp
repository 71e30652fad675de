#include "core/estimation/patch_pose.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/unit/estimation/synthetic.h"

namespace skincal {
namespace {

struct Picture {
    std::vector<LedCorrespondence> leds;
    CameraModel camera = syntheticCamera(true);
    Isometry3d T_v_o;
};

/// A patch seen from a random place that all of it faces.
Picture takePicture(Random& random, std::size_t count, double radius, double noise = 0, double outliers = 0) {
    Picture picture;
    picture.leds = patchLeds(count, radius);
    Vector3d centre = Vector3d::Zero();
    Vector3d normal = Vector3d::Zero();
    for (const LedCorrespondence& led : picture.leds) {
        centre += led.led_o / static_cast<double>(count);
        normal += led.normal_o;
    }
    const Vector3d axis = random.direction().cross(normal).normalized();
    const Vector3d from = so3Exp(axis * random.uniform(10, 40) * kDegree) * normal.normalized();
    const Isometry3d T_o_v = lookAt(centre + from * random.uniform(0.25, 0.5), centre, random.uniform(-3, 3));
    picture.T_v_o = T_o_v.inverse();
    const auto wrong = static_cast<std::size_t>(outliers * static_cast<double>(count));
    for (std::size_t i = 0; i < count; ++i) {
        LedCorrespondence& led = picture.leds[i];
        const Vector2d error(random.normal(), random.normal());
        led.pixel = picture.camera.project(picture.T_v_o * led.led_o).value() + noise * error;
        // Spread over the patch, so that no row of it is lost altogether.
        if (i * wrong / count != (i + 1) * wrong / count)
            led.pixel += random.uniform(40, 200) * error.normalized();
        led.sigma_px = std::max(noise, 0.02);
    }
    return picture;
}

double nearest(const std::vector<PatchPose>& poses, const Isometry3d& truth) {
    double best = 10;
    for (const PatchPose& pose : poses)
        best = std::min(best, poseDifference(pose.T_v_o, truth).angle);
    return best;
}

// A mirror shows bent patches and flat ones inside out: no pose explains that, but from behind.
TEST(PatchPoses, OfTwoPixelsOfAnLedTheReflectionIsNotTaken) {
    Random random(3, "reflections");
    for (int i = 0; i < 40; ++i) {
        const Picture picture = takePicture(random, 8 + random.index(22), i % 3 == 0 ? 1e3 : 0.12, 0.1);
        const Vector3d centre_v = picture.T_v_o * picture.leds.front().led_o;
        const double angle = random.uniform(-3, 3);
        const Vector3d out(std::cos(angle), std::sin(angle), random.uniform(-0.2, 0.2));
        const Vector3d aside = out.normalized();
        const double away = aside.dot(centre_v) + random.uniform(0.08, 0.12);
        std::vector<LedCorrespondence> leds;
        std::vector<bool> isReal;
        for (const LedCorrespondence& led : picture.leds) {
            const Vector3d led_v = picture.T_v_o * led.led_o;
            LedCorrespondence image = led;
            image.pixel = picture.camera.project(led_v + 2 * (away - aside.dot(led_v)) * aside).value_or(led.pixel);
            const bool isFirst = random.uniform() < 0.5;
            leds.push_back(isFirst ? led : image);
            leds.push_back(isFirst ? image : led);
            leds.back().isAlternative = true;
            isReal.push_back(isFirst);
            isReal.push_back(!isFirst);
        }
        const auto poses = estimatePatchPoses(leds, picture.camera);
        ASSERT_TRUE(poses) << i << ": " << poses.error().message();
        EXPECT_LT(nearest(*poses, picture.T_v_o), 2 * kDegree) << i;
        for (const PatchPose& pose : *poses) {
            for (std::size_t k = 0; k < leds.size(); ++k)
                EXPECT_TRUE(isReal[k] || !pose.inliers[k] || (leds[k].pixel - leds[k ^ 1U].pixel).norm() < 12) << i;
        }
    }
}

TEST(PatchPoses, ExactPixelsOfABentPatchGiveTheExactPose) {
    Random random(1, "bent");
    for (int i = 0; i < 60; ++i) {
        const Picture picture = takePicture(random, 6 + random.index(25), random.uniform(0.06, 0.15));
        const auto poses = estimatePatchPoses(picture.leds, picture.camera);
        ASSERT_TRUE(poses) << poses.error().message();
        EXPECT_LT(poseDifference(poses->front().T_v_o, picture.T_v_o).angle, 1e-4);
        EXPECT_LT(poseDifference(poses->front().T_v_o, picture.T_v_o).distance, 1e-5);
        EXPECT_EQ(poses->front().inlierCount(), picture.leds.size());
        EXPECT_LT(poses->front().rms_px, 0.01);
    }
}

TEST(PatchPoses, ExactPixelsOfAFlatPatchGiveTheExactPoseAmongTheCandidates) {
    Random random(2, "flat");
    for (int i = 0; i < 60; ++i) {
        const Picture picture = takePicture(random, 4 + random.index(27), 0);
        const auto poses = estimatePatchPoses(picture.leds, picture.camera);
        ASSERT_TRUE(poses) << poses.error().message();
        EXPECT_LE(poses->size(), 2U);
        EXPECT_LT(nearest(*poses, picture.T_v_o), 1e-3) << picture.leds.size();
    }
}

TEST(PatchPoses, NoisyFlatPatchesKeepTheTruthAmongTwo) {
    Random random(3, "noisy flat");
    // Far beyond what the noise turns a pose by, far below a flip.
    constexpr double kFlip = 15 * kDegree;
    int two = 0;
    int bestIsTrue = 0;
    constexpr int kRounds = 100;
    for (int i = 0; i < kRounds; ++i) {
        const Picture picture = takePicture(random, 7, 0, 1.0);
        const auto poses = estimatePatchPoses(picture.leds, picture.camera);
        ASSERT_TRUE(poses);
        EXPECT_LT(nearest(*poses, picture.T_v_o), kFlip) << i;
        two += poses->size() == 2 ? 1 : 0;
        bestIsTrue += poseDifference(poses->front().T_v_o, picture.T_v_o).angle < kFlip ? 1 : 0;
        for (std::size_t k = 1; k < poses->size(); ++k)
            EXPECT_LE((*poses)[k - 1].cost, (*poses)[k].cost);
    }
    // The second pose earns its keep: it exists often, and the best alone would be wrong at times.
    EXPECT_GT(two, kRounds / 3);
    EXPECT_LT(bestIsTrue, kRounds);
}

TEST(PatchPoses, ToleratesAFifthToAThirdOfOutliersAndNamesThem) {
    Random random(4, "outliers");
    for (const double radius : {0.0, 0.08}) {
        for (int i = 0; i < 30; ++i) {
            const std::size_t count = 10 + random.index(20);
            const Picture picture = takePicture(random, count, radius, 0.05, random.uniform(0.2, 0.3));
            const auto poses = estimatePatchPoses(picture.leds, picture.camera);
            ASSERT_TRUE(poses) << poses.error().message();
            EXPECT_LT(nearest(*poses, picture.T_v_o), 3 * kDegree);
            for (const PatchPose& pose : *poses) {
                if (poseDifference(pose.T_v_o, picture.T_v_o).angle > 3 * kDegree)
                    continue;
                for (std::size_t k = 0; k < count; ++k) {
                    const Vector2d truth = picture.camera.project(picture.T_v_o * picture.leds[k].led_o).value();
                    EXPECT_EQ(pose.inliers[k], (picture.leds[k].pixel - truth).norm() < 20) << k << " of " << count;
                }
            }
        }
    }
}

TEST(PatchPoses, FiveLedsAreEnough) {
    Random random(5, "five");
    for (int i = 0; i < 40; ++i) {
        const Picture picture = takePicture(random, 5, 0.07, 0.05);
        const auto poses = estimatePatchPoses(picture.leds, picture.camera);
        ASSERT_TRUE(poses);
        EXPECT_LT(nearest(*poses, picture.T_v_o), 5 * kDegree);
    }
}

TEST(PatchPoses, IsDeterministic) {
    Random random(6, "twice");
    const Picture picture = takePicture(random, 20, 0, 0.2, 0.2);
    const auto a = estimatePatchPoses(picture.leds, picture.camera).value();
    const auto b = estimatePatchPoses(picture.leds, picture.camera).value();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
        EXPECT_EQ(a[k].T_v_o.matrix(), b[k].T_v_o.matrix());
        EXPECT_EQ(a[k].inliers, b[k].inliers);
    }
}

TEST(PatchPoses, CovarianceForecastsTheScatter) {
    Random random(7, "covariance");
    Picture picture = takePicture(random, 16, 0.07);
    std::vector<Vector2d> exact;
    for (const LedCorrespondence& led : picture.leds)
        exact.push_back(led.pixel);
    PatchPoseOptions options;
    options.shapeSigma = 1e-5;
    options.maxResidual_px = 4;
    Vector6d squares = Vector6d::Zero();
    Vector6d forecast = Vector6d::Zero();
    constexpr int kRounds = 200;
    for (int i = 0; i < kRounds; ++i) {
        for (std::size_t k = 0; k < exact.size(); ++k) {
            picture.leds[k].sigma_px = 0.3;
            picture.leds[k].pixel = exact[k] + 0.3 * Vector2d(random.normal(), random.normal());
        }
        const PatchPose pose = estimatePatchPoses(picture.leds, picture.camera, options).value().front();
        Vector6d error;
        const Matrix3d dR = pose.T_v_o.linear() * picture.T_v_o.linear().transpose();
        error.head<3>() = so3Log(dR);
        error.tail<3>() = pose.T_v_o.translation() - dR * picture.T_v_o.translation();
        squares += error.cwiseAbs2() / kRounds;
        forecast += pose.covariance.diagonal() / kRounds;
    }
    for (int k = 0; k < 6; ++k)
        EXPECT_NEAR(squares[k] / forecast[k], 1, 0.35) << k;
}

TEST(PatchPoses, RefusesTooFewLedsLinesAndChaos) {
    Random random(8, "refuse");
    const Picture picture = takePicture(random, 3, 0);
    const auto few = estimatePatchPoses(picture.leds, picture.camera);
    ASSERT_FALSE(few);
    EXPECT_EQ(few.error().code, ErrorCode::TooFewPoints);
    EXPECT_EQ(few.error().numbers.at("found"), 3);
    EXPECT_EQ(few.error().numbers.at("needed"), 4);

    Picture line = takePicture(random, 8, 0);
    for (std::size_t i = 0; i < line.leds.size(); ++i) {
        line.leds[i].led_o = Vector3d(0.024, 0.014, 0) * static_cast<double>(i);
        line.leds[i].pixel = line.camera.project(line.T_v_o * line.leds[i].led_o).value();
    }
    EXPECT_EQ(estimatePatchPoses(line.leds, line.camera).error().code, ErrorCode::DegeneratePoints);
    for (LedCorrespondence& led : line.leds)
        led.led_o = Vector3d(0.01, 0, 0);
    EXPECT_EQ(estimatePatchPoses(line.leds, line.camera).error().code, ErrorCode::DegeneratePoints);

    int refused = 0;
    for (int i = 0; i < 20; ++i) {
        Picture chaos = takePicture(random, 12, 0.08);
        for (LedCorrespondence& led : chaos.leds)
            led.pixel = {random.uniform(0, 1280), random.uniform(0, 720)};
        const auto found = estimatePatchPoses(chaos.leds, chaos.camera);
        refused += !found && found.error().code == ErrorCode::NoConsensus ? 1 : 0;
    }
    EXPECT_EQ(refused, 20);
}

TEST(PatchPoses, NeverFromBehind) {
    Random random(9, "behind");
    for (int i = 0; i < 20; ++i) {
        Picture picture = takePicture(random, 9, 0.08);
        for (LedCorrespondence& led : picture.leds)
            led.normal_o = -led.normal_o;
        const auto poses = estimatePatchPoses(picture.leds, picture.camera);
        if (poses) {
            EXPECT_GT(nearest(*poses, picture.T_v_o), 8 * kDegree);
        } else {
            EXPECT_EQ(poses.error().code, ErrorCode::NoConsensus);
        }
    }
}

TEST(PatchPoses, OptionsOutOfRangeThrow) {
    EXPECT_TRUE(PatchPoseOptions{}.validate());
    std::vector<PatchPoseOptions> bad(10);
    bad[0].minInliers = 3;
    bad[1].minInlierShare = 1.1;
    bad[2].minInlierShare = -0.1;
    bad[3].shapeSigma = 0;
    bad[4].maxResidualSigmas = 0;
    bad[5].maxResidual_px = 0;
    bad[6].maxSamples = 0;
    bad[7].distinctAngle_rad = 0;
    bad[8].maxCostRatio = 0.9;
    bad[9].maxCandidates = 0;
    for (const PatchPoseOptions& options : bad)
        EXPECT_THROW((void)estimatePatchPoses({}, syntheticCamera(false), options), std::logic_error);
}

TEST(PaperPatchPose, ExactPixelsOfABentPatchGiveTheExactPose) {
    Random random(10, "paper");
    for (int i = 0; i < 40; ++i) {
        const Picture picture = takePicture(random, 12 + random.index(10), random.uniform(0.06, 0.1));
        const auto pose = estimatePatchPosePaper(picture.leds, picture.camera);
        ASSERT_TRUE(pose) << pose.error().message();
        EXPECT_LT(poseDifference(pose->T_v_o, picture.T_v_o).angle, 1e-3);
        EXPECT_LT(poseDifference(pose->T_v_o, picture.T_v_o).distance, 1e-4);
        EXPECT_EQ(pose->inlierCount(), picture.leds.size());
        EXPECT_NEAR(pose->cost, pose->rms_px * pose->rms_px, 1e-12);
    }
}

TEST(PaperPatchPose, ItsConstantsAreThePapers) {
    const PaperPoseOptions options;
    EXPECT_EQ(options.iterations, 100);
    EXPECT_EQ(options.reprojectionError_px, 8.0);
    EXPECT_EQ(options.minLeds, 6);
    EXPECT_EQ(options.minInliers, 6);
}

TEST(PaperPatchPose, NeedsSixLedsThatAgree) {
    Random random(11, "paper six");
    const Picture five = takePicture(random, 5, 0.07);
    const auto few = estimatePatchPosePaper(five.leds, five.camera);
    ASSERT_FALSE(few);
    EXPECT_EQ(few.error().code, ErrorCode::TooFewPoints);
    EXPECT_EQ(few.error().numbers.at("needed"), 6);
    for (int i = 0; i < 10; ++i) {
        Picture chaos = takePicture(random, 10, 0.07);
        for (LedCorrespondence& led : chaos.leds)
            led.pixel = {random.uniform(0, 1280), random.uniform(0, 720)};
        const auto found = estimatePatchPosePaper(chaos.leds, chaos.camera);
        ASSERT_FALSE(found);
        EXPECT_EQ(found.error().code, ErrorCode::NoConsensus);
    }
    // LEDs all at one place: whatever the library makes of it, no pose comes out.
    Picture point = takePicture(random, 8, 0);
    for (LedCorrespondence& led : point.leds) {
        led.led_o = point.leds[0].led_o;
        led.pixel = point.leds[0].pixel;
    }
    EXPECT_FALSE(estimatePatchPosePaper(point.leds, point.camera));
    for (const PaperPoseOptions& options :
         {PaperPoseOptions{0, 8, 6, 6}, PaperPoseOptions{100, 0, 6, 6}, PaperPoseOptions{100, 8, 3, 6},
          PaperPoseOptions{100, 8, 6, 3}, PaperPoseOptions{100, 8, 6, 6, 1.0}})
        EXPECT_THROW((void)estimatePatchPosePaper(five.leds, five.camera, options), std::logic_error);
}

TEST(PaperPatchPose, LeavesOutliersOut) {
    Random random(12, "paper outliers");
    for (int i = 0; i < 20; ++i) {
        const Picture picture = takePicture(random, 20, 0.08, 0.05, 0.2);
        const auto pose = estimatePatchPosePaper(picture.leds, picture.camera);
        ASSERT_TRUE(pose);
        EXPECT_LT(poseDifference(pose->T_v_o, picture.T_v_o).angle, 10 * kDegree);
        EXPECT_EQ(pose->inlierCount(), 16U);
    }
}

}  // namespace
}  // namespace skincal
