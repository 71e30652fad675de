#include "core/estimation/view_hypotheses.h"

#include <gtest/gtest.h>

#include "tests/unit/estimation/solved_world.h"

namespace skincal::testing {
namespace {

/// A flat patch of seven, alone in two pictures.
World twoViews(double distance, std::uint64_t seed) {
    World world = bareWorld({flatPatch(7)}, seed, 0.05);
    const Isometry3d T_r_v = cameraBefore(world, distance, 20 * kDegree);
    const Isometry3d T_v_o = T_r_v.inverse() * world.T_r_u.front();
    const Isometry3d after = makeIsometry(so3Exp(Vector3d(0.175, 0, 0)) * T_v_o.linear(), T_v_o.translation());
    world.T_r_v = {T_r_v, world.T_r_u.front() * after.inverse()};
    return world;
}

/// How far the patch is turned from how it really lies before the camera, rad; the larger of both views.
double worstTurn(const World& world, const BodySolution& solution) {
    double worst = 0;
    for (const std::size_t v : {0U, 1U}) {
        const Matrix3d found = (solution.solved.T_r_v[v]->inverse() * *solution.solved.T_r_u[0]).linear();
        worst =
            std::max(worst, rotationAngle(found.transpose() * (world.T_r_v[v].inverse() * world.T_r_u[0]).linear()));
    }
    return worst;
}

/// Puts a view where the patch, were it seen without perspective, would look the same: turned about an axis across the
/// line of sight, by twice its tilt the other way.
void turnOver(BodySolution& solution, std::size_t view) {
    const Isometry3d T_v_o = solution.solved.T_r_v[view]->inverse() * *solution.solved.T_r_u[0];
    const Vector3d d = T_v_o.translation().normalized();
    const Vector3d n = T_v_o.linear().col(2);
    const Vector3d mirrored = 2 * n.dot(d) * d - n;
    const Vector3d to = mirrored.dot(n) < 0 ? Vector3d(-mirrored) : mirrored;
    const Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(n, to).toRotationMatrix();
    const Isometry3d T_new = makeIsometry(turn * T_v_o.linear(), T_v_o.translation());
    solution.solved.T_r_v[view] = *solution.solved.T_r_u[0] * T_new.inverse();
    solution.alternatives.push_back({view, *solution.solved.T_r_v[view], 0});
}

TEST(ViewHypotheses, BringsViewsBackThatStandOnTheWrongSide) {
    int settled = 0;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        const SolvedWorld solved(twoViews(0.4, seed));
        for (const std::vector<std::size_t>& wrong : {std::vector<std::size_t>{0}, {1}, {0, 1}}) {
            BodySolution solution = solved.solution;
            solution.alternatives.clear();
            for (const std::size_t v : wrong)
                turnOver(solution, v);
            ASSERT_GT(worstTurn(solved.world, solution), 0.3);
            const auto changed = settleViewsByLikelihood(solution);
            ASSERT_TRUE(changed);
            EXPECT_TRUE(*changed);
            EXPECT_LT(worstTurn(solved.world, solution), 0.1) << "seed " << seed;
            settled += solution.estimate.undecidedViews.empty() ? 1 : 0;
        }
    }
    EXPECT_GE(settled, 20) << "of 24: at this distance perspective tells";
}

TEST(ViewHypotheses, LeavesOpenWhatPicturesFromFarAwayCantTell) {
    int open = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const SolvedWorld solved(twoViews(1.4, seed));
        const bool isOpen = !solved.solution.estimate.undecidedViews.empty();
        open += isOpen ? 1 : 0;
        if (!isOpen) {
            EXPECT_LT(worstTurn(solved.world, solved.solution), 0.3) << "seed " << seed;
        }
    }
    EXPECT_GE(open, 6);
}

TEST(ViewHypotheses, WhereNothingIsOpenNothingChanges) {
    SolvedWorld solved(scenarioWorld("outliers", 2));
    solved.solution.alternatives.clear();
    const auto before = solved.solution.solved.T_r_v;
    const auto changed = settleViewsByLikelihood(solved.solution);
    ASSERT_TRUE(changed);
    EXPECT_FALSE(*changed);
    for (std::size_t v = 0; v < before.size(); ++v) {
        if (before[v]) {
            EXPECT_EQ(before[v]->matrix(), solved.solution.solved.T_r_v[v]->matrix());
        }
    }
}

TEST(ViewHypotheses, IsCancelled) {
    SolvedWorld solved(twoViews(0.6, 3));
    turnOver(solved.solution, 0);
    RunContext context;
    context.isCancelled = [] { return true; };
    const auto changed = settleViewsByLikelihood(solved.solution, {}, context);
    ASSERT_FALSE(changed);
    EXPECT_EQ(changed.error().code, ErrorCode::Cancelled);
}

}  // namespace
}  // namespace skincal::testing
