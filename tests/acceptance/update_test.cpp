// A solution that is brought up to date while an operator adds views and poses.

#include <gtest/gtest.h>

#include "core/estimation/joint_method.h"
#include "core/study/study_world.h"

namespace skincal {
namespace {

/// Largest difference of two solutions of one body, in the standard deviations of the second.
double differenceInSigmas(const BodySolution& a, const BodySolution& b) {
    double worst = 0;
    for (std::size_t u = 0; u < b.solved.T_r_u.size(); ++u) {
        EXPECT_EQ(a.solved.T_r_u[u].has_value(), b.solved.T_r_u[u].has_value()) << u;
        if (!a.solved.T_r_u[u] || !b.solved.T_r_u[u])
            continue;
        Vector6d change;
        change << so3Log(a.solved.T_r_u[u]->linear() * b.solved.T_r_u[u]->linear().transpose()),
            a.solved.T_r_u[u]->translation() - b.solved.T_r_u[u]->translation();
        const Vector6d sigma = b.estimate.covariances[u].value().diagonal().cwiseSqrt();
        worst = std::max(worst, change.cwiseQuotient(sigma).cwiseAbs().maxCoeff());
    }
    return worst;
}

class UpdateTest : public testing::Test {
  protected:
    void SetUp() override {
        Scenario scenario = *findScenario("freeform");
        scenario.views.outliers = 0.05;
        all_ = measurementsOf(buildWorld(scenario, 3));
    }
    [[nodiscard]] Measurements without(std::size_t views, int firstPoseLeftOut) const {
        Measurements part = all_;
        part.views.resize(all_.views.size() - views);
        std::erase_if(part.gravity, [&](const GravityReading& r) { return r.pose >= firstPoseLeftOut; });
        return part;
    }
    Measurements all_;
};

TEST_F(UpdateTest, ViewsAndPosesGiveWhatSolvingAnewGives) {
    const GravityTable gravity(all_.skin, all_.gravity);
    const BodySolution anew = solveJointly(all_, gravity).value();

    const Measurements less = without(3, 9);
    const GravityTable lessGravity(less.skin, less.gravity);
    const BodySolution first = solveJointly(less, lessGravity).value();
    const Measurements withViews = without(0, 9);
    const GravityTable withViewsGravity(withViews.skin, withViews.gravity);
    const BodySolution second = updateJointly(first, withViews, withViewsGravity).value();
    EXPECT_TRUE(second.solved.T_r_v.back());
    const BodySolution third = updateJointly(second, all_, gravity).value();
    EXPECT_LT(differenceInSigmas(third, anew), 0.3);
    EXPECT_EQ(third.estimate.rejected, anew.estimate.rejected);
    // Once more without anything new stands still.
    EXPECT_LT(differenceInSigmas(updateJointly(third, all_, gravity).value(), third), 0.1);
}

TEST_F(UpdateTest, APatchThatComesIntoSightIsPlaced) {
    Measurements hidden = all_;
    const GravityTable gravity(all_.skin, all_.gravity);
    const BodySolution anew = solveJointly(all_, gravity).value();
    const std::size_t lost = anew.layout.patchOf.back();
    const auto index = all_.skin.indexById();
    for (ViewDetections& view : hidden.views)
        std::erase_if(view.found,
                      [&](const LedDetection& d) { return anew.layout.patchOf[index.at(d.module)] == lost; });
    const BodySolution first = solveJointly(hidden, gravity).value();
    ASSERT_FALSE(first.solved.T_r_u.back());
    const BodySolution second = updateJointly(first, all_, gravity).value();
    EXPECT_LT(differenceInSigmas(second, anew), 0.3);
}

TEST_F(UpdateTest, AnotherSkinIsSolvedAnewAndCancellingStops) {
    const GravityTable gravity(all_.skin, all_.gravity);
    const BodySolution first = solveJointly(all_, gravity).value();
    Measurements other = all_;
    other.skin.links.pop_back();
    const GravityTable otherGravity(other.skin, other.gravity);
    const BodySolution second = updateJointly(first, other, otherGravity).value();
    EXPECT_EQ(second.layout.verdicts.size(), other.skin.links.size());
    RunContext context;
    context.isCancelled = [] { return true; };
    const auto cancelled = updateJointly(first, all_, gravity, {}, context);
    ASSERT_FALSE(cancelled);
    EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
}

}  // namespace
}  // namespace skincal
