// Worlds in which something is wrong: it is found and named, and the rest is right without it.

#include <gtest/gtest.h>

#include <set>

#include "core/adjustment/solution_review.h"
#include "core/estimation/compare.h"
#include "core/estimation/joint_method.h"
#include "core/study/study_world.h"

namespace skincal {
namespace {

std::set<std::uint32_t> idsOf(const World& world, const std::vector<std::size_t>& modules) {
    std::set<std::uint32_t> ids;
    for (const std::size_t u : modules)
        ids.insert(world.skin.modules[u].id.value);
    return ids;
}

std::set<std::uint32_t> named(const BodyModel& body, const std::set<Finding::Kind>& kinds) {
    std::set<std::uint32_t> ids;
    for (const Finding& finding : body.quality.findings) {
        if (!kinds.contains(finding.kind))
            continue;
        for (const ModuleId id : finding.modules)
            ids.insert(id.value);
    }
    return ids;
}

/// Largest error of any module in its own standard deviations, by the component that is the worst. The frame is the
/// first placed view's.
double worstInSigmas(const BodyModel& body, const World& world) {
    std::size_t first = 0;
    while (!body.views[first].T_body_camera)
        ++first;
    const Isometry3d T_v_r = world.T_r_v[first].inverse();
    double worst = 0;
    for (std::size_t u = 0; u < body.modules.size(); ++u) {
        const auto& T = body.modules[u].T_body_module;
        if (!T || !body.modules[u].covariance)
            continue;
        const Isometry3d truth = T_v_r * world.T_r_u[u];
        Vector6d error;
        error << so3Log(T->linear() * truth.linear().transpose()), T->translation() - truth.translation();
        worst = std::max(worst,
                         error.cwiseQuotient(body.modules[u].covariance->diagonal().cwiseSqrt()).cwiseAbs().maxCoeff());
    }
    return worst;
}

class Faults : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, Faults, testing::Range<std::uint64_t>(1, 9), testing::PrintToStringParamName());

TEST_P(Faults, AreNamedAndNothingElseIs) {
    const World world = buildWorld(*findScenario("faults"), GetParam());
    const BodyModel body = calibrateJoint(measurementsOf(world)).value();

    EXPECT_EQ(named(body, {Finding::Kind::WrongTemplate}), idsOf(world, world.faults.wrongTemplates));
    EXPECT_EQ(named(body, {Finding::Kind::MovedModule}), idsOf(world, world.faults.movedModules));
    std::set<std::uint32_t> ends;
    for (const MisportedLink& fault : world.faults.misportedLinks) {
        ends.insert(world.skin.links[fault.link].a.value);
        ends.insert(world.skin.links[fault.link].b.value);
    }
    EXPECT_EQ(named(body, {Finding::Kind::WrongLink}), ends);
    std::set<int> poses;
    std::set<int> shaken;
    std::set<std::string> views;
    std::set<std::string> bumped;
    for (const Finding& finding : body.quality.findings) {
        EXPECT_FALSE(finding.text.empty());
        if (finding.kind == Finding::Kind::ShakenPose)
            poses.insert(finding.pose.value());
        if (finding.kind == Finding::Kind::BumpedView || finding.kind == Finding::Kind::UnsteadyView)
            views.insert(finding.view.value());
    }
    for (const ShakenPose& fault : world.faults.shakenPoses)
        shaken.insert(static_cast<int>(fault.pose));
    for (const BumpedView& fault : world.faults.bumpedViews)
        bumped.insert(viewName(fault.view));
    EXPECT_EQ(poses, shaken);
    EXPECT_EQ(views, bumped);
    EXPECT_TRUE(named(body, {Finding::Kind::NoisyAccelerometer, Finding::Kind::MovedPatch}).empty());
}

TEST_P(Faults, LeaveTheRestRight) {
    const World world = buildWorld(*findScenario("faults"), GetParam());
    const BodyModel body = calibrateJoint(measurementsOf(world)).value();
    EXPECT_LT(worstInSigmas(body, world), 5);
    EXPECT_NE(body.quality.trust, Trust::NotToBeTrusted);
    const auto out = idsOf(world, world.faults.movedModules);
    for (const BodyModule& module : body.modules) {
        if (out.contains(module.id.value)) {
            EXPECT_FALSE(module.T_body_module) << "never a pose that is not believed";
            EXPECT_NE(module.status, "placed");
        }
    }
}

class MovedJoint : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, MovedJoint, testing::Range<std::uint64_t>(1, 9), testing::PrintToStringParamName());

TEST_P(MovedJoint, IsNamedAndItsPatchPlacedByTheCamera) {
    const World world = buildWorld(*findScenario("moved-joint"), GetParam());
    const BodyModel body = calibrateJoint(measurementsOf(world)).value();
    std::vector<std::size_t> moved;
    for (std::size_t u = 0; u < world.patchOf.size(); ++u) {
        if (static_cast<std::size_t>(world.patchOf[u]) == world.faults.movedPatches.at(0))
            moved.push_back(u);
    }
    const auto found = named(body, {Finding::Kind::MovedPatch});
    // Which of two patches moved against the other no one can tell; here the others are the majority, or the camera is.
    EXPECT_FALSE(found.empty());
    EXPECT_TRUE(
        named(body, {Finding::Kind::MovedModule, Finding::Kind::WrongLink, Finding::Kind::WrongTemplate}).empty());
    EXPECT_EQ(body.quality.modulesPlaced, body.quality.modulesTotal);
    EXPECT_LT(worstInSigmas(body, world), 5);
    EXPECT_NE(body.quality.trust, Trust::Good);
}

/// Everything false taken out by who knows: outliers, and the smaller part of what a view saw before and after it was
/// knocked: which of two places is the view's own is a matter of numbers.
Measurements withoutTheFalse(const World& world, Measurements measurements) {
    const auto index = world.skin.indexById();
    World after = world;
    for (const BumpedView& bump : world.faults.bumpedViews)
        after.T_r_v[bump.view] = bump.T_r_v_after;
    for (std::size_t v = 0; v < measurements.views.size(); ++v) {
        const auto isFrom = [&](const World& where, const LedDetection& d) {
            const auto real = visiblePixel(where, v, index.at(d.module));
            return real && (d.pixel - *real).norm() < 6 * world.scenario.views.pixelNoise;
        };
        auto& found = measurements.views[v].found;
        const auto countFrom = [&](const World& where) {
            return std::count_if(found.begin(), found.end(), [&](const LedDetection& d) { return isFrom(where, d); });
        };
        const World& larger = countFrom(after) > countFrom(world) ? after : world;
        std::erase_if(found, [&](const LedDetection& d) { return !isFrom(larger, d); });
    }
    return measurements;
}

TEST(Contamination, OutliersAndABumpedViewChangeNothing) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U, 6U}) {
        Scenario scenario = *findScenario("outliers");
        scenario.views.outliers = 0.2;
        scenario.faults.bumpedViews = 1;
        const World world = buildWorld(scenario, seed);
        const Measurements measurements = measurementsOf(world);
        const BodyModel body = calibrateJoint(measurements).value();
        const BodyModel clean = calibrateJoint(withoutTheFalse(world, measurements)).value();
        ASSERT_EQ(body.quality.modulesPlaced, body.quality.modulesTotal);
        double worst = 0;
        for (std::size_t u = 0; u < body.modules.size(); ++u) {
            const Isometry3d& a = *body.modules[u].T_body_module;
            const Isometry3d& b = clean.modules[u].T_body_module.value();
            Vector6d change;
            change << so3Log(a.linear() * b.linear().transpose()), a.translation() - b.translation();
            const Vector6d sigma = clean.modules[u].covariance.value().diagonal().cwiseSqrt();
            worst = std::max(worst, change.cwiseQuotient(sigma).cwiseAbs().maxCoeff());
        }
        EXPECT_LT(worst, 0.1) << "seed " << seed;
        const auto bumped =
            std::count_if(body.quality.findings.begin(), body.quality.findings.end(), [&](const Finding& f) {
                return f.kind == Finding::Kind::BumpedView && f.view == viewName(world.faults.bumpedViews.at(0).view);
            });
        EXPECT_EQ(bumped, 1) << "seed " << seed;
        EXPECT_EQ(body.quality.findings.size(), 1U);
    }
}

TEST(Misalignment, IsPaidForInTheCovariancesWhereItIsToldOf) {
    JointMethodOptions options;
    options.misalignmentSigma = 0.5 * kDegree;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const World world = buildWorld(*findScenario("misaligned"), seed);
        const BodyModel body = calibrateJoint(measurementsOf(world), options).value();
        EXPECT_LT(worstInSigmas(body, world), 5);
        EXPECT_FALSE(body.modules[0].accelerometer.value().misalignment.isZero());
    }
}

}  // namespace
}  // namespace skincal
