#include "core/estimation/patch_shape.h"

#include <gtest/gtest.h>

#include "core/estimation/patch_sightings.h"
#include "tests/unit/estimation/synthetic.h"

namespace skincal {
namespace {

struct Shaped {
    SyntheticWorld world;
    GravityTable gravity;
    SkinLayout layout;

    explicit Shaped(SyntheticWorld w)
        : world(std::move(w)),
          gravity(world.measurements.skin, world.measurements.gravity),
          layout(layOutSkin(world.measurements, gravity)) {}

    /// Rms over all modules of a patch against its true shape.
    [[nodiscard]] PoseDifference rms(std::size_t k, const PatchShape& shape) const {
        const Patch& patch = layout.patches[k];
        PoseDifference sum;
        for (std::size_t i = 0; i < patch.modules.size(); ++i) {
            const Isometry3d T_o_u = world.T_r_u[patch.origin].inverse() * world.T_r_u[patch.modules[i]];
            const PoseDifference d = poseDifference(shape.T_o_u[i].value(), T_o_u);
            sum.angle += d.angle * d.angle / static_cast<double>(patch.modules.size());
            sum.distance += d.distance * d.distance / static_cast<double>(patch.modules.size());
        }
        return {std::sqrt(sum.angle), std::sqrt(sum.distance)};
    }
    [[nodiscard]] PatchShape chain(std::size_t k) const {
        return chainPatchShape(world.measurements.skin, layout, gravity, layout.patches[k]);
    }
    [[nodiscard]] PatchShapesResult estimate() const {
        return estimatePatchShapes(world.measurements.skin, layout, gravity).value();
    }
};

SyntheticOptions withoutViews(std::vector<PrismPatch> patches) {
    SyntheticOptions options;
    options.patches = std::move(patches);
    options.views = 0;
    return options;
}

SyntheticOptions uncalibrated(std::vector<PrismPatch> patches) {
    SyntheticOptions options = withoutViews(std::move(patches));
    options.bias = 0.3;
    options.scale = 0.01;
    options.accelerometerNoise = 0.03;
    options.poses = 15;
    return options;
}

void silence(SyntheticWorld& world, std::size_t module) {
    std::erase_if(world.measurements.gravity, [&](const GravityReading& reading) {
        return reading.module == world.measurements.skin.modules[module].id;
    });
}

const std::vector<PrismPatch> kThreeShapes{{4, 3, 0.06},
                                           {3, 4, 0, makeIsometry(so3Exp({1, 2, 0.5}), {0.3, 0, 0})},
                                           {4, 3, 0.05, makeIsometry(so3Exp({-1, 0.3, 2}), {0, 0.3, 0}), true}};

TEST(PatchShape, ExactReadingsGiveExactShapesBothWays) {
    Random random(1, "exact");
    for (int i = 0; i < 5; ++i) {
        const Shaped shaped(makeWorld(random, withoutViews(kThreeShapes)));
        ASSERT_EQ(shaped.layout.patches.size(), 3U);
        const PatchShapesResult found = shaped.estimate();
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_LT(shaped.rms(k, shaped.chain(k)).angle, 1e-7);
            EXPECT_LT(shaped.rms(k, shaped.chain(k)).distance, 1e-9);
            EXPECT_LT(shaped.rms(k, found.shapes[k]).angle, 1e-5);
            EXPECT_LT(shaped.rms(k, found.shapes[k]).distance, 1e-6);
            const Matrix3d R_o_r = shaped.world.T_r_u[shaped.layout.patches[k].origin].linear().transpose();
            for (std::size_t p = 0; p < shaped.world.up_r.size(); ++p)
                EXPECT_LT((*found.up_o[k][p] - R_o_r * shaped.world.up_r[p]).norm(), 1e-4);
        }
        EXPECT_LT(found.accelerometerSigma, 1e-3);
    }
}

TEST(PatchShape, CalibratingTheAccelerometersBeatsTheChain) {
    Random random(2, "calibrate");
    double chain = 0;
    double whole = 0;
    for (int i = 0; i < 4; ++i) {
        const Shaped shaped(makeWorld(random, uncalibrated({{4, 4, 0.08}})));
        const PatchShapesResult found = shaped.estimate();
        chain += shaped.rms(0, shaped.chain(0)).angle;
        whole += shaped.rms(0, found.shapes[0]).angle;
        EXPECT_LT(shaped.rms(0, found.shapes[0]).distance, 0.5 * shaped.rms(0, shaped.chain(0)).distance);
        EXPECT_NEAR(found.accelerometerSigma, 0.03, 0.006);
    }
    EXPECT_LT(whole, 0.4 * chain);
}

TEST(PatchShape, ARingCloses) {
    Random random(3, "ring");
    PrismPatch ring{8, 1, 0};
    ring.rectangles = ring.ring = true;
    double chain = 0;
    double whole = 0;
    for (int i = 0; i < 20; ++i) {
        const Shaped shaped(makeWorld(random, uncalibrated({ring})));
        const auto pairs = adjacentPorts(shaped.world.measurements.skin, shaped.layout);
        ASSERT_EQ(pairs.size(), 8U);
        const auto largestGap = [&](const PatchShape& shape) {
            double largest = 0;
            for (const PortPair& pair : pairs) {
                const Vector3d a = *shape.T_o_u[pair.a] * pair.port_a;
                const Vector3d b = *shape.T_o_u[pair.b] * pair.port_b;
                largest = std::max(largest, (a - b).norm());
            }
            return largest;
        };
        chain = std::max(chain, largestGap(shaped.chain(0)));
        whole = std::max(whole, largestGap(shaped.estimate().shapes[0]));
    }
    // The chain leaves its whole error at one link.
    EXPECT_GT(chain, 1.5e-3);
    EXPECT_LT(whole, 0.3e-3);
}

TEST(PatchShape, ASilentModuleIsHeldByItsLinks) {
    Random random(4, "silent");
    SyntheticWorld world = makeWorld(random, withoutViews({{3, 3, 0.08}}));
    silence(world, 1);
    const Shaped shaped(std::move(world));
    const auto found = shaped.estimate();
    EXPECT_LT(shaped.rms(0, found.shapes[0]).distance, 1e-3);
    EXPECT_LT(shaped.rms(0, found.shapes[0]).angle, 2 * kDegree);
    // The paper's chain has no rotation for it: it is left out, and so is what only it leads to.
    EXPECT_FALSE(shaped.chain(0).T_o_u[1]);
    EXPECT_TRUE(shaped.chain(0).T_o_u[4]);
}

TEST(PatchShape, ASilentEndOfAStripIsAGuess) {
    Random random(5, "end");
    SyntheticWorld world = makeWorld(random, withoutViews({{5, 1, 0.08}}));
    silence(world, 4);
    const Shaped shaped(std::move(world));
    const auto found = shaped.estimate();
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_EQ(found.assumedFlat[i], i == 4);
    EXPECT_FALSE(shaped.chain(0).T_o_u[4]);
}

TEST(PatchShape, OneBrokenAccelerometerIsNamedAndSpoilsOnlyItself) {
    Random random(14, "broken");
    for (int i = 0; i < 3; ++i) {
        SyntheticWorld world = makeWorld(random, uncalibrated({{4, 4, 0.08}}));
        const Shaped sound(world);
        for (GravityReading& reading : world.measurements.gravity) {
            if (reading.module == ModuleId(2))
                reading.acceleration += 2.0 * random.normal3();
        }
        const Shaped broken(std::move(world));
        const PatchShapesResult found = broken.estimate();
        EXPECT_NEAR(found.accelerometerSigma, 0.03, 0.008);
        ASSERT_EQ(found.noisy.size(), 1U);
        EXPECT_EQ(found.noisy[0].module, 1U);
        EXPECT_GT(found.noisy[0].sigma, 0.5);
        const PatchShapesResult expected = sound.estimate();
        for (std::size_t u = 0; u < 16; ++u) {
            const double angle = poseDifference(*found.shapes[0].T_o_u[u], *expected.shapes[0].T_o_u[u]).angle;
            EXPECT_LT(angle, (u == 1 ? 90 : 0.4) * kDegree);
        }
        EXPECT_TRUE(expected.noisy.empty());
    }
}

TEST(PatchShape, TellsNoDirectionThatNobodyMeasured) {
    Random random(15, "gaps");
    SyntheticWorld world =
        makeWorld(random, withoutViews({{2, 2, 0}, {2, 2, 0, makeIsometry(Matrix3d::Identity(), {0.3, 0, 0})}}));
    std::erase_if(world.measurements.gravity, [&](const GravityReading& reading) {
        return world.patchOf[reading.module.value - 1] == 1 && reading.pose == 3;
    });
    const auto found = Shaped(std::move(world)).estimate();
    for (std::size_t p = 0; p < found.up_o[0].size(); ++p) {
        EXPECT_TRUE(found.up_o[0][p]);
        EXPECT_EQ(found.up_o[1][p].has_value(), p != 3);
    }
}

TEST(PatchShape, ASilentOriginIsReachedThroughItsNeighbours) {
    Random random(6, "origin");
    SyntheticWorld world = makeWorld(random, withoutViews({{3, 3, 0.08}}));
    silence(world, 4);
    const Shaped shaped(std::move(world));
    ASSERT_EQ(shaped.layout.patches[0].origin, 4U);
    const auto found = shaped.estimate();
    for (const auto& T : found.shapes[0].T_o_u)
        EXPECT_TRUE(T);
}

TEST(PatchShape, WithoutGravityAPatchIsGuessedFlat) {
    Random random(7, "none");
    SyntheticOptions options = withoutViews({{3, 3, 0}});
    options.poses = 0;
    const Shaped shaped(makeWorld(random, options));
    const auto found = shaped.estimate();
    for (const auto& T : found.shapes[0].T_o_u)
        EXPECT_LT(rotationAngle(T.value().linear()), 1e-6);
    EXPECT_EQ(found.assumedFlat, std::vector<bool>(9, true)) << "and says that it is a guess";
    EXPECT_EQ(found.accelerometerSigma, 0);
    EXPECT_FALSE(shaped.chain(0).T_o_u[0]);
    EXPECT_TRUE(shaped.chain(0).T_o_u[4]);
}

TEST(PatchShape, ALoneModuleIsItsOwnFrame) {
    Random random(8, "lone");
    SyntheticOptions options = withoutViews({{1, 1, 0}});
    options.poses = 6;
    const Shaped shaped(makeWorld(random, options));
    EXPECT_LT(shaped.rms(0, shaped.estimate().shapes[0]).angle, 1e-12);
    EXPECT_LT(shaped.rms(0, shaped.chain(0)).angle, 1e-12);
}

TEST(PatchShape, StopsWhenCancelled) {
    Random random(9, "cancel");
    const Shaped shaped(makeWorld(random, uncalibrated({{3, 3, 0.08}, {2, 2, 0}})));
    RunContext context;
    // At once, and at some moment later.
    for (const int limit : {0, 2, 5}) {
        int calls = 0;
        context.isCancelled = [&] { return ++calls > limit; };
        const auto found =
            estimatePatchShapes(shaped.world.measurements.skin, shaped.layout, shaped.gravity, {}, context);
        ASSERT_FALSE(found);
        EXPECT_EQ(found.error().code, ErrorCode::Cancelled);
    }
}

TEST(LinkSeparations, NeighboursAreAPitchApartAndCablesFar) {
    Random random(10, "separation");
    SyntheticOptions options;
    options.patches = {{5, 5, 0}};
    SyntheticWorld world = makeWorld(random, options);
    auto& links = world.measurements.skin.links;
    links.push_back({ModuleId(5), 0, ModuleId(21), 3});
    links.push_back({ModuleId(1), 2, ModuleId(1), 3});
    const SkinGraph graph = buildSkinGraph(world.measurements.skin);
    const std::vector<std::optional<Matrix3d>> none(graph.links().size());
    const auto found = linkSeparations(world.measurements, graph, none, 2.2, 2);
    ASSERT_EQ(found.size(), links.size());
    for (std::size_t l = 0; l + 2 < links.size(); ++l) {
        EXPECT_GT(found[l].value(), 0.5);
        EXPECT_LT(found[l].value(), 1.7);
    }
    EXPECT_GT(found[links.size() - 2].value(), 2.5);
    EXPECT_FALSE(found.back());
    for (const auto& separation : linkSeparations(world.measurements, graph, none, 2.2, 6))
        EXPECT_FALSE(separation);
    // Two links in a picture have nothing to be compared with.
    for (ViewDetections& view : world.measurements.views)
        std::erase_if(view.found, [](const LedDetection& d) { return d.module.value > 3; });
    for (const auto& separation : linkSeparations(world.measurements, graph, none, 2.2, 1))
        EXPECT_FALSE(separation);
}

TEST(LinkSeparations, OneViewIsEnoughWhereBothLedsLieBesideOtherNeighbours) {
    Random random(11, "separation in one view");
    SyntheticOptions options;
    options.patches = {{5, 5, 0}};
    options.views = 1;
    SyntheticWorld world = makeWorld(random, options);
    auto& links = world.measurements.skin.links;
    links.push_back({ModuleId(5), 0, ModuleId(21), 3});
    const SkinGraph graph = buildSkinGraph(world.measurements.skin);
    const std::vector<std::optional<Matrix3d>> none(graph.links().size());
    EXPECT_GT(linkSeparations(world.measurements, graph, none, 2.2, 2).back().value(), 2.5);
    // A false detection lies beside none of its neighbours: it proves nothing.
    auto& detections = world.measurements.views.front().found;
    const auto end = std::find_if(detections.begin(), detections.end(),
                                  [](const LedDetection& d) { return d.module == ModuleId(21); });
    ASSERT_NE(end, detections.end());
    end->pixel.y() += 300;
    EXPECT_FALSE(linkSeparations(world.measurements, graph, none, 2.2, 2).back());
}

TEST(LayOutSkin, FindsPatchesAndTellsACableByItsRotation) {
    Random random(11, "layout");
    SyntheticWorld world = makeWorld(random, withoutViews(kThreeShapes));
    world.measurements.skin.links.push_back({ModuleId(12), 0, ModuleId(13), 3});
    const Shaped shaped(std::move(world));
    ASSERT_EQ(shaped.layout.patches.size(), 3U);
    EXPECT_EQ(shaped.layout.patchOf, shaped.world.patchOf);
    EXPECT_EQ(shaped.layout.verdicts.back().kind, LinkKind::Cable);
    EXPECT_EQ(adjacentPorts(shaped.world.measurements.skin, shaped.layout).size(),
              shaped.world.measurements.skin.links.size() - 1);
}

TEST(LayOutSkin, NeighboursTurnedToAndFroStayNeighbours) {
    // Hexagons joined port 0 to 0 and 3 to 3: their LEDs are 16 and 42 mm apart in turn.
    const ModuleTemplate type = paperHexagon();
    SyntheticWorld world;
    world.measurements.camera = syntheticCamera(false);
    Skin& skin = world.measurements.skin;
    skin.templates = {type};
    for (std::uint32_t m = 0; m < 10; ++m) {
        skin.modules.push_back({ModuleId(m + 1), 0});
        const int port = m % 2 == 0 ? 0 : 3;
        if (m > 0)
            skin.links.push_back({ModuleId(m), 3 - port, ModuleId(m + 1), 3 - port});
        const Vector3d& p = type.ports[static_cast<std::size_t>(3 - port)];
        const Matrix3d R = so3Exp({0, 0, m % 2 == 0 ? 0 : 180 * kDegree});
        Isometry3d T = makeIsometry(R, Vector3d::Zero());
        if (m > 0)
            T.translation() = world.T_r_u.back() * p - R * p;
        world.T_r_u.push_back(T);
        world.patchOf.push_back(0);
    }
    for (const double height : {0.4, 0.5}) {
        world.T_r_v.push_back(lookAt({0.1, 0.02, height}, {0.1, 0, 0}));
        world.measurements.views.push_back(seenFrom(world, world.T_r_v.back()));
    }
    const GravityTable gravity(skin, {});
    const SkinLayout layout = layOutSkin(world.measurements, gravity);
    EXPECT_EQ(layout.patches.size(), 1U);
}

TEST(LayOutSkin, ALinkAcrossAMovingJointIsACable) {
    Random random(13, "joint");
    SyntheticWorld world = makeWorld(random, uncalibrated({{3, 3, 0.1}, {3, 3, 0.1, Isometry3d::Identity()}}));
    for (GravityReading& reading : world.measurements.gravity) {
        const std::size_t u = reading.module.value - 1;
        // The second patch swings by up to 40 degrees about an axis in its own plane.
        if (world.patchOf[u] == 1)
            reading.acceleration = world.T_r_u[u].linear().transpose() * so3Exp({0.7 * std::sin(reading.pose), 0, 0}) *
                                   world.T_r_u[u].linear() * reading.acceleration;
    }
    world.measurements.skin.links.push_back({ModuleId(9), 0, ModuleId(10), 3});
    const Shaped shaped(std::move(world));
    EXPECT_EQ(shaped.layout.patches.size(), 2U);
    EXPECT_EQ(shaped.layout.verdicts.back().kind, LinkKind::Cable);
}

}  // namespace
}  // namespace skincal
