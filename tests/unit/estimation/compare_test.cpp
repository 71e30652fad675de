#include "core/estimation/compare.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"

namespace skincal {
namespace {

std::vector<NamedPose> randomBody(Random& random, std::size_t size, double spread = 0.1) {
    std::vector<NamedPose> body;
    for (std::size_t i = 0; i < size; ++i)
        body.push_back({ModuleId(static_cast<std::uint32_t>(10 * i + 1)),
                        makeIsometry(random.rotation(), random.normal3() * spread)});
    return body;
}

std::vector<NamedPose> moved(std::vector<NamedPose> body, const Isometry3d& T) {
    for (NamedPose& pose : body)
        pose.T_body_module = T * pose.T_body_module;
    return body;
}

TEST(CompareBodies, ARigidMotionIsNoDifference) {
    Random random(1, "rigid");
    for (int i = 0; i < 200; ++i) {
        // One and two modules need their rotations, from three on the positions do.
        const auto body = randomBody(random, 1 + random.index(20));
        const Isometry3d T = makeIsometry(random.rotation(), random.normal3());
        auto truth = moved(body, T);
        std::reverse(truth.begin(), truth.end());
        const auto found = compareBodies(body, truth);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->compared, body.size());
        EXPECT_LT(found->positionMax, 1e-9);
        EXPECT_LT(found->rotationMax, 1e-6);
        EXPECT_LT(poseDifference(found->T_truth_body, T).angle, 1e-6);
        EXPECT_LT(poseDifference(found->T_truth_body, T).distance, 1e-6);
    }
}

TEST(CompareBodies, ModulesOnALineUseTheirRotations) {
    Random random(2, "line");
    for (int i = 0; i < 50; ++i) {
        auto body = randomBody(random, 6);
        const Vector3d direction = random.direction();
        for (std::size_t k = 0; k < body.size(); ++k)
            body[k].T_body_module.translation() = direction * (0.03 * static_cast<double>(k));
        const Isometry3d T = makeIsometry(random.rotation(), random.normal3());
        const auto found = compareBodies(body, moved(body, T)).value();
        EXPECT_LT(poseDifference(found.T_truth_body, T).angle, 1e-6);
        EXPECT_LT(found.rotationMax, 1e-6);
    }
}

TEST(CompareBodies, ScaleIsAnError) {
    Random random(3, "scale");
    const auto body = randomBody(random, 30);
    auto truth = body;
    for (NamedPose& pose : truth)
        pose.T_body_module.translation() *= 1.1;
    const auto found = compareBodies(body, truth).value();
    Vector3d centre = Vector3d::Zero();
    for (const NamedPose& pose : body)
        centre += pose.T_body_module.translation() / 30;
    double squares = 0;
    for (const NamedPose& pose : body)
        squares += (pose.T_body_module.translation() - centre).squaredNorm() / 30;
    EXPECT_NEAR(found.positionRms, 0.1 * std::sqrt(squares), 1e-9);
    EXPECT_LT(found.rotationMax, 1e-6);
}

TEST(CompareBodies, NamesTheWorstModuleAndCountsTheCommonOnes) {
    Random random(4, "worst");
    auto truth = randomBody(random, 40);
    auto body = truth;
    body[17].T_body_module.translation() += Vector3d(0.02, 0, 0);
    body[5].T_body_module.linear() = body[5].T_body_module.linear() * so3Exp({0.4, 0, 0});
    body.push_back({ModuleId(7777), Isometry3d::Identity()});
    truth.push_back({ModuleId(8888), Isometry3d::Identity()});
    const auto found = compareBodies(body, truth).value();
    EXPECT_EQ(found.compared, 40U);
    EXPECT_EQ(found.worst, body[17].id);
    EXPECT_NEAR(found.positionMax, 0.02, 0.002);
    EXPECT_NEAR(found.rotationMax, 0.4, 0.01);
    EXPECT_LT(found.positionRms, found.positionMax);
    EXPECT_LT(found.rotationRms, found.rotationMax);
}

TEST(CompareBodies, NothingInCommonIsRefused) {
    Random random(5, "nothing");
    const auto body = randomBody(random, 3);
    EXPECT_EQ(compareBodies(body, {}).error().code, ErrorCode::TooFewPoints);
    EXPECT_EQ(compareBodies({}, body).error().code, ErrorCode::TooFewPoints);
    EXPECT_EQ(compareBodies(body, {{ModuleId(5), Isometry3d::Identity()}}).error().code, ErrorCode::TooFewPoints);
}

}  // namespace
}  // namespace skincal
