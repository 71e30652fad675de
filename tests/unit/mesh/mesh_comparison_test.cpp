#include "core/mesh/mesh_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/mesh/mesh_surface.h"
#include "tests/unit/mesh/sample_meshes.h"

namespace skincal {
namespace {

using Kind = AlignmentDoubt::Kind;
using test::hasDoubt;

/// A body of which part is covered, and the same seen from its own frame.
struct Covered {
    TriangleMesh mesh;
    std::vector<PlacedModule> modules;  ///< body frame
    Isometry3d T_mesh_body;
};

Covered covered(std::uint64_t seed, std::size_t count, double offset, double noise) {
    Random random(seed, "covered");
    Covered result;
    result.mesh = test::bumpyBody(random);
    result.T_mesh_body = test::randomPose(random, 0.5);
    auto modules = test::modulesOn(result.mesh, count, offset, random, [](const Vector3d& p) { return p.y() > -0.03; });
    for (PlacedModule& module : modules) {
        module.T_body_module.translation() += noise * random.normal3();
        module.T_body_module.linear() = so3Exp(0.01 * random.normal3()) * module.T_body_module.linear();
    }
    result.modules = test::movedBy(result.T_mesh_body.inverse(), modules);
    return result;
}

/// The number that comes with a doubt; 0 without it.
double doubtOf(const MeshComparison& comparison, Kind kind) {
    const auto found = std::find_if(comparison.doubts.begin(), comparison.doubts.end(),
                                    [&](const AlignmentDoubt& doubt) { return doubt.kind == kind; });
    return found == comparison.doubts.end() ? 0 : found->value;
}

double errorOf(const MeshComparison& comparison, const Covered& world) {
    double sum = 0;
    for (const PlacedModule& module : world.modules) {
        const Vector3d p = module.T_body_module.translation();
        sum += (comparison.T_mesh_body * p - world.T_mesh_body * p).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(world.modules.size()));
}

TEST(MeshComparison, FindsPoseAndOffsetOfABodyFromAnyPoseToBeginWith) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const double offset = 1e-3 * static_cast<double>(seed % 4);
        const Covered world = covered(seed, 60, offset, 0.2e-3);
        const auto comparison = compareWithMesh(world.modules, world.mesh);
        ASSERT_TRUE(comparison) << comparison.error().message();
        EXPECT_LT(errorOf(*comparison, world), 1.2e-3) << "seed " << seed;
        EXPECT_NEAR(comparison->offset, offset, 0.4e-3) << "seed " << seed;
        EXPECT_LT(comparison->rms, 0.3e-3) << "seed " << seed;
        EXPECT_LT(comparison->angle_rms, 3 * kDegree);
        EXPECT_EQ(comparison->modules.size(), world.modules.size());
        EXPECT_FALSE(hasDoubt(*comparison, Kind::OtherPoseFits)) << "seed " << seed;
        EXPECT_FALSE(hasDoubt(*comparison, Kind::Slides)) << "seed " << seed;
        EXPECT_FALSE(hasDoubt(*comparison, Kind::FitsBadly));
        EXPECT_GT(comparison->covered, 0.3);
        EXPECT_LT(comparison->covered, 0.95);
    }
}

TEST(MeshComparison, TheSameSeedGivesTheSameResult) {
    const Covered world = covered(3, 40, 2e-3, 0.3e-3);
    const auto a = compareWithMesh(world.modules, world.mesh);
    const auto b = compareWithMesh(world.modules, world.mesh);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->T_mesh_body.matrix(), b->T_mesh_body.matrix());
    EXPECT_EQ(a->rms, b->rms);
}

TEST(MeshComparison, AModuleThatSitsElsewhereStandsOutAndMovesNoOther) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        Covered world = covered(seed, 60, 2e-3, 0.1e-3);
        Random random(seed, "displaced");
        PlacedModule& victim = world.modules[random.index(world.modules.size())];
        const double height = (seed % 2 ? 1 : -1) * random.uniform(4e-3, 9e-3);
        victim.T_body_module.translation() += height * victim.T_body_module.linear().col(2);
        const auto comparison = compareWithMesh(world.modules, world.mesh);
        ASSERT_TRUE(comparison);
        EXPECT_EQ(comparison->worst.id, victim.id) << "seed " << seed;
        EXPECT_NEAR(comparison->worst.deviation, height, 0.8e-3) << "seed " << seed;
        EXPECT_LT(comparison->share95, 0.5e-3);
    }
}

TEST(MeshComparison, AnOffsetThatIsGivenIsKept) {
    const Covered world = covered(5, 60, 3e-3, 0.1e-3);
    MeshComparisonOptions options;
    options.fitOffset = false;
    options.offset = 3e-3;
    const auto comparison = compareWithMesh(world.modules, world.mesh, options);
    ASSERT_TRUE(comparison);
    EXPECT_EQ(comparison->offset, 3e-3);
    EXPECT_LT(comparison->rms, 0.3e-3);
    EXPECT_FALSE(hasDoubt(*comparison, Kind::OffsetUnknown));
}

TEST(MeshComparison, ACylinderThatMayTurnAndSlideSaysSo) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        Random random(seed, "cylinder");
        const TriangleMesh tube = tubeMesh(Vector3d(0, 0, -0.2), Vector3d(0, 0, 0.2), 0.05, 72);
        auto modules = test::modulesOn(tube, 30, 2e-3, random,
                                       [](const Vector3d& p) { return std::abs(p.z()) < 0.08 && p.x() > -0.02; });
        modules = test::movedBy(test::randomPose(random, 0.3), std::move(modules));
        const auto comparison = compareWithMesh(modules, tube);
        ASSERT_TRUE(comparison);
        EXPECT_LT(comparison->rms, 0.5e-3);
        EXPECT_TRUE(hasDoubt(*comparison, Kind::OtherPoseFits)) << "seed " << seed;
        EXPECT_TRUE(hasDoubt(*comparison, Kind::Slides)) << "seed " << seed;
    }
}

TEST(MeshComparison, OnAPlaneTheOffsetIsNotKnown) {
    Random random(1, "plane");
    const TriangleMesh plate{{{-0.2, -0.1, 0}, {0.2, -0.1, 0}, {0.2, 0.1, 0}, {-0.2, 0.1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    const auto comparison = compareWithMesh(test::modulesOn(plate, 30, 2e-3, random), plate);
    ASSERT_TRUE(comparison);
    EXPECT_TRUE(hasDoubt(*comparison, Kind::OffsetUnknown));
    EXPECT_TRUE(hasDoubt(*comparison, Kind::Slides));
}

TEST(MeshComparison, AMeshOfSomethingElseFitsBadlyOrNotAtAll) {
    const Covered world = covered(1, 60, 0, 0.1e-3);
    const auto onTube = [&](double radius) {
        return compareWithMesh(world.modules, tubeMesh(Vector3d(0, 0, -0.2), Vector3d(0, 0, 0.2), radius, 60));
    };
    const auto alike = onTube(0.07);
    ASSERT_TRUE(alike) << alike.error().message();
    EXPECT_GT(doubtOf(*alike, Kind::FitsBadly), 5e-3);
    const auto other = onTube(0.03);
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().code, ErrorCode::NoConsensus);
}

TEST(MeshComparison, AFewModulesOnALargeBodySaySo) {
    const Covered world = covered(1, 8, 0, 0.1e-3);
    const auto comparison = compareWithMesh(world.modules, scaled(world.mesh, 6));
    ASSERT_TRUE(comparison) << comparison.error().message();
    EXPECT_TRUE(hasDoubt(*comparison, Kind::FewCovered));
}

TEST(MeshComparison, AModuleOffTheMeshIsUnmatched) {
    Covered world = covered(4, 60, 1e-3, 0.1e-3);
    EXPECT_FALSE(hasDoubt(compareWithMesh(world.modules, world.mesh).value(), Kind::Unmatched));
    PlacedModule& stray = world.modules[17];
    stray.T_body_module.translation() += 0.1 * stray.T_body_module.linear().col(2);
    const auto comparison = compareWithMesh(world.modules, world.mesh);
    ASSERT_TRUE(comparison) << comparison.error().message();
    EXPECT_EQ(comparison->unmatched, std::vector{stray.id});
    EXPECT_EQ(comparison->modules.size(), world.modules.size() - 1);
    EXPECT_EQ(doubtOf(*comparison, Kind::Unmatched), 1);
    EXPECT_LT(errorOf(*comparison, world), 1.2e-3) << "the others lie as they did";
}

TEST(MeshComparison, AMeshOfAnotherSizeIsDoubted) {
    // Flat, so that modules lie on it however large it is.
    Random random(6, "size");
    const TriangleMesh plate{{{-0.2, -0.1, 0}, {0.2, -0.1, 0}, {0.2, 0.1, 0}, {-0.2, 0.1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
    const auto modules = test::modulesOn(plate, 30, 0, random);
    const auto same = compareWithMesh(modules, plate);
    ASSERT_TRUE(same) << same.error().message();
    EXPECT_FALSE(hasDoubt(*same, Kind::SizesDiffer));
    const auto large = compareWithMesh(modules, scaled(plate, 60));
    ASSERT_TRUE(large) << large.error().message();
    EXPECT_GT(doubtOf(*large, Kind::SizesDiffer), 60);
    EXPECT_LT(doubtOf(*large, Kind::SizesDiffer), 75);
}

TEST(MeshComparison, TellsTheUnitFromTheSizes) {
    const Covered world = covered(2, 30, 0, 0);
    EXPECT_EQ(likelyUnit(world.modules, world.mesh), MeshUnit::Metre);
    EXPECT_EQ(likelyUnit(world.modules, scaled(world.mesh, 1000)), MeshUnit::Millimetre);
}

TEST(MeshComparison, RefusesWhatCanNotBeCompared) {
    const Covered world = covered(1, 20, 0, 0);
    const auto codeOf = [](const auto& result) {
        return result ? std::optional<ErrorCode>() : std::optional(result.error().code);
    };
    const std::span all(world.modules);
    EXPECT_EQ(codeOf(compareWithMesh(all.first(kLeastModulesOnMesh - 1), world.mesh)), ErrorCode::TooFewPoints);
    EXPECT_EQ(codeOf(compareWithMesh(all, {})), ErrorCode::DegeneratePoints);
    TriangleMesh broken = world.mesh;
    broken.vertices.front().x() = std::nan("");
    EXPECT_EQ(codeOf(compareWithMesh(all, broken)), ErrorCode::NotFinite);
    RunContext cancelled;
    cancelled.isCancelled = [] { return true; };
    EXPECT_EQ(codeOf(compareWithMesh(all, world.mesh, {}, cancelled)), ErrorCode::Cancelled);
}

/// What becomes of work that is cancelled the n-th time it asks, for n spread over all the times that it would ask:
/// how often it asked once it had been told to stop.
std::vector<int> asksAfterCancelling(int steps, const std::function<void(const RunContext&)>& work) {
    int asked = 0;
    RunContext context;
    context.isCancelled = [&] { return ++asked < 0; };
    work(context);
    const int total = asked;
    std::vector<int> more;
    for (int step = 0; step < steps; ++step) {
        const int last = step * total / steps;
        asked = 0;
        context.isCancelled = [&] { return ++asked > last; };
        work(context);
        more.push_back(asked - last);
    }
    return more;
}

TEST(MeshComparison, CancelledAnywhereItStops) {
    const Covered world = covered(1, 40, 0, 0);
    const auto more = asksAfterCancelling(25, [&](const RunContext& context) {
        // How often it asks depends on which thread does what.
        bool isTold = false;
        RunContext heard;
        heard.isCancelled = [&] { return isTold = context.isCancelled(); };
        const auto result = compareWithMesh(world.modules, world.mesh, {}, heard);
        EXPECT_EQ(result.has_value(), !isTold);
        if (!result) {
            EXPECT_EQ(result.error().code, ErrorCode::Cancelled);
        }
    });
    for (const int asks : more)
        EXPECT_LE(asks, 6);
}

TEST(MeshComparison, AFineMeshIsPreparedInShortSteps) {
    // Corners repeated, as files have them; inside out.
    const TriangleMesh tube = tubeMesh(Vector3d(0, 0, -0.2), Vector3d(0, 0, 0.2), 0.05, 20000);
    TriangleMesh soup;
    for (const auto& [a, b, c] : tube.triangles) {
        const auto first = static_cast<std::uint32_t>(soup.vertices.size());
        soup.vertices.insert(soup.vertices.end(), {tube.vertices[c], tube.vertices[b], tube.vertices[a]});
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    constexpr int kSteps = 80000 / 4096;
    int asked = 0;
    RunContext counting;
    counting.isCancelled = [&] { return ++asked < 0; };
    const TriangleMesh joined = welded(soup, counting);
    EXPECT_EQ(joined.triangles.size(), 80000U);
    EXPECT_GT(asked, 7 * kSteps) << "corners sorted and joined, triangles";
    asked = 0;
    const TriangleMesh mesh = turnedOutwards(joined, counting);
    EXPECT_GT(enclosedVolume(mesh).value(), 0);
    EXPECT_GT(asked, 4 * kSteps) << "edges listed and sorted";
    asked = 0;
    const MeshSurface surface(mesh, counting);
    EXPECT_NEAR(surface.nearest({0.06, 0, 0}, Vector3d::UnitX(), 0.1).value().distance, 0.01, 1e-6);
    EXPECT_GT(asked, 12 * kSteps) << "faces, corners, edges, boxes, twice the tree";

    for (const int asks : asksAfterCancelling(40, [&](const RunContext& context) { (void)welded(soup, context); }))
        EXPECT_LE(asks, 1);
    for (const int asks :
         asksAfterCancelling(40, [&](const RunContext& context) { (void)turnedOutwards(joined, context); }))
        EXPECT_LE(asks, 1);
    bool isWhole = true;
    for (const int asks : asksAfterCancelling(40, [&](const RunContext& context) {
             const MeshSurface half(mesh, context);
             EXPECT_EQ(half.nearest({0.06, 0, 0}, Vector3d::UnitX(), 0.1).has_value(), isWhole);
             isWhole = false;
         }))
        EXPECT_LE(asks, 1);
    RunContext never;
    never.isCancelled = [] { return true; };
    EXPECT_TRUE(welded(soup, never).triangles.empty());
    EXPECT_EQ(turnedOutwards(joined, never).triangles, joined.triangles);
}

}  // namespace
}  // namespace skincal
