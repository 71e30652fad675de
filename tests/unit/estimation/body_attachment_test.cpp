#include "core/estimation/body_attachment.h"

#include <gtest/gtest.h>

#include "tests/unit/estimation/synthetic.h"

namespace skincal {
namespace {

/// Two patches seen by several cameras; shapes and all poses known.
struct Scene {
    SyntheticWorld world;
    std::vector<PatchSighting> sightings;
    GrowingBody truth;

    Scene(Random& random, double pixelNoise, std::vector<PrismPatch> patches, int views = 3) {
        SyntheticOptions options;
        options.patches = std::move(patches);
        options.poses = 0;
        options.views = views;
        options.pixelNoise = pixelNoise;
        world = makeWorld(random, options);
        truth.T_r_v.assign(world.T_r_v.begin(), world.T_r_v.end());
        std::vector<std::size_t> origin(options.patches.size(), SIZE_MAX);
        for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
            origin[world.patchOf[u]] = std::min(origin[world.patchOf[u]], u);
        for (const std::size_t u : origin)
            truth.T_r_o.emplace_back(world.T_r_u[u]);
        const auto index = world.measurements.skin.indexById();
        for (std::size_t v = 0; v < world.measurements.views.size(); ++v) {
            for (std::size_t k = 0; k < origin.size(); ++k) {
                PatchSighting sighting{v, k, {}, {}};
                for (const LedDetection& detection : world.measurements.views[v].found) {
                    const std::size_t u = index.at(detection.module);
                    if (world.patchOf[u] != k)
                        continue;
                    const Isometry3d T_o_u = truth.T_r_o[k]->inverse() * world.T_r_u[u];
                    sighting.leds.push_back({T_o_u * world.measurements.skin.templateOf(u).led, T_o_u.linear().col(2),
                                             detection.pixel, detection.sigma_px});
                }
                if (!sighting.leds.empty())
                    sightings.push_back(std::move(sighting));
            }
        }
    }
    [[nodiscard]] const CameraModel& camera() const { return world.measurements.camera; }
};

const std::vector<PrismPatch> kBentAndFlat{{3, 3, 0.08},
                                           {3, 3, 0, makeIsometry(so3Exp({0.4, 0.3, 0.5}), {0.17, 0.03, -0.02})}};

TEST(ResectView, FindsTheCameraFromAllPlacedPatches) {
    Random random(1, "resect");
    for (int i = 0; i < 20; ++i) {
        const Scene scene(random, 0.05, kBentAndFlat);
        GrowingBody body = scene.truth;
        body.T_r_v[1].reset();
        const auto found = resectView(scene.sightings, 1, body, scene.camera(), {}, 1.5);
        ASSERT_TRUE(found);
        EXPECT_LT(poseDifference(*found, *scene.truth.T_r_v[1]).angle, 1 * kDegree);
        EXPECT_LT(poseDifference(*found, *scene.truth.T_r_v[1]).distance, 0.01);
    }
}

TEST(ResectView, NothingWherePlacedPatchesAreNotSeen) {
    Random random(2, "resect none");
    const Scene scene(random, 0.05, kBentAndFlat);
    GrowingBody body = scene.truth;
    body.T_r_v[1].reset();
    body.T_r_o = {std::nullopt, std::nullopt};
    EXPECT_FALSE(resectView(scene.sightings, 1, body, scene.camera(), {}, 1.5));
    EXPECT_FALSE(resectView({}, 1, scene.truth, scene.camera(), {}, 1.5));
}

TEST(ResectView, NothingWhereTwoPosesExplainThePictureEquallyWell) {
    Random random(3, "resect flat");
    int refused = 0;
    int wrong = 0;
    for (int i = 0; i < 30; ++i) {
        const Scene scene(random, 0.5, {{2, 2, 0}}, 1);
        GrowingBody body = scene.truth;
        body.T_r_v[0].reset();
        const auto found = resectView(scene.sightings, 0, body, scene.camera(), {}, 3);
        refused += found ? 0 : 1;
        wrong += found && poseDifference(*found, *scene.truth.T_r_v[0]).angle > 15 * kDegree ? 1 : 0;
    }
    EXPECT_GT(refused, 5);
    EXPECT_LE(wrong, 1);
}

TEST(TriangulatePatch, FindsThePositionFromFewLeds) {
    Random random(4, "triangulate");
    for (int i = 0; i < 20; ++i) {
        Scene scene(random, 0.05, kBentAndFlat);
        GrowingBody body = scene.truth;
        body.T_r_o[1].reset();
        // One LED per view: no pose could come of it alone.
        for (PatchSighting& sighting : scene.sightings)
            sighting.leds.resize(std::min<std::size_t>(sighting.leds.size(), sighting.patch == 1 ? 1 : 99));
        const auto found = triangulatePatch(scene.sightings, 1, scene.truth.T_r_o[1]->linear(), body, scene.camera());
        ASSERT_TRUE(found);
        EXPECT_EQ(found->linear(), scene.truth.T_r_o[1]->linear());
        EXPECT_LT(poseDifference(*found, *scene.truth.T_r_o[1]).distance, 2e-3);
    }
}

TEST(TriangulatePatch, IsExactForExactPixelsAndShrugsOffAnOutlier) {
    Random random(5, "exact");
    Scene scene(random, 0, kBentAndFlat, 5);
    const auto find = [&] {
        return triangulatePatch(scene.sightings, 1, scene.truth.T_r_o[1]->linear(), scene.truth, scene.camera());
    };
    EXPECT_LT(poseDifference(find().value(), *scene.truth.T_r_o[1]).distance, 1e-6);
    for (PatchSighting& sighting : scene.sightings) {
        if (sighting.patch == 1) {
            sighting.leds[0].pixel += Vector2d(150, -90);
            break;
        }
    }
    EXPECT_LT(poseDifference(find().value(), *scene.truth.T_r_o[1]).distance, 2e-3);
}

TEST(TriangulatePatch, ParallelRaysFixNoDepth) {
    Random random(6, "parallel");
    Scene scene(random, 0, kBentAndFlat, 1);
    for (PatchSighting& sighting : scene.sightings)
        sighting.leds.resize(1);
    const Matrix3d R = scene.truth.T_r_o[1]->linear();
    // A single ray, and the same ray twice.
    EXPECT_FALSE(triangulatePatch(scene.sightings, 1, R, scene.truth, scene.camera()));
    auto twice = scene.sightings;
    twice.insert(twice.end(), scene.sightings.begin(), scene.sightings.end());
    EXPECT_FALSE(triangulatePatch(twice, 1, R, scene.truth, scene.camera()));
    // Views without a pose have no rays.
    EXPECT_FALSE(triangulatePatch(scene.sightings, 1, R, {{std::nullopt}, {}}, scene.camera()));
}

TEST(TriangulatePatch, AWrongRotationIsNoticed) {
    Random random(7, "wrong");
    const Scene scene(random, 0.05, kBentAndFlat, 4);
    const Matrix3d wrong = scene.truth.T_r_o[1]->linear() * so3Exp({0, 0, 120 * kDegree});
    EXPECT_FALSE(triangulatePatch(scene.sightings, 1, wrong, scene.truth, scene.camera()));
}

}  // namespace
}  // namespace skincal
