#include "core/simulation/patch_layout.h"

#include <gtest/gtest.h>

#include <set>

namespace skincal {
namespace {

class Layouts : public testing::TestWithParam<std::size_t> {
  protected:
    ModuleTemplate type_ = GetParam() == 0   ? paperHexagon()
                           : GetParam() == 1 ? triangleTemplate()
                                             : rectangleTemplate();
};

TEST_P(Layouts, AreConnectedAndDoNotOverlap) {
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
        Random random(seed, "layout test");
        const std::size_t n = 2 + random.index(40);
        const PatchLayout layout = growPatch(type_, n, random.uniform(), random);
        ASSERT_EQ(layout.modules.size(), n);
        EXPECT_GE(layout.links.size(), n - 1);
        std::set<std::pair<std::size_t, int>> ports;
        for (const LaidLink& link : layout.links) {
            EXPECT_TRUE(ports.insert({link.a, link.a_port}).second);
            EXPECT_TRUE(ports.insert({link.b, link.b_port}).second);
        }
        for (std::size_t a = 0; a < n; ++a) {
            for (std::size_t b = 0; b < a; ++b)
                EXPECT_GT((layout.modules[a].position - layout.modules[b].position).norm(),
                          1.3 * type_.ports[1].norm());
        }
    }
}

TEST_P(Layouts, OnASmoothSurfaceLinkPointsNearlyMeet) {
    for (const SurfaceKind kind :
         {SurfaceKind::Plane, SurfaceKind::Cylinder, SurfaceKind::FreeForm, SurfaceKind::Sole}) {
        Random random(3, "surface test");
        const PatchLayout layout = growPatch(type_, 15, 0.3, random);
        PatchPlan plan;
        plan.surface = kind;
        plan.radius = 0.08;
        const auto poses = bendOntoSurface(layout, type_, plan, 5);
        for (const LaidLink& link : layout.links) {
            const Vector3d a = poses[link.a] * type_.ports[static_cast<std::size_t>(link.a_port)];
            const Vector3d b = poses[link.b] * type_.ports[static_cast<std::size_t>(link.b_port)];
            EXPECT_LT((a - b).norm(), kind == SurfaceKind::Plane ? 1e-9 : 1.5e-3);
        }
        for (const Isometry3d& T : poses)
            EXPECT_TRUE(isRigid(T));
    }
}

INSTANTIATE_TEST_SUITE_P(Templates, Layouts, testing::Values(0U, 1U, 2U));

TEST(PatchLayout, SevenHexagonsAreOneWithSixRoundIt) {
    Random random(1, "flower");
    const PatchLayout layout = growPatch(paperHexagon(), 7, 0, random);
    for (std::size_t m = 1; m < 7; ++m)
        EXPECT_NEAR((layout.modules[m].position - layout.modules[0].position).norm(), 0.028, 0.0005);
}

TEST(PatchLayout, AStripClosesToARing) {
    PatchPlan plan;
    plan.surface = SurfaceKind::Cylinder;
    plan.strip = plan.ring = true;
    plan.radius = 0.5 * 27.785e-3 / std::tan(180 * kDegree / 8);
    const ModuleTemplate type = paperHexagon();
    const PatchLayout layout = layStrip(type, 8, true);
    ASSERT_EQ(layout.links.size(), 8U);
    const auto poses = bendOntoSurface(layout, type, plan, 1);
    for (const LaidLink& link : layout.links) {
        const Vector3d a = poses[link.a] * type.ports[static_cast<std::size_t>(link.a_port)];
        const Vector3d b = poses[link.b] * type.ports[static_cast<std::size_t>(link.b_port)];
        EXPECT_LT((a - b).norm(), 1e-5);
    }
}

TEST(PatchLayout, AStripNeedsOppositePorts) {
    EXPECT_THROW((void)layStrip(triangleTemplate(), 3, false), std::logic_error);
}

}  // namespace
}  // namespace skincal
