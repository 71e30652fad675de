#include "core/estimation/gravity_alignment.h"

#include <gtest/gtest.h>

#include "core/geometry/random.h"

namespace skincal {
namespace {

struct Hung {
    std::vector<Matrix3d> R_g_o;
    std::vector<std::vector<std::optional<Vector3d>>> up_o;
};

Hung hang(Random& random, std::size_t patches, std::size_t poses, double noise) {
    Hung hung;
    std::vector<Vector3d> up_g;
    for (std::size_t p = 0; p < poses; ++p)
        up_g.push_back(random.direction());
    for (std::size_t k = 0; k < patches; ++k) {
        hung.R_g_o.push_back(random.rotation());
        hung.up_o.emplace_back();
        for (const Vector3d& up : up_g)
            hung.up_o.back().emplace_back((hung.R_g_o[k].transpose() * up + random.normal3() * noise).normalized());
    }
    return hung;
}

TEST(AlignPatchesByGravity, FindsACommonFrame) {
    Random random(7, "align");
    for (int i = 0; i < 50; ++i) {
        Hung hung = hang(random, 5, 10, 0.005);
        // The patch that knows most is the reference; gaps elsewhere do no harm.
        hung.up_o[0][3].reset();
        hung.up_o[2][7].reset();
        const GravityFrame frame = alignPatchesByGravity(hung.up_o);
        for (std::size_t k = 1; k < 5; ++k) {
            ASSERT_TRUE(frame.R_g_o[k]);
            const Matrix3d found = frame.R_g_o[0]->transpose() * *frame.R_g_o[k];
            EXPECT_LT(rotationAngle(found.transpose() * hung.R_g_o[0].transpose() * hung.R_g_o[k]), 1.5 * kDegree);
        }
        EXPECT_LT(frame.disagreement_rad, 1 * kDegree);
        EXPECT_GT(frame.disagreement_rad, 0);
    }
}

TEST(AlignPatchesByGravity, LeavesOutAPatchWhoseJointMoved) {
    Random random(8, "joint");
    Hung hung = hang(random, 4, 10, 0.001);
    for (auto& up : hung.up_o[2])
        up = random.direction();
    const GravityFrame frame = alignPatchesByGravity(hung.up_o);
    EXPECT_TRUE(frame.R_g_o[0] && frame.R_g_o[1] && frame.R_g_o[3]);
    EXPECT_FALSE(frame.R_g_o[2]);
}

TEST(AlignPatchesByGravity, NamesTheOneThatMovedWhicheverItIs) {
    Random random(10, "whichever");
    for (std::size_t moved = 0; moved < 4; ++moved) {
        Hung hung = hang(random, 4, 10, 0.001);
        for (auto& up : hung.up_o[moved])
            up = random.direction();
        const GravityFrame frame = alignPatchesByGravity(hung.up_o);
        for (std::size_t k = 0; k < 4; ++k)
            EXPECT_EQ(frame.R_g_o[k].has_value(), k != moved) << moved;
    }
}

TEST(AlignPatchesByGravity, APatchWithoutReadingsDoesNotStandInTheWay) {
    Random random(11, "silent");
    Hung hung = hang(random, 3, 8, 0.001);
    for (auto& up : hung.up_o[0])
        up.reset();
    const GravityFrame frame = alignPatchesByGravity(hung.up_o);
    EXPECT_FALSE(frame.R_g_o[0]);
    EXPECT_TRUE(frame.R_g_o[1] && frame.R_g_o[2]);
}

TEST(AlignPatchesByGravity, BadOptionsThrow) {
    EXPECT_THROW((void)alignPatchesByGravity({}, {0, 20}), std::logic_error);
    EXPECT_THROW((void)alignPatchesByGravity({}, {0.1, 0}), std::logic_error);
}

TEST(AlignPatchesByGravity, NeedsPosesThatDiffer) {
    Random random(9, "alike");
    Hung hung = hang(random, 3, 6, 0);
    for (std::size_t k = 0; k < 3; ++k) {
        for (auto& up : hung.up_o[k])
            up = hung.R_g_o[k].transpose() * Vector3d::UnitZ();
    }
    for (const auto& R : alignPatchesByGravity(hung.up_o).R_g_o)
        EXPECT_FALSE(R);
    for (auto& list : hung.up_o)
        list.resize(1);
    for (const auto& R : alignPatchesByGravity(hung.up_o).R_g_o)
        EXPECT_FALSE(R);
    EXPECT_TRUE(alignPatchesByGravity({}).R_g_o.empty());
}

}  // namespace
}  // namespace skincal
