// All methods from measurements to the body model, on worlds whose truth is known.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/estimation/compare.h"
#include "core/estimation/joint_method.h"
#include "core/estimation/paper_method.h"
#include "core/estimation/sturdy_method.h"
#include "tests/unit/estimation/synthetic.h"

namespace skincal {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

enum class Method { Paper, Sturdy, Joint };

tl::expected<BodyModel, CalibrationError> calibrate(Method method, const Measurements& measurements,
                                                    const RunContext& context = {}) {
    switch (method) {
        case Method::Paper:
            return calibratePaper(measurements, {}, context);
        case Method::Sturdy:
            return calibrateSturdy(measurements, {}, context);
        default:
            return calibrateJoint(measurements, {}, context);
    }
}

std::vector<NamedPose> posesOf(const BodyModel& body) {
    std::vector<NamedPose> poses;
    for (const BodyModule& module : body.modules) {
        if (module.T_body_module)
            poses.push_back({module.id, *module.T_body_module});
    }
    return poses;
}

BodyComparison compareToTruth(const BodyModel& body, const SyntheticWorld& world) {
    std::vector<NamedPose> truth;
    for (std::size_t u = 0; u < world.T_r_u.size(); ++u)
        truth.push_back({world.measurements.skin.modules[u].id, world.T_r_u[u]});
    return compareBodies(posesOf(body), truth).value();
}

Isometry3d placed(const Vector3d& w, const Vector3d& t) {
    return makeIsometry(so3Exp(w), t);
}

SyntheticOptions bentPatches() {
    SyntheticOptions options;
    options.patches = {{4, 3, 0.07}, {4, 3, 0.06, placed({0.2, 0.3, 1.2}, {0.16, 0.05, -0.02})}};
    return options;
}

SyntheticOptions mixedPatches() {
    SyntheticOptions options;
    options.patches = {{3, 3, 0.07}, {3, 3, 0, placed({0.3, 0.2, 1.1}, {0.15, 0.06, -0.02}), true}};
    return options;
}

std::string nameOf(const testing::TestParamInfo<Method>& test) {
    return test.param == Method::Paper ? "Paper" : test.param == Method::Sturdy ? "Sturdy" : "Joint";
}

class AllMethods : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Table, AllMethods, testing::Values(Method::Paper, Method::Sturdy, Method::Joint), nameOf);

/// Those that are ours.
class OurMethods : public testing::TestWithParam<Method> {};
INSTANTIATE_TEST_SUITE_P(Table, OurMethods, testing::Values(Method::Sturdy, Method::Joint), nameOf);

TEST_P(AllMethods, ExactDataGiveTheExactBody) {
    Random random(1, "exact");
    for (int i = 0; i < 3; ++i) {
        const SyntheticWorld world = makeWorld(random, bentPatches());
        const auto body = calibrate(GetParam(), world.measurements);
        ASSERT_TRUE(body) << body.error().message();
        const BodyComparison difference = compareToTruth(*body, world);
        EXPECT_EQ(difference.compared, world.T_r_u.size());
        EXPECT_LT(difference.positionMax, 1e-4);
        EXPECT_LT(difference.rotationMax, 1e-3);
        EXPECT_EQ(body->quality.trust, Trust::Good);
        EXPECT_EQ(body->quality.modulesPlaced, world.T_r_u.size());
        EXPECT_THAT(body->quality.missing, IsEmpty());
        EXPECT_LT(body->quality.residual_rms_px.value(), 0.05);
        EXPECT_LT(body->quality.link_mismatch_max.value(), 1e-5);
        EXPECT_LT(body->quality.gravity_residual_rms.value(), 1e-3);
        EXPECT_EQ(body->body_frame, "first-view");
        EXPECT_LT(poseDifference(body->views[0].T_body_camera.value(), Isometry3d::Identity()).distance, 1e-9);
        for (const BodyModule& module : body->modules) {
            EXPECT_EQ(module.status, "placed");
            const Isometry3d T_r_o = body->patches[module.patch->value].T_body_patch.value();
            const Isometry3d T_r_u = T_r_o * module.T_patch_module.value();
            EXPECT_LT(poseDifference(T_r_u, *module.T_body_module).distance, 1e-9);
        }
        EXPECT_EQ(body->modules[0].accelerometer.has_value(), GetParam() != Method::Paper);
    }
}

TEST_P(AllMethods, WithoutViewsThePatchesHaveShapesButNoPlace) {
    Random random(2, "no views");
    SyntheticOptions options = bentPatches();
    options.views = 0;
    const SyntheticWorld world = makeWorld(random, options);
    const BodyModel body = calibrate(GetParam(), world.measurements).value();
    EXPECT_THAT(posesOf(body), IsEmpty());
    EXPECT_EQ(body.quality.trust, Trust::NotToBeTrusted);
    EXPECT_FALSE(body.quality.residual_rms_px);
    EXPECT_THAT(body.quality.missing,
                ElementsAre(HasSubstr("patch 0 (origin"), AllOf(HasSubstr("patch 1"), HasSubstr("seen in no view"))));
    for (const BodyModule& module : body.modules) {
        EXPECT_TRUE(module.T_patch_module);
        EXPECT_EQ(module.status, "not seen with a placed patch");
    }
}

TEST_P(AllMethods, APatchNeverSeenWithOthersHasNoPose) {
    Random random(3, "apart");
    SyntheticOptions options = bentPatches();
    options.patches.push_back({3, 3, 0.08, placed({0.1, 0.2, 0.3}, {0, 0.25, 0})});
    SyntheticWorld world = makeWorld(random, options);
    for (std::size_t v = 0; v < world.measurements.views.size(); ++v) {
        std::erase_if(world.measurements.views[v].found, [&](const LedDetection& detection) {
            return (world.patchOf[detection.module.value - 1] == 2) != (v == 3);
        });
    }
    const BodyModel body = calibrate(GetParam(), world.measurements).value();
    EXPECT_TRUE(body.patches[0].T_body_patch && body.patches[1].T_body_patch);
    EXPECT_FALSE(body.patches[2].T_body_patch);
    EXPECT_EQ(body.patches[2].status, "not seen with a placed patch");
    EXPECT_FALSE(body.views[3].T_body_camera);
    EXPECT_NE(body.views[3].status, "placed");
    EXPECT_EQ(body.quality.modulesPlaced, 24U);
    EXPECT_NE(body.quality.trust, Trust::Good);
    ASSERT_EQ(body.quality.missing.size(), 1U);
    EXPECT_THAT(body.quality.missing[0], HasSubstr("was never seen with a placed patch: add a view that shows both"));
    EXPECT_LT(compareToTruth(body, world).positionMax, 1e-4);
}

TEST_P(AllMethods, ContradictoryLinksAndCablesAreSortedOut) {
    Random random(4, "contradiction");
    SyntheticWorld world = makeWorld(random, bentPatches());
    auto& links = world.measurements.skin.links;
    // A port that is taken already, and a free one: neither joins neighbours.
    links.insert(links.begin(), {ModuleId(1), 0, ModuleId(20), 3});
    links.push_back({ModuleId(4), 0, ModuleId(13), 3});
    const BodyModel body = calibrate(GetParam(), world.measurements).value();
    EXPECT_EQ(body.patches.size(), 2U);
    EXPECT_EQ(body.links.front().kind, LinkKind::Cable);
    EXPECT_EQ(body.links.back().kind, LinkKind::Cable);
    EXPECT_FALSE(body.links.back().reason.empty());
    EXPECT_GT(body.links.back().distance.value(), 0.02);
    EXPECT_EQ(body.links[1].kind, LinkKind::Adjacent);
    EXPECT_LT(compareToTruth(body, world).positionMax, 1e-4);
}

TEST_P(AllMethods, StopWhenCancelledAtAnyMoment) {
    Random random(5, "cancel");
    const SyntheticWorld world = makeWorld(random, bentPatches());
    RunContext context;
    bool finished = false;
    for (int limit = 0; !finished && limit < 1000; limit = 2 * limit + 1) {
        int calls = 0;
        double last = 0;
        context.isCancelled = [&] { return ++calls > limit; };
        context.report = [&](const Sentence& stage, double done) {
            EXPECT_FALSE(stage.empty());
            EXPECT_GE(done, 0);
            EXPECT_LE(done, 1);
            last = done;
        };
        const auto body = calibrate(GetParam(), world.measurements, context);
        finished = body.has_value();
        if (finished) {
            EXPECT_GT(last, 0);
        } else {
            EXPECT_EQ(body.error().code, ErrorCode::Cancelled);
        }
    }
    EXPECT_TRUE(finished);
}

TEST_P(AllMethods, ReportWhatBecameOfEveryDetection) {
    Random random(6, "observations");
    SyntheticWorld world = makeWorld(random, bentPatches());
    auto& view = world.measurements.views[1];
    const ModuleId hidden = view.found.back().module;
    const ModuleId doubtful = view.found[0].module;
    view.found.pop_back();
    view.found.erase(view.found.begin());
    view.undetected = {{hidden, DetectionVerdict::NotFound, Sentence::verbatim("no spot above the noise")},
                       {doubtful, DetectionVerdict::Ambiguous, Sentence::verbatim("two spots blink its word")}};
    view.found.push_back({ModuleId(9999), {10, 10}, 0.1});
    const std::size_t known = view.found.size() - 1;
    const BodyModel body = calibrate(GetParam(), world.measurements).value();
    const auto& observations = body.views[1].observations;
    ASSERT_EQ(observations.size(), known + 2);
    for (std::size_t i = 0; i < known; ++i) {
        EXPECT_EQ(observations[i].verdict, ObservationVerdict::Used);
        EXPECT_LT(observations[i].residual.value().norm(), 0.05);
    }
    EXPECT_EQ(observations[known].verdict, ObservationVerdict::NotFound);
    EXPECT_EQ(observations[known].reason, "no spot above the noise");
    EXPECT_FALSE(observations[known].pixel);
    EXPECT_EQ(observations[known + 1].verdict, ObservationVerdict::Ambiguous);
    EXPECT_EQ(observations[known + 1].module, doubtful);
    EXPECT_THAT(body.patches[0].views, testing::Contains("view1"));
}

TEST(PaperMethod, WithoutGravityOnlyOriginsHaveAShape) {
    Random random(7, "paper silent");
    SyntheticOptions options = bentPatches();
    options.poses = 0;
    const SyntheticWorld world = makeWorld(random, options);
    const BodyModel body = calibratePaper(world.measurements).value();
    EXPECT_THAT(posesOf(body), IsEmpty());
    int unknown = 0;
    for (const BodyModule& module : body.modules)
        unknown += module.status == "orientation unknown: no usable gravity readings" ? 1 : 0;
    EXPECT_EQ(unknown, 22);
    EXPECT_THAT(body.quality.missing, testing::Each(HasSubstr("only 1 of their modules have gravity readings")));
}

TEST(PaperMethod, NamesItsOutliers) {
    Random random(8, "paper outliers");
    SyntheticOptions options = bentPatches();
    options.outliers = 0.08;
    const SyntheticWorld world = makeWorld(random, options);
    ASSERT_FALSE(world.outliers.empty());
    const BodyModel body = calibratePaper(world.measurements).value();
    for (const auto& [v, id] : world.outliers) {
        const auto& list = body.views[v].observations;
        const auto found = std::find_if(list.begin(), list.end(), [&](const auto& o) { return o.module == id; });
        ASSERT_NE(found, list.end());
        EXPECT_EQ(found->verdict, ObservationVerdict::Rejected);
        EXPECT_FALSE(found->reason.empty());
    }
}

TEST_P(OurMethods, WhatWasSeenFromOneSideIsUsableAtMost) {
    Random random(31, "one side");
    SyntheticWorld world = makeWorld(random, bentPatches());
    const auto oneSided = [&] {
        const BodyModel body = calibrate(GetParam(), world.measurements).value();
        const auto isSaid = [](const Sentence& warning) {
            return warning.english().find("add a view from 30°") != std::string::npos;
        };
        const auto& warnings = body.quality.warnings;
        const bool said = std::any_of(warnings.begin(), warnings.end(), isSaid);
        EXPECT_EQ(body.quality.modulesPlaced, world.T_r_u.size());
        EXPECT_EQ(body.quality.trust, said ? Trust::Usable : Trust::Good);
        return said;
    };
    EXPECT_FALSE(oneSided());
    // A second view from the same place adds nothing that could contradict the first.
    world.measurements.views.resize(1);
    EXPECT_TRUE(oneSided());
    world.measurements.views.push_back(world.measurements.views[0]);
    world.measurements.views[1].name = "again";
    EXPECT_TRUE(oneSided());
}

TEST_P(OurMethods, PlacesFlatPatches) {
    Random random(9, "flat");
    SyntheticOptions options;
    options.patches = {{3, 3, 0}, {3, 3, 0, placed({0.5, 0.3, 1.0}, {0.15, 0.05, 0.01}), true}};
    options.views = 5;
    const SyntheticWorld world = makeWorld(random, options);
    const BodyModel body = calibrate(GetParam(), world.measurements).value();
    EXPECT_EQ(body.quality.modulesPlaced, 18U);
    EXPECT_LT(compareToTruth(body, world).positionMax, 1e-4);
    EXPECT_EQ(body.quality.trust, Trust::Good);
}

TEST_P(OurMethods, WithoutGravityEnoughViewsGiveTheShape) {
    Random random(14, "no gravity");
    SyntheticOptions options = bentPatches();
    options.poses = 0;
    options.views = 8;
    const SyntheticWorld world = makeWorld(random, options);
    const BodyModel body = calibrate(GetParam(), world.measurements).value();
    // A corner that hangs by one link turns about it.
    EXPECT_GE(body.quality.modulesPlaced, 16U);
    const BodyComparison difference = compareToTruth(body, world);
    EXPECT_LT(difference.positionRms, 2e-3);
    EXPECT_LT(difference.rotationRms, 15 * kDegree);
    EXPECT_FALSE(body.quality.gravity_residual_rms);
    for (const BodyModule& module : body.modules)
        EXPECT_FALSE(module.accelerometer);
}

TEST_P(OurMethods, WithoutGravityOneViewMakesNothingUp) {
    Random random(20, "no gravity");
    SyntheticOptions options = bentPatches();
    options.poses = 0;
    options.views = 1;
    const BodyModel body = calibrate(GetParam(), makeWorld(random, options).measurements).value();
    EXPECT_THAT(posesOf(body), IsEmpty());
    EXPECT_EQ(body.quality.trust, Trust::NotToBeTrusted);
    EXPECT_THAT(body.quality.missing, testing::Contains(HasSubstr("no gravity readings tell how they lie")));
}

TEST_P(OurMethods, OnePatchInOneViewIsPlaced) {
    Random random(21, "one view");
    SyntheticOptions options;
    options.patches = {{4, 3, 0.06}};
    options.views = 1;
    options.pixelNoise = 0.03;
    options.accelerometerNoise = 0.02;
    const SyntheticWorld world = makeWorld(random, options);
    const BodyModel body = calibrate(GetParam(), world.measurements).value();
    EXPECT_EQ(body.quality.modulesPlaced, 12U);
    EXPECT_LT(compareToTruth(body, world).positionMax, 1e-3);
    EXPECT_LT(compareToTruth(body, world).rotationMax, 1 * kDegree);
}

TEST_P(OurMethods, ASilentModuleIsHeldByLinksAndLedOrLeftOut) {
    Random random(15, "silent");
    SyntheticOptions options = bentPatches();
    options.views = 6;
    SyntheticWorld world = makeWorld(random, options);
    Skin& skin = world.measurements.skin;
    // One in the middle of the first patch, and a corner of it whose LED nobody sees.
    const ModuleId middle(6);
    const ModuleId corner(1);
    std::erase_if(world.measurements.gravity,
                  [&](const GravityReading& r) { return r.module == middle || r.module == corner; });
    for (ViewDetections& view : world.measurements.views)
        std::erase_if(view.found, [&](const LedDetection& d) { return d.module == corner; });
    bool keptOne = false;
    std::erase_if(skin.links, [&](const Link& link) {
        const bool ofCorner = link.a == corner || link.b == corner;
        const bool erase = ofCorner && keptOne;
        keptOne = keptOne || ofCorner;
        return erase;
    });
    const BodyModel body = calibrate(GetParam(), world.measurements).value();
    EXPECT_EQ(body.quality.modulesPlaced, 23U);
    EXPECT_LT(compareToTruth(body, world).positionMax, 1e-3);
    EXPECT_LT(compareToTruth(body, world).rotationMax, 2 * kDegree);
    for (const BodyModule& module : body.modules) {
        EXPECT_EQ(module.T_body_module.has_value(), module.id != corner);
        EXPECT_THAT(module.status, HasSubstr(module.id == corner ? "orientation unknown" : "placed"));
    }
    EXPECT_THAT(body.quality.missing, ElementsAre(HasSubstr("module 1: no gravity readings tell how it lies")));
}

TEST_P(OurMethods, APoseThatOnePatchLacksDoesNoHarm) {
    Random random(16, "gap");
    SyntheticWorld world = makeWorld(random, bentPatches());
    std::erase_if(world.measurements.gravity,
                  [&](const GravityReading& r) { return r.pose == 2 && world.patchOf[r.module.value - 1] == 1; });
    const BodyModel body = calibrate(GetParam(), world.measurements).value();
    EXPECT_EQ(body.quality.modulesPlaced, 24U);
    EXPECT_EQ(body.quality.trust, Trust::Good);
    EXPECT_THAT(body.quality.warnings, IsEmpty());
}

TEST_P(OurMethods, ReadingsInAnotherUnitAreNotTrusted) {
    Random random(17, "units");
    SyntheticWorld world = makeWorld(random, bentPatches());
    for (GravityReading& reading : world.measurements.gravity)
        reading.acceleration *= 1 / kStandardGravity;
    const BodyModel body = calibrate(GetParam(), world.measurements).value();
    EXPECT_EQ(body.quality.trust, Trust::NotToBeTrusted);
    EXPECT_THAT(body.quality.warnings, testing::Contains(HasSubstr("their unit is not m/s²")));
}

TEST(JointMethod, WeighsByWhatItFindsAndKnowsHowGoodItIs) {
    Random random(19, "joint");
    SyntheticOptions options = mixedPatches();
    options.views = 8;
    options.poses = 12;
    options.pixelNoise = 0.02;
    options.accelerometerNoise = 0.1;
    options.bias = 0.3;
    options.scale = 0.01;
    options.outliers = 0.08;
    const SyntheticWorld world = makeWorld(random, options);
    const BodyModel body = calibrateJoint(world.measurements).value();
    EXPECT_EQ(body.generator.method, "joint");
    EXPECT_EQ(body.quality.modulesPlaced, 18U);
    EXPECT_NEAR(body.quality.condition.at("accelerometer sigma"), 0.1, 0.02);
    for (std::size_t v = 0; v < body.views.size(); ++v) {
        for (const BodyObservation& o : body.views[v].observations) {
            const bool outlier = std::count(world.outliers.begin(), world.outliers.end(),
                                            std::pair<std::size_t, ModuleId>{v, o.module}) > 0;
            EXPECT_EQ(o.verdict == ObservationVerdict::Rejected, outlier);
        }
    }
    const Isometry3d T_v_r = world.T_r_v[0].inverse();
    for (std::size_t u = 0; u < body.modules.size(); ++u) {
        ASSERT_TRUE(body.modules[u].covariance);
        const Isometry3d truth = T_v_r * world.T_r_u[u];
        const Isometry3d& found = *body.modules[u].T_body_module;
        Vector6d error;
        error << so3Log(found.linear() * truth.linear().transpose()), found.translation() - truth.translation();
        // Five sigma, in each direction.
        const Vector6d sigma = body.modules[u].covariance->diagonal().cwiseSqrt();
        EXPECT_LT((error.cwiseQuotient(sigma)).cwiseAbs().maxCoeff(), 5) << u;
    }
    EXPECT_FALSE(calibrateSturdy(world.measurements)->modules[0].covariance);
    JointMethodOptions bad;
    bad.refinement.rejectionSigmas = 1;
    EXPECT_THROW((void)calibrateJoint(world.measurements, bad), std::logic_error);
}

TEST(PaperMethod, OrderOfDetectionsMakesNoDifference) {
    Random random(18, "paper order");
    SyntheticOptions options = bentPatches();
    options.pixelNoise = 0.1;
    options.outliers = 0.05;
    SyntheticWorld world = makeWorld(random, options);
    const BodyModel expected = calibratePaper(world.measurements).value();
    for (ViewDetections& view : world.measurements.views)
        std::reverse(view.found.begin(), view.found.end());
    const BodyModel body = calibratePaper(world.measurements).value();
    ASSERT_EQ(posesOf(body).size(), posesOf(expected).size());
    for (std::size_t i = 0; i < posesOf(body).size(); ++i)
        EXPECT_TRUE(posesOf(body)[i].T_body_module.matrix() == posesOf(expected)[i].T_body_module.matrix());
}

TEST_P(OurMethods, RejectsAndNamesOutliersAndNothingElse) {
    Random random(10, "outliers");
    SyntheticOptions options = mixedPatches();
    options.views = 6;
    options.pixelNoise = 0.05;
    options.accelerometerNoise = 0.03;
    options.bias = 0.2;
    options.scale = 0.01;
    options.outliers = 0.08;
    for (int i = 0; i < 3; ++i) {
        const SyntheticWorld world = makeWorld(random, options);
        ASSERT_FALSE(world.outliers.empty());
        const BodyModel body = calibrate(GetParam(), world.measurements).value();
        EXPECT_EQ(body.quality.modulesPlaced, 18U);
        EXPECT_LT(compareToTruth(body, world).positionRms, 1e-3);
        EXPECT_LT(body.quality.residual_rms_px.value(), 0.2);
        for (std::size_t v = 0; v < body.views.size(); ++v) {
            for (const BodyObservation& o : body.views[v].observations) {
                const bool outlier = std::count(world.outliers.begin(), world.outliers.end(),
                                                std::pair<std::size_t, ModuleId>{v, o.module}) > 0;
                EXPECT_EQ(o.verdict == ObservationVerdict::Rejected, outlier) << v << " " << o.module.value;
                if (outlier) {
                    EXPECT_THAT(o.reason, HasSubstr("px from where the body has it"));
                }
            }
        }
        EXPECT_THAT(body.quality.warnings, testing::Contains(HasSubstr("detections rejected")));
    }
}

TEST_P(OurMethods, OrderOfModulesLinksViewsAndDetectionsMakesNoDifference) {
    Random random(11, "order");
    SyntheticOptions options = mixedPatches();
    options.pixelNoise = 0.05;
    options.accelerometerNoise = 0.03;
    options.bias = 0.2;
    const SyntheticWorld world = makeWorld(random, options);
    const BodyModel expected = calibrate(GetParam(), world.measurements).value();
    ASSERT_EQ(expected.quality.modulesPlaced, 18U);
    for (int i = 0; i < 3; ++i) {
        Measurements told = world.measurements;
        std::reverse(told.views.begin(), told.views.end());
        std::rotate(told.skin.modules.begin(), told.skin.modules.begin() + 5 + i, told.skin.modules.end());
        std::rotate(told.skin.links.begin(), told.skin.links.begin() + 3 + 2 * i, told.skin.links.end());
        std::reverse(told.gravity.begin(), told.gravity.end());
        for (ViewDetections& view : told.views)
            std::rotate(view.found.begin(), view.found.begin() + 1 + i, view.found.end());
        for (Link& link : told.skin.links) {
            if (random.uniform() < 0.5) {
                std::swap(link.a, link.b);
                std::swap(link.a_port, link.b_port);
            }
        }
        const BodyModel body = calibrate(GetParam(), told).value();
        const BodyComparison difference = compareBodies(posesOf(body), posesOf(expected)).value();
        EXPECT_EQ(difference.compared, 18U);
        EXPECT_LT(difference.positionMax, 2e-5);
        EXPECT_LT(difference.rotationMax, 1e-3);
        ASSERT_EQ(body.patches.size(), expected.patches.size());
        for (std::size_t k = 0; k < body.patches.size(); ++k) {
            EXPECT_EQ(body.patches[k].origin, expected.patches[k].origin);
            EXPECT_EQ(body.patches[k].modules, expected.patches[k].modules);
        }
    }
}

TEST_P(OurMethods, APatchThatShowsFewLedsIsTriangulated) {
    Random random(12, "few");
    SyntheticOptions options = bentPatches();
    options.pixelNoise = 0.02;
    SyntheticWorld world = makeWorld(random, options);
    for (ViewDetections& view : world.measurements.views) {
        int shown = 0;
        std::erase_if(view.found, [&](const LedDetection& detection) {
            return world.patchOf[detection.module.value - 1] == 1 && ++shown > 2;
        });
    }
    const BodyModel body = calibrate(GetParam(), world.measurements).value();
    EXPECT_EQ(body.quality.modulesPlaced, 24U);
    EXPECT_LT(compareToTruth(body, world).positionMax, 2e-3);
    // The paper's method leaves it out, and says what it takes.
    const BodyModel paper = calibratePaper(world.measurements).value();
    EXPECT_EQ(paper.quality.modulesPlaced, 12U);
    EXPECT_THAT(paper.quality.missing, ElementsAre(HasSubstr("showed at most 2 LEDs in a view, 6 are needed")));
}

TEST_P(OurMethods, AJointThatMovedBetweenPosesCostsGravityNotThePlace) {
    Random random(13, "joint");
    SyntheticWorld world = makeWorld(random, bentPatches());
    // The second patch hung from other directions: its joint was moved before each pose.
    for (GravityReading& reading : world.measurements.gravity) {
        const std::size_t u = reading.module.value - 1;
        if (world.patchOf[u] == 1) {
            Random pose(static_cast<std::uint64_t>(reading.pose), "joint");
            reading.acceleration = world.T_r_u[u].linear().transpose() * pose.direction() * kStandardGravity;
        }
    }
    const BodyModel body = calibrate(GetParam(), world.measurements).value();
    EXPECT_EQ(body.quality.modulesPlaced, 24U);
    EXPECT_LT(compareToTruth(body, world).positionMax, 1e-4);
    EXPECT_THAT(body.quality.warnings, testing::Contains(HasSubstr("patch 1: gravity disagrees")));
    EXPECT_NE(body.quality.trust, Trust::Good);
}

TEST_P(AllMethods, AnEmptySkinIsAnEmptyBody) {
    Measurements nothing;
    nothing.camera = syntheticCamera(true);
    const BodyModel body = calibrate(GetParam(), nothing).value();
    EXPECT_THAT(body.modules, IsEmpty());
    EXPECT_EQ(body.quality.trust, Trust::NotToBeTrusted);
}

TEST(SturdyMethod, OptionsOutOfRangeThrow) {
    std::vector<SturdyMethodOptions> bad(7);
    bad[0].rejectionSigmas = 1;
    bad[1].initial.gravityRotationSigma = 0;
    bad[2].initial.pose.minInliers = 0;
    bad[3].initial.selection.maxDisagreement_rad = 0;
    bad[4].initial.averaging.iterations = 0;
    bad[5].adjustment.linkSigma = 0;
    bad[6].initial.layout.minSeparationViews = 0;
    EXPECT_TRUE(SturdyMethodOptions{}.validate());
    for (const SturdyMethodOptions& options : bad)
        EXPECT_THROW((void)calibrateSturdy({}, options), std::logic_error);
}

}  // namespace
}  // namespace skincal
