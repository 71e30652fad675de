#include "ui/scene3d/scene_layout.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/random.h"
#include "tests/ui/scene3d/sample_body.h"

namespace skincal {
namespace {

TEST(SceneLayout, PutsPlacedModulesWhereTheyAre) {
    const BodyModel body = sampleBody();
    const SceneLayout layout = layOut(body);
    ASSERT_EQ(layout.modules.size(), body.modules.size());
    EXPECT_TRUE(layout.anyPlaced);
    EXPECT_TRUE(layout.apart.empty());
    for (const ShownModule& module : layout.modules)
        EXPECT_TRUE(module.T_s_u.isApprox(*body.modules[module.index].T_body_module));
    for (const Vector3d& corner : layout.corners())
        EXPECT_LE((corner - layout.centre).norm(), layout.radius * (1 + 1e-12));
}

TEST(SceneLayout, LaysPatchesWithoutPlaceSideBySideInTheirShape) {
    const BodyModel body = sampleBodyWithoutPictures();
    const SceneLayout layout = layOut(body);
    ASSERT_EQ(layout.modules.size(), body.modules.size());
    EXPECT_FALSE(layout.anyPlaced);
    EXPECT_EQ(layout.apart.size(), 2U);
    Eigen::AlignedBox2d boxes[2];
    for (const ShownModule& module : layout.modules) {
        for (const Vector2d& corner : module.type->outline)
            boxes[module.patch->value].extend((module.T_s_u * Vector3d(corner.x(), corner.y(), 0)).head<2>());
    }
    EXPECT_FALSE(boxes[0].intersects(boxes[1]));
    for (const ShownModule& a : layout.modules) {
        for (const ShownModule& b : layout.modules) {
            if (a.patch != b.patch)
                continue;
            const Isometry3d shape =
                body.modules[a.index].T_patch_module->inverse() * *body.modules[b.index].T_patch_module;
            EXPECT_TRUE((a.T_s_u.inverse() * b.T_s_u).isApprox(shape, 1e-9));
        }
    }
}

TEST(SceneLayout, KeepsPatchesWithoutPlaceClearOfTheBody) {
    BodyModel body = sampleBody();
    body.patches[1].T_body_patch.reset();
    for (BodyModule& module : body.modules) {
        if (*module.patch == PatchId(1))
            module.T_body_module.reset();
    }
    const SceneLayout layout = layOut(body);
    ASSERT_EQ(layout.modules.size(), body.modules.size());
    ASSERT_EQ(layout.apart, std::vector<PatchId>{PatchId(1)});
    for (const ShownModule& a : layout.modules) {
        for (const ShownModule& b : layout.modules) {
            if (a.placed && !b.placed) {
                EXPECT_GT((a.T_s_u.translation() - b.T_s_u.translation()).norm(), 0.03);
            }
        }
    }
}

TEST(SceneLayout, LeavesOutWhatHasNoPoseOrNoTemplate) {
    BodyModel body = sampleBody();
    body.modules[0].T_body_module.reset();
    body.modules[0].T_patch_module.reset();
    body.modules[1].type = "something else";
    const SceneLayout layout = layOut(body);
    EXPECT_EQ(layout.modules.size(), body.modules.size() - 2);
    EXPECT_EQ(layout.unknown, 2U);
    EXPECT_EQ(layout.find(body.modules[0].id), nullptr);
}

TEST(SceneLayout, OfNothingIsEmpty) {
    const BodyModel nothing;
    const SceneLayout layout = layOut(nothing);
    EXPECT_TRUE(layout.modules.empty());
    EXPECT_FALSE(pickModule(layout, Vector3d(0, 0, 1), -Vector3d::UnitZ()));
}

TEST(PickModule, FindsTheBoardThatARayHits) {
    const BodyModel body = sampleBody();
    const SceneLayout layout = layOut(body);
    Random random(7);
    for (int trial = 0; trial < 500; ++trial) {
        const auto& module = layout.modules[static_cast<std::size_t>(trial) % layout.modules.size()];
        // Straight at a place well inside the board, from close before it, so that no other lies between.
        const double angle = random.uniform(0, 360 * kDegree);
        const double radius = random.uniform(0, 0.010);
        const Vector3d target = module.T_s_u * Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0);
        const double side = random.uniform(0, 1) < 0.5 ? 1 : -1;
        const Vector3d from =
            module.T_s_u * Vector3d(random.uniform(-0.004, 0.004), random.uniform(-0.004, 0.004), side * 0.01);
        EXPECT_EQ(pickModule(layout, from, target - from), module.id);
        EXPECT_NE(pickModule(layout, from, from - target), module.id) << "what lies behind is not hit";
    }
}

TEST(PickModule, PrefersTheNearerBoard) {
    BodyModel body = sampleBody();
    body.modules[1].T_body_module = *body.modules[0].T_body_module * Eigen::Translation3d(0, 0, 0.01);
    const SceneLayout layout = layOut(body);
    const Isometry3d& T = *body.modules[0].T_body_module;
    EXPECT_EQ(pickModule(layout, T * Vector3d(0, 0, 0.1), -T.linear().col(2)), body.modules[1].id);
    EXPECT_EQ(pickModule(layout, T * Vector3d(0, 0, -0.1), T.linear().col(2)), body.modules[0].id);
}

}  // namespace
}  // namespace skincal
